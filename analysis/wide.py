"""Tables with one record per participant and one column per answer, as Qualtrics and LimeSurvey have."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from analysis.rows import OPTIONAL, REQUIRED, ResponsesError, Rows, read_columns

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
    import pandas as pd

    if "participant" not in columns:
        raise ResponsesError(
            f"{path}:1: has one column per answer, but none called participant; name it as in "
            "--column participant=ResponseId"
        )
    carried = [name for name in ("participant", "session") if name in columns]
    frame = read_columns(
        path, dict.fromkeys([columns[name] for name in carried] + [*answers.values()], "str")
    )
    skipped = 2 if any(IMPORT_ID in str(cell) for cell in frame.iloc[1:2].to_numpy().ravel()) else 0
    frame = frame.iloc[skipped:]
    n, k = len(frame), len(answers)
    long = {
        name: pd.Categorical(np.repeat(frame[columns[name]].to_numpy(dtype=object), k)) for name in carried
    }
    for place, name in enumerate(("stimulus", "item")):
        long[name] = pd.Categorical(np.tile([answer[place] for answer in answers], n))
    long["response"] = pd.Categorical(frame[[*answers.values()]].to_numpy(dtype=object).ravel())
    return Rows(path, pd.DataFrame(long), per_record=k, skipped=skipped)


def unknown_names(said: Mapping[str, str], asked: Asked) -> list[str]:
    """Names said to be a column that are neither a column of ours nor STIMULUS.ITEM."""
    answers = {f"{stimulus}.{item}" for stimulus, items in asked.items() for item in items}
    return [name for name in said if name not in answers and name not in {*REQUIRED, *OPTIONAL}]


def _plain(name: str) -> str:
    """A column's name without what tells its parts apart: joy[anger], joy.anger, Joy_Anger."""
    return re.sub(r"[\W_]+", " ", name).strip().lower()
