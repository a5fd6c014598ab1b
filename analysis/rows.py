"""Rows of a file of responses: what stands in them, and the line of any that must be mended."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import EllipsisType

import numpy as np
from numpy.typing import NDArray

from analysis.answers import MISSING
from analysis.columns import Column, read_columns
from analysis.fields import ResponsesError, delimiter
from analysis.naming import Naming

REQUIRED = ("participant", "stimulus", "item", "response")
OPTIONAL = ("part", "trial", "rt_ms", "session")
PADDING = re.compile(r"^0+(?=\d)|(?<=\d)[.,]0+$")  # zeros that a number may be written with or without


class Rows:
    """The rows of a file by column, and their line numbers for whoever has to mend them."""

    def __init__(
        self, path: Path, columns: Mapping[str, Column], *, per_record: int = 1, skipped: int = 0
    ) -> None:
        self.path = path
        self.columns = columns
        self.per_record = per_record  # rows made from each record of the file
        self.skipped = skipped  # records below the header that hold no answers

    @property
    def number(self) -> int:
        """How many there are."""
        return next(iter(self.columns.values())).codes.size

    @cached_property
    def participants(self) -> tuple[str, ...]:
        """Who answered, sorted."""
        return tuple(sorted(name for name in self.names("participant") if name.strip()))

    @cached_property
    def person(self) -> NDArray[np.int32]:
        """The place of each row's participant among them, (rows,); −1 where none is named."""
        return self.codes("participant", {name: i for i, name in enumerate(self.participants)})

    def names(self, column: str) -> Sequence[str]:
        """Every value that occurs in a column."""
        return self.columns[column].values

    def codes(
        self,
        column: str,
        places: Mapping[str, int],
        unknown: int = MISSING,
        *,
        mine: NDArray[np.bool_] | EllipsisType = ...,
    ) -> NDArray[np.int32]:
        """The place of each row's value, (rows,), or of only those of `mine`."""
        ours = np.array([places.get(name, unknown) for name in self.names(column)], dtype=np.int32)
        return ours.take(self.columns[column].codes[mine])

    def value(self, column: str, row: int) -> str:
        """What stands in a column of one row."""
        return self.columns[column].at(row)

    def line(self, row: int) -> int:
        """The line a row ends on; line breaks inside quotes make it differ from the row's number."""
        with self.path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, delimiter=delimiter(self.path))
            filled = (reader.line_num for record in reader if record)
            record = 1 + self.skipped + row // self.per_record
            return next(line for number, line in enumerate(filled) if number == record)

    def hint(self, row: int) -> str:
        """What may be wrong with a row because of where it stands."""
        is_first = self.per_record > 1 and row < self.per_record
        return ". If this row holds headings, leave it out" if is_first else ""

    def refuse_second(self, mine: NDArray[np.bool_], cells: NDArray[np.int64], number: int) -> None:
        """Refuse two of the rows `mine` that answer the same; `cells` says what each does, of `number`."""
        answered = np.zeros(number, dtype=bool)
        answered[cells] = True
        if np.count_nonzero(answered) == cells.size:
            return
        again = np.ones(cells.size, dtype=bool)
        again[np.unique(cells, return_index=True)[1]] = False

        def message(row: int) -> str:
            cell = cells[np.count_nonzero(mine[:row])]
            earlier = int(np.flatnonzero(mine)[np.argmax(cells == cell)])
            answered = ", ".join(self.value(column, row) for column in ("participant", "stimulus", "item"))
            return (
                f"second answer to ({answered}); the first is in line {self.line(earlier)}. Keep one of them"
            )

        self.refuse_if(among(mine, again), message)

    def refuse_two_spellings(self) -> None:
        """Refuse the file if 1, 01, 1.0 and "1 " stand beside each other: one participant, or several?"""
        spelled: dict[str, str] = {}
        for name in self.participants:
            first = spelled.setdefault(_unpadded(name), name)
            if first != name:
                self.refuse_if(
                    self.codes("participant", {name: 1}) == 1,
                    f"participant {name!r} is also written {first!r}; write one participant in one way",
                )

    def refuse_if(self, bad: NDArray[np.bool_], message: str | Callable[[int], str]) -> None:
        """Refuse the file at the first bad row."""
        if bad.any():
            row = int(np.argmax(bad))
            said = message if isinstance(message, str) else message(row)
            records = np.unique(np.flatnonzero(bad) // self.per_record).size
            more = f" ({records} rows like this)" if records > 1 else ""
            raise ResponsesError(f"{self.path}:{self.line(row)}: {said}{more}")


def _unpadded(name: str) -> str:
    """A name as the number that it may be, written plainly."""
    bare = name.strip()
    return PADDING.sub("", bare) if "0" in (bare[0], bare[-1]) else bare


def among(mine: NDArray[np.bool_], bad: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which of all rows are bad, given which of `mine` are."""
    marked = mine.copy()
    marked[mine] = bad
    return marked


def read_rows(path: Path, columns: Mapping[str, str], header: Sequence[str], naming: Naming) -> Rows:
    """Read columns as the texts written in the file; `columns` maps our names to those of the file."""
    missing = [name for name in REQUIRED if name not in columns]
    if missing:
        raise ResponsesError(
            f"{path}:1: needs the columns {', '.join(REQUIRED)}; {', '.join(missing)} not among "
            f"{', '.join(map(repr, header))}. Name them as in --column {missing[0]}=THEIRS, or give one "
            "column per answer, named STIMULUS_ITEM"
        )
    found = read_columns(path, columns.values())
    return Rows(path, {ours: naming.ours(ours, found[theirs]) for ours, theirs in columns.items()})


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
