"""Responses: from a CSV file to one array of answers per question, checked row by row.

Every place in the arrays comes from the protocol or from a sorted list of participants, never from the
order in which rows happen to stand, so pairs are pairs of one participant and levels are in the order of
their names.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, get_args

import numpy as np
from numpy.typing import NDArray

from analysis.answers import MISSING, Answers, FloatArray, unanswered
from analysis.columns import time_span
from analysis.fields import ResponsesError, read_header
from analysis.naming import UNKNOWN, Naming, option_of
from analysis.open_answers import OpenAnswers, open_answers
from analysis.rows import OPTIONAL, REQUIRED, Rows, among, named_columns, read_rows
from analysis.wide import answer_columns, read_wide, unknown_names
from study.participants import Kind

if TYPE_CHECKING:
    from study.protocol import Protocol


DIGITS = 9  # of a trial's place at most; what has more is a moment or the like


@dataclass(frozen=True)
class Responses:
    """All answers of a study that a test could use."""

    path: Path
    sha256: str
    participants: tuple[str, ...]  # sorted
    questions: tuple[Answers, ...]
    checks: tuple[Answers, ...] = ()  # of attention
    trials: Mapping[str, FloatArray] = field(
        default_factory=dict
    )  # part → (participants, stimuli), when seen
    median_rt_s: FloatArray | None = None  # (participants,) time per answer
    kind: Kind = "participant"
    open: tuple[OpenAnswers, ...] = ()
    earlier: Mapping[str, str] = field(default_factory=dict)  # participant → version, before amendments
    answered: tuple[str, str] | None = None  # first and last moment of an answer, where the file says them

    @property
    def note(self) -> str:
        """What every output says of answers that are no data; empty where they are."""
        return {
            "participant": "",
            "test": "Test answers, no data",
            "simulated": "Simulated answers, no data",
        }[self.kind]

    def answers(self, part: str, item: str | None = None) -> Answers:
        """The question of a part with that item; its first question if none is named."""
        for question in self.questions:
            if question.part == part and (item is None or item in question.items or item in question.series):
                return question
        raise ResponsesError(f"part {part!r} has no question with options{f' on {item!r}' if item else ''}")

    def of_participants(self, kept: NDArray[np.bool_]) -> Responses:
        """The responses of some participants."""
        if kept.all():
            return self
        return replace(
            self,
            participants=tuple(name for name, keep in zip(self.participants, kept, strict=True) if keep),
            questions=tuple(question.of_participants(kept) for question in self.questions),
            checks=tuple(check.of_participants(kept) for check in self.checks),
            open=tuple(one.of_participants(kept) for one in self.open),
            trials={part: trials[kept] for part, trials in self.trials.items()},
            median_rt_s=None if self.median_rt_s is None else self.median_rt_s[kept],
        )


def read_responses(path: Path, protocol: Protocol, columns: Mapping[str, str] | None = None) -> Responses:
    """Read `participant, stimulus, item, response` (and `part`, `trial`, `rt_ms`, `session` where present).

    Columns may stand in any order and others are ignored; an empty response is a missing answer. `columns`
    says where a file calls one otherwise, `{"participant": "PID"}`. A table with one column per answer is
    read too. Rows on the practice, of pages outside the parts or on questions without options are left out.
    Anything else that the protocol does not know, and a second answer to the same item, is refused with its
    line. Raises ResponsesError.
    """
    naming = Naming.of(protocol, columns or {})
    with ThreadPoolExecutor(1) as meanwhile:
        sha256 = meanwhile.submit(_sha256, path)
        rows = _read(path, protocol, naming)
    if rows.number == 0:
        raise ResponsesError(f"{path}: holds no answers below its header")
    rows.refuse_two_spellings()
    empty = unanswered(protocol, rows.participants)
    which = _question_of_each_row(rows, protocol, empty)
    rows.refuse_if((which >= 0) & (rows.person < 0), "has no participant")
    filled = [_fill(question, rows, which == q, naming) for q, question in enumerate(empty)]
    return Responses(
        path=path,
        sha256=sha256.result(),
        participants=rows.participants,
        questions=tuple(question for question in filled if question.expected is None),
        checks=tuple(question for question in filled if question.expected is not None),
        trials=_trials(rows, protocol),
        median_rt_s=_median_rt_s(rows, which >= 0),
        kind=_kind(rows),
        open=tuple(open_answers(rows, protocol)),
        answered=time_span(path),
    )


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _read(path: Path, protocol: Protocol, naming: Naming) -> Rows:
    """The rows of a file, which has one answer or one participant per record."""
    asked = [
        {
            stimulus: [i for question in part.questions if question.values for i in question.items]
            for stimulus in part.stimuli
        }
        for part in protocol.parts.values()
    ]
    if unknown := unknown_names(naming.columns, asked):
        raise ResponsesError(
            f"--column {unknown[0]}=…: {unknown[0]!r} is neither one of {', '.join((*REQUIRED, *OPTIONAL))} "
            "nor STIMULUS.ITEM"
        )
    header = read_header(path)
    named = named_columns(path, header, naming.columns)
    if {"stimulus", "item", "response"}.isdisjoint(named) and (
        answers := answer_columns(path, header, naming, asked)
    ):
        return read_wide(path, named, answers, header)
    return read_rows(path, named, header, naming)


def _kind(rows: Rows) -> Kind:
    """Whose answers these are, by the column `session`; without it, participants'."""
    if "session" not in rows.columns:
        return "participant"
    kinds = get_args(Kind)
    code = rows.codes("session", {kind: place for place, kind in enumerate(kinds)} | {"": 0})
    rows.refuse_if(
        code < 0,
        lambda row: (
            f"session {rows.value('session', row)!r} is none of {', '.join(kinds)}; "
            "where the column means something else, leave it out with --column session="
        ),
    )
    first = int(code[0]) if code.size else 0
    rows.refuse_if(
        code != first,
        lambda row: (
            f"{rows.value('session', row)} answers among {kinds[first]} answers; analyse them apart, "
            "for only participants' answers are data"
        ),
    )
    kind: Kind = kinds[first]
    return kind


