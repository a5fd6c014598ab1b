"""Tables with one record per participant and one column per answer, as survey programs export them.

Qualtrics has two more rows of headings below the first, SoSci Survey one if labels were asked for; both say
of each record whether it is an answer or a test.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from analysis.columns import Column, read_columns
from analysis.fields import ResponsesError
from analysis.naming import Naming
from analysis.rows import OPTIONAL, REQUIRED, Rows

Asked = Mapping[str, Sequence[str]]  # stimulus → items
STATUS, PREVIEW, TEST, SPAM = "Status", 1, 2, 8  # Qualtrics' column, and what its numbers are sums of
IMPORT_ID = '{"ImportId"'  # in the third line of Qualtrics' tables
CASE, MODE, INTERVIEW = "CASE", "MODE", "interview"  # SoSci Survey's columns, and the mode of an answer
SOSCI = {CASE, "QUESTNNR"}  # what its tables are known by


def answer_columns(
    path: Path, header: Sequence[str], naming: Naming, parts: Sequence[Asked]
) -> dict[tuple[str, str], str]:
    """The column of each (stimulus, item): as said, else named STIMULUS_ITEM, STIMULUS[ITEM] or the like.

    Where a stimulus is judged on one item only, STIMULUS alone will do. A part may be elsewhere altogether,
    but of one that is here no column may be missing, unless it is said to be "".
    """
    plain = {_plain(name): name for name in reversed(header)}
    found: dict[tuple[str, str], str] = {}
    for asked in parts:
        here, missing = {}, []
        for stimulus, items in asked.items():
            for item in items:
                spellings = naming.spellings(stimulus, item, alone=len(items) == 1)
                named = (plain[_plain(name)] for name in spellings if _plain(name) in plain)
                column = naming.columns.get(f"{stimulus}.{item}", next(named, None))
                if column is None:
                    missing.append(f"{stimulus}.{item}")
                elif column:
                    here[stimulus, item] = column
        if here and missing:
            more = f" and {len(missing) - 3} more" if len(missing) > 3 else ""
            raise ResponsesError(
                f"{path}:1: has no column for {', '.join(missing[:3])}{more}; name it in the protocol, under "
                f"analysis: responses: columns, or as in --column {missing[0]}=THEIRS; empty for none"
            )
        found |= here
    return found


def read_wide(
    path: Path, columns: Mapping[str, str], answers: Mapping[tuple[str, str], str], header: Sequence[str]
) -> Rows:
    """Read such a table as rows of one answer each; `answers` as from `answer_columns`."""
    if "participant" not in columns:
        raise ResponsesError(
            f"{path}:1: has one column per answer, but none called participant; name it as in "
            "--column participant=ResponseId"
        )
    carried = [name for name in ("participant", "session") if name in columns]
    apart = {STATUS, CASE, MODE} & set(header)
    found = read_columns(path, {*(columns[name] for name in carried), *answers.values(), *apart})
    sosci = set(header) >= SOSCI
    skipped = int(not found[CASE].at(0).isdecimal()) if sosci else _headings_of_qualtrics(found.values())
    given = [found[theirs] for theirs in answers.values()]
    records, k = given[0].codes.size - skipped, len(given)
    first = np.cumsum([0, *(len(one.values) for one in given)])  # of each column's values among all
    placed = [one.codes[skipped:] + start for one, start in zip(given, first, strict=False)]
    long = {
        name: Column.of(found[theirs].values, np.repeat(found[theirs].codes[skipped:], k))
        for name, theirs in columns.items()
        if name in carried
    }
    for place, name in enumerate(("stimulus", "item")):
        long[name] = Column.of([answer[place] for answer in answers], np.tile(np.arange(k), records))
    values = [value for one in given for value in one.values]
    long["response"] = Column.of(values, np.stack(placed, axis=1).ravel())
    rows = Rows(path, long, per_record=k, skipped=skipped)
    if sosci and MODE in found:
        _refuse_tests(rows, MODE, found[MODE], lambda mode: mode == INTERVIEW)
    elif skipped and STATUS in found:
        _refuse_tests(rows, STATUS, found[STATUS], _is_answer)
    return rows


def _headings_of_qualtrics(columns: Iterable[Column]) -> int:
    return 2 if any(IMPORT_ID in one.at(1) for one in columns if one.codes.size > 1) else 0


def _refuse_tests(rows: Rows, name: str, said: Column, is_answer: Callable[[str], bool]) -> None:
    """Refuse previews, tests and spam among the answers."""
    bad = np.array([not is_answer(value) for value in said.values])[said.codes[rows.skipped :]]
    rows.refuse_if(
        np.repeat(bad, rows.per_record),
        lambda row: (
            f"{name} {said.at(rows.skipped + row // rows.per_record)!r} is no participant's answer; "
            "leave out such rows"
        ),
    )


def _is_answer(status: str) -> bool:
    """Whether a status, in words or as Qualtrics' number, is that of a participant's answer."""
    if status.isdecimal():
        return not int(status) & (PREVIEW | TEST | SPAM)
    return not re.search(r"preview|test|spam", status, re.IGNORECASE)


def unknown_names(said: Mapping[str, str], parts: Sequence[Asked]) -> list[str]:
    """Names said to be a column that are neither a column of ours nor STIMULUS.ITEM."""
    answers = {f"{stimulus}.{item}" for asked in parts for stimulus, items in asked.items() for item in items}
    return [name for name in said if name not in answers and name not in {*REQUIRED, *OPTIONAL}]


def _plain(name: str) -> str:
    """A column's name without what tells its parts apart: joy[anger], joy.anger, Joy_Anger."""
    return re.sub(r"[\W_]+", " ", name).strip().lower()
