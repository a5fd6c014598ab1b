"""Rows of a CSV file: columns as integer codes, and the line of any row that must be mended."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stimuli.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

REQUIRED = ("participant", "stimulus", "item", "response")
OPTIONAL = ("part", "trial", "rt_ms", "session")
MISSING = -1


class ResponsesError(InputError):
    """A file of responses that cannot be read without guessing."""


class Rows:
    """The rows of a file as integer codes, with their line numbers for whoever has to mend them."""

    def __init__(self, path: Path, frame: pd.DataFrame, *, per_record: int = 1, skipped: int = 0) -> None:
        self.path = path
        self.frame = frame
        self.per_record = per_record  # rows made from each record of the file
        self.skipped = skipped  # records below the header that hold no answers

    def names(self, column: str) -> list[str]:
        """Every value that occurs in a column."""
        names: list[str] = self.frame[column].cat.categories.astype(str).tolist()
        return names

    def codes(self, column: str, places: Mapping[str, int], unknown: int = MISSING) -> NDArray[np.int64]:
        """The place of each row's value, (rows,)."""
        ours = np.array(
            [places.get(name, unknown) for name in self.names(column)] + [unknown], dtype=np.int64
        )
        return ours[self.frame[column].cat.codes.to_numpy()]

    def value(self, column: str, row: int) -> str:
        """What stands in a column of one row."""
        return str(self.frame[column].iloc[row])

    def line(self, row: int) -> int:
        """The line a row ends on; line breaks inside quotes make it differ from the row's number."""
        with self.path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, delimiter=_delimiter(self.path))
            filled = (reader.line_num for record in reader if record)
            record = 1 + self.skipped + row // self.per_record
            return next(line for number, line in enumerate(filled) if number == record)

    def refuse_if(self, bad: NDArray[np.bool_], message: str | Callable[[int], str]) -> None:
        """Refuse the file at the first bad row."""
        if bad.any():
            row = int(np.argmax(bad))
            said = message if isinstance(message, str) else message(row)
            more = f" ({int(bad.sum())} rows like this)" if bad.sum() > 1 else ""
            raise ResponsesError(f"{self.path}:{self.line(row)}: {said}{more}")


def read_rows(path: Path, columns: Mapping[str, str], header: Sequence[str]) -> Rows:
    """Read columns as the texts written in the file; `columns` maps our names to those of the file."""
    missing = [name for name in REQUIRED if name not in columns]
    if missing:
        raise ResponsesError(
            f"{path}:1: needs the columns {', '.join(REQUIRED)}; {', '.join(missing)} not among "
            f"{', '.join(header) or 'none'}. Name them as in --column {missing[0]}=THEIRS, or give one "
            "column per answer, named STIMULUS_ITEM"
        )
    theirs = {theirs: ours for ours, theirs in columns.items()}
    frame = read_columns(
        path, {name: "str" if ours == "rt_ms" else "category" for name, ours in theirs.items()}
    )
    numbers = [
        name for name, ours in theirs.items() if ours != "response" and _taken_for_numbers(frame[name])
    ]
    if numbers:  # names are texts: 01 and 1 are two participants
        frame[numbers] = read_columns(path, dict.fromkeys(numbers, "str")).astype("category")
    return Rows(path, frame.rename(columns=theirs))


def _taken_for_numbers(column: pd.Series[Any]) -> bool:
    """Whether pandas read a column of categories, all of which look like numbers, as numbers."""
    return column.dtype == "category" and column.cat.categories.dtype.kind in "iufb"


def read_columns(path: Path, types: Mapping[str, str]) -> pd.DataFrame:
    """Columns of a file as text, none of it taken for a number or a missing value."""
    import pandas as pd

    try:
        return pd.read_csv(
            path,
            sep=_delimiter(path),
            usecols=list(types),
            dtype=dict(types),
            keep_default_na=False,
            encoding="utf-8-sig",
        )
    except UnicodeDecodeError as error:
        line = path.read_bytes()[: error.start].count(b"\n") + 1
        raise ResponsesError(f"{path}:{line}: is not UTF-8; save the file as CSV UTF-8") from error
    except pd.errors.ParserError as error:
        raise ResponsesError(
            f"{path}: {str(error).removeprefix('Error tokenizing data. C error: ')}"
        ) from error


def read_header(path: Path) -> list[str]:
    """The names of the columns, or what is wrong with them."""
    try:
        first = _first_bytes(path)
    except OSError as error:
        raise ResponsesError(f"{path}: cannot be read: {error.strerror}") from error
    if first[:2] in {b"\xff\xfe", b"\xfe\xff"}:
        raise ResponsesError(f"{path}: is UTF-16 (Excel's 'Unicode text'); save the file as CSV UTF-8")
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
        columns = next(csv.reader(file, delimiter=_delimiter(path)), [])
    if twice := [column for column in columns if columns.count(column) > 1]:
        raise ResponsesError(f"{path}:1: column {twice[0]!r} stands twice")
    return columns


def named_columns(path: Path, header: Sequence[str], said: Mapping[str, str]) -> dict[str, str]:
    """Which column of the file is meant by each of our names: as said, else the one of that name.

    A name said to be the empty text is left out.
    """
    for ours, theirs in said.items():
        if theirs and theirs not in header:
            raise ResponsesError(
                f"{path}:1: column {theirs!r}, said to be {ours}, is not among {', '.join(header)}"
            )
    found = {name: name for name in (*REQUIRED, *OPTIONAL) if name in header and name not in said.values()}
    return {ours: theirs for ours, theirs in (found | dict(said)).items() if theirs}


def _first_bytes(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(2)


def _delimiter(path: Path) -> str:
    """Comma, semicolon or tab: whichever the header has most of."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        header = file.readline()
    return max(",;\t", key=header.count)