def _question_of_each_row(rows: Rows, protocol: Protocol, questions: Sequence[Answers]) -> NDArray[np.int16]:
    """Index of the question a row answers, (rows,); −1 for rows that no test is about."""
    asked = {
        (stimulus, item): q
        for q, question in enumerate(questions)
        for stimulus in question.stimuli
        for item in question.items
    }
    judged = {stimulus for part in protocol.parts.values() for stimulus in part.stimuli}
    references = {
        reference
        for part in protocol.parts.values()
        for s in part.stimuli
        if (reference := part.reference_of(s))
    }
    items = {
        stimulus: {item for question in part.questions for item in question.items}
        for part in protocol.parts.values()
        for stimulus in part.stimuli
    }
    unasked, unknown_stimulus, unknown_item = -1, -2, -3

    def place(stimulus: str, item: str) -> int:
        if (stimulus, item) in asked:
            return asked[stimulus, item]
        if stimulus == "practice" or stimulus in references or item in items.get(stimulus, ()):
            return unasked
        return unknown_item if stimulus in judged else unknown_stimulus

    stimuli, names = rows.names("stimulus"), rows.names("item")
    places = np.array([place(s, i) for s in stimuli for i in names], dtype=np.int16)
    table = places.reshape(len(stimuli), len(names))
    which: NDArray[np.int16] = table[rows.columns["stimulus"].codes, rows.columns["item"].codes]
    if "part" in rows.columns:  # rows of pages that belong to no part: demographics, attention checks
        elsewhere = rows.codes("part", {"": 0} | dict.fromkeys(protocol.parts, 0)) < 0
        rows.refuse_if(
            elsewhere & (which >= 0),
            lambda row: (
                f"part {rows.value('part', row)!r} is not in the protocol, though stimulus "
                f"{rows.value('stimulus', row)!r} is; known: {', '.join(protocol.parts)}. "
                "Where the column means something else, leave it out with --column part="
            ),
        )
        which[elsewhere] = unasked
    rows.refuse_if(
        which == unknown_stimulus,
        lambda row: (
            f"stimulus {rows.value('stimulus', row)!r} is not in the protocol; "
            f"known: {', '.join(sorted(judged))}"
        ),
    )
    rows.refuse_if(
        which == unknown_item,
        lambda row: (
            f"item {rows.value('item', row)!r} is not asked about {rows.value('stimulus', row)}; "
            f"known: {', '.join(sorted(items[rows.value('stimulus', row)]))}"
        ),
    )
    return which


