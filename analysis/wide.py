"""Tables with one record per participant and one column per answer, as Qualtrics and LimeSurvey have."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from analysis.columns import Column, read_columns
from analysis.fields import ResponsesError
from analysis.rows import OPTIONAL, REQUIRED, Rows

Asked = Mapping[str, Sequence[str]]  # stimulus → items
IMPORT_ID = '{"ImportId"'  # in the third line of Qualtrics' tables


def answer_columns(
    header: Sequence[str], said: Mapping[str, str], asked: Asked
) -> dict[tuple[str, str], str]:
    """The column of each (stimulus, item): as said, else named STIMULUS_ITEM, STIMULUS[ITEM] or the like.

    Where a stimulus is judged on one item only, STIMULUS alone will do.
    """
    plain = {_plain(name): name for name in reversed(header)}
    found = {}
    for stimulus, items in asked.items():
        for item in items:
            spellings = [f"{stimulus}_{item}", *([stimulus] if len(items) == 1 else [])]
            column = said.get(f"{stimulus}.{item}") or next(
                (plain[_plain(name)] for name in spellings if _plain(name) in plain), None
            )
            if column is not None:
                found[stimulus, item] = column
    return found


def read_wide(path: Path, columns: Mapping[str, str], answers: Mapping[tuple[str, str], str]) -> Rows:
    """Read such a table as rows of one answer each; `answers` as from `answer_columns`."""
    if "participant" not in columns:
        raise ResponsesError(
            f"{path}:1: has one column per answer, but none called participant; name it as in "
            "--column participant=ResponseId"
        )
    carried = [name for name in ("participant", "session") if name in columns]
    found = read_columns(path, {*(columns[name] for name in carried), *answers.values()})
    skipped = 2 if any(IMPORT_ID in one.at(1) for one in found.values() if one.codes.size > 1) else 0
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
    return Rows(path, long, per_record=k, skipped=skipped)


def unknown_names(said: Mapping[str, str], asked: Asked) -> list[str]:
    """Names said to be a column that are neither a column of ours nor STIMULUS.ITEM."""
    answers = {f"{stimulus}.{item}" for stimulus, items in asked.items() for item in items}
    return [name for name in said if name not in answers and name not in {*REQUIRED, *OPTIONAL}]


def _plain(name: str) -> str:
    """A column's name without what tells its parts apart: joy[anger], joy.anger, Joy_Anger."""
    return re.sub(r"[\W_]+", " ", name).strip().lower()
