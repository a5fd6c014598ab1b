"""A published table typed off as CSV: which of its columns hold what."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Literal

from analysis.printed_layout import Record, number, read_records
from stimuli.errors import InputError

Kind = Literal["shares", "percentages", "counts", "means"]
MEANS = {"mean", "m"}
SPREADS, SIZES = {"sd", "s.d."}, {"n"}  # beside means
OTHER = re.compile(
    r"(?i)s\.?d\.?|s\.?e\.?(m\.?)?|n|t|df|p|d|g|f|z|w|ci.*|.*[ _]ci|.*\[.*ci\]|min|max|median|mdn"
    r"|p[ _-]?value|p_.*|.*_p(_.*)?|.*_ci_.*"  # as in the tables that study analyse writes
)


@dataclass(frozen=True)
class PrintedRow:
    """A row: what it is about, and its numbers as printed (the number of decimals counts)."""

    line: int
    labels: tuple[str, ...]
    cells: tuple[Decimal, ...]
    sd: Decimal | None = None  # of a mean
    n: int | None = None  # participants behind a mean, where the table says so row by row

    @property
    def name(self) -> str:
        """The row's labels as one."""
        return "/".join(label for label in self.labels if label)


@dataclass(frozen=True)
class PrintedTable:
    """The rows to check."""

    kind: Kind
    rows: tuple[PrintedRow, ...]
    whole: bool  # whether the cells of a row make up one whole, as those of most rows do
    unchecked: tuple[str, ...]  # columns of other numbers


def read_table(path: Path, n: int) -> PrintedTable:
    """Read a table from a CSV file. Raises InputError."""
    return table_of(path, *read_records(path), n)


def table_of(path: Path, header: Sequence[str], records: Sequence[Record], n: int) -> PrintedTable:
    """Tell what a table holds: columns of words are labels, columns of numbers its cells.

    A column in which most cells are numbers is one of numbers, and a cell of it that is none is refused.
    Columns called n, sd, se, t, df, p and the like are not checked. Where there is a column called `mean` or
    `M`, no other is; else the cells are percentages if they bear "%" or rows add up to 100, counts if they
    are whole and above 1, and else shares. Raises InputError.
    """
    numeric = [place for place, name in enumerate(header) if _holds_numbers(path, name, place, records)]
    means = [place for place in numeric if header[place].lower() in MEANS]
    cells = means or _without_numbering(
        [place for place in numeric if not OTHER.fullmatch(header[place])], records
    )
    if not cells:
        raise InputError(
            f"{path}: no column holds numbers to check; cells are printed numbers such as 0.79, 79% or 27, "
            "or means in a column called mean"
        )
    labels = [p for p, name in enumerate(header) if p not in numeric and not OTHER.fullmatch(name)]
    rows = [
        PrintedRow(
            record.line,
            tuple(record.cells[place] for place in labels),
            tuple(number(record.cells[place]) or Decimal(0) for place in cells),
            *_beside(record, header, numeric if means else ()),
        )
        for record in records
    ]
    marked = any("%" in record.cells[place] for record in records for place in cells) or any(
        "%" in header[place] or "percent" in header[place].lower() for place in cells
    )
    kind = "means" if means else _kind(rows, n, marked=marked)
    if kind == "percentages":
        rows = [
            PrintedRow(row.line, row.labels, tuple(cell.scaleb(-2) for cell in row.cells)) for row in rows
        ]
    return PrintedTable(
        kind=kind,
        rows=tuple(rows),
        whole=kind != "means" and len(cells) > 1 and _mostly_whole(rows, n if kind == "counts" else 1),
        unchecked=tuple(
            header[place]
            for place in numeric
            if place not in cells and not (means and header[place].lower() in SPREADS | SIZES)
        ),
    )


def _beside(
    record: Record, header: Sequence[str], places: Sequence[int]
) -> tuple[Decimal | None, int | None]:
    """The standard deviation and the number of participants beside a mean."""
    found = {header[place].lower(): number(record.cells[place]) for place in places}
    sd = next((value for name, value in found.items() if name in SPREADS), None)
    n = next((value for name, value in found.items() if name in SIZES), None)
    return sd, int(n) if n else None


def _kind(rows: Sequence[PrintedRow], n: int, *, marked: bool) -> Kind:
    if marked or (n != 100 and len(rows[0].cells) > 1 and _mostly_whole(rows, 100)):
        return "percentages"
    cells = [cell for row in rows for cell in row.cells]
    whole = all(_exponent(cell) >= 0 for cell in cells)
    return "counts" if whole and max(cells) > 1 else "shares"


def _mostly_whole(rows: Sequence[PrintedRow], total: int) -> bool:
    """Whether more than half of the rows add up to the total, but for rounding."""
    rounding = [
        Decimal(len(row.cells)).scaleb(min(_exponent(cell) for cell in row.cells)) / 2 for row in rows
    ]
    sums = [sum(row.cells, Decimal(0)) for row in rows]
    close = [abs(one - total) <= slack for one, slack in zip(sums, rounding, strict=True)]
    return 2 * sum(close) > len(rows)


def _exponent(cell: Decimal) -> int:
    exponent = cell.as_tuple().exponent
    return exponent if isinstance(exponent, int) else 0


def _holds_numbers(path: Path, name: str, place: int, records: Sequence[Record]) -> bool:
    """Whether a column is one of numbers; refused where it is, but for a cell."""
    bad = [record for record in records if number(record.cells[place]) is None]
    if 2 * len(bad) >= len(records):
        return False
    if bad and OTHER.fullmatch(name) and name.lower() not in SPREADS | SIZES:
        return False  # such as "< .001" among p-values
    if bad:
        value = bad[0].cells[place]
        raise InputError(
            f"{path}:{bad[0].line}: column {name!r} holds numbers, but {value!r} is none"
            if value
            else f"{path}:{bad[0].line}: column {name!r} is empty here; leave out rows without numbers"
        )
    return True


def _without_numbering(places: Sequence[int], records: Sequence[Record]) -> list[int]:
    """Columns of numbers without those that number the rows: whole beside columns with decimals."""

    def whole(place: int) -> bool:
        numbers = [number(record.cells[place]) or Decimal(0) for record in records]
        return all(_exponent(number) >= 0 for number in numbers) and max(numbers) > 1

    numbering = [place for place in places if whole(place)]
    return [place for place in places if place not in numbering or len(numbering) == len(places)]