def _fill(question: Answers, rows: Rows, mine: NDArray[np.bool_], naming: Naming) -> Answers:
    """The question with the answers of its rows."""
    shape = (len(question.items), len(question.stimuli), len(question.participants))
    items = rows.codes("item", {name: i for i, name in enumerate(question.items)}, mine=mine)
    stimuli = rows.codes("stimulus", {name: i for i, name in enumerate(question.stimuli)}, mine=mine)
    options = naming.options(question)
    written = {answer: option_of(answer, options) for answer in rows.names("response")}
    answers = rows.codes("response", written, unknown=UNKNOWN, mine=mine)
    rows.refuse_if(
        among(mine, answers == UNKNOWN),
        lambda row: (
            f"response {rows.value('response', row)!r} is not an answer to "
            f"{rows.value('item', row)}; known: {', '.join(filter(None, options))}, or empty for none"
            f"{rows.hint(row)}"
        ),
    )
    cells = np.ravel_multi_index((items, stimuli, rows.person[mine]), shape)
    rows.refuse_second(mine, cells, int(np.prod(shape)))
    codes = np.full(shape, MISSING, dtype=np.int8)
    codes.reshape(-1)[cells] = answers
    return replace(question, codes=codes.T)


def _trials(rows: Rows, protocol: Protocol) -> dict[str, FloatArray]:
    """When in its part each participant saw each stimulus, by the column `trial`."""
    if "trial" not in rows.columns:
        return {}
    names = (name for name in rows.names("trial") if name.isdecimal() and len(name) <= DIGITS)
    trial = rows.codes("trial", {name: int(name) for name in names})
    seen = {}
    for part in protocol.parts.values():
        stimulus = rows.codes("stimulus", {name: i for i, name in enumerate(part.stimuli)})
        there = (stimulus >= 0) & (trial >= 0) & (rows.person >= 0)
        times = np.full((len(rows.participants), len(part.stimuli)), np.nan)
        times[rows.person[there], stimulus[there]] = trial[there]
        seen[part.id] = times
    return seen


def _median_rt_s(rows: Rows, mine: NDArray[np.bool_]) -> FloatArray | None:
    """Each participant's median time per answer, (participants,)."""
    if "rt_ms" not in rows.columns:
        return None
    times = np.array([_milliseconds(written) for written in rows.names("rt_ms")])[rows.columns["rt_ms"].codes]
    rows.refuse_if(
        mine & np.isinf(times),
        lambda row: f"rt_ms {rows.value('rt_ms', row)!r} is not a number of milliseconds",
    )
    timed = mine & ~np.isnan(times)
    return _medians(times[timed] / 1000, rows.person[timed], len(rows.participants))


def _milliseconds(written: str) -> float:
    """A number, NaN where nothing is written, infinity where it is no number."""
    try:
        number = float(written.replace(",", ".") or "nan")
    except ValueError:
        return np.inf
    return number if np.isfinite(number) or not written else np.inf


def _medians(values: FloatArray, groups: NDArray[np.int32], number: int) -> FloatArray:
    """The median of each group, (number,); NaN where it is empty."""
    ordered = values[np.lexsort((values, groups))]
    sizes = np.bincount(groups, minlength=number)
    first, there = np.cumsum(sizes) - sizes, sizes > 0
    medians = np.full(number, np.nan)
    lower, upper = ((first + (sizes - 1) // 2)[there], (first + sizes // 2)[there])
    medians[there] = (ordered[lower] + ordered[upper]) / 2
    return medians
