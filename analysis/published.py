"""Published numbers as data, and whether they can be true.

A share of n people is k/n for a whole k, so most printed shares are impossible for a wrong n or a misprint:
the GRIM test (Brown & Heathers 2017, Soc. Psychol. Personal. Sci. 8). The same holds for means of
whole-number ratings.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from math import floor
from pathlib import Path

import numpy as np

from analysis.apa import probability, t_sentence
from analysis.statistics.fisher import Fisher, fisher
from analysis.statistics.student_t import student_t
from analysis.statistics.t_test import TTest
from stimuli.errors import InputError

# Of 34 participants, how many called the high- and the low-intensity motion "higher" (Hielscher, Bulling &
# Arras, IROS 2025, Table II): the only counts that give the printed shares. The printed row Arc/low,
# 1.00 / 1.00, cannot be; the count in line with the text is 0.
N = 34
HIGHER: Mapping[str, Mapping[str, int]] = {
    "arc": {"high": 32, "low": 0},
    "ant": {"high": 27, "low": 9},
    "time": {"high": 34, "low": 0},
    "exa": {"high": 34, "low": 0},
    "sec": {"high": 32, "low": 1},
    "follow": {"high": 19, "low": 10},
}

TABLE_II = """\
principle,level,higher,lower
arc,high,0.94,0.06
arc,low,1.00,1.00
ant,high,0.79,0.21
ant,low,0.26,0.74
time,high,1.00,0.00
time,low,0.00,1.00
exa,high,1.00,0.00
exa,low,0.00,1.00
sec,high,0.94,0.06
sec,low,0.03,0.97
follow,high,0.56,0.44
follow,low,0.29,0.71
"""


@dataclass(frozen=True)
class Fault:
    """Something printed that cannot be true."""

    line: int
    row: str
    message: str

    def __str__(self) -> str:
        return f"line {self.line}, {self.row}: {self.message}"


@dataclass(frozen=True)
class Recomputed:
    """The tests that follow from two rows of printed shares."""

    name: str
    counts: tuple[tuple[int, int], tuple[int, int]]  # of both rows: first answer, second answer
    student: TTest  # one-sided, first row above second
    fisher: Fisher

    def __str__(self) -> str:
        (first, _), (second, _) = self.counts
        return (
            f"{self.name}: {first} against {second} of {sum(self.counts[0])}; {t_sentence(self.student)}; "
            f"Fisher's exact p {probability(self.fisher.p)}"
        )


@dataclass(frozen=True)
class Verification:
    """What a printed table says about itself."""

    n: int
    cells: int  # numbers checked
    faults: tuple[Fault, ...]
    recomputed: tuple[Recomputed, ...]
    other_sizes: tuple[int, ...]  # other numbers of participants, up to twice n, that fit all good rows

    def __str__(self) -> str:
        faults = [f"{len(self.faults)} cannot be:", *(f"  {fault}" for fault in self.faults)]
        tests = [f"  {one}" for one in self.recomputed]
        sizes = ", ".join(map(str, self.other_sizes))
        return "\n".join(
            [
                f"{self.cells} printed numbers checked against n = {self.n}.",
                *(faults if self.faults else ["All of them are possible."]),
                *(
                    ["What follows from the possible rows (independent answers, one-sided):", *tests]
                    if tests
                    else []
                ),
                f"The possible rows would also fit n = {sizes}."
                if sizes
                else f"There is no other n up to {2 * self.n} that fits possible rows.",
            ]
        )


@dataclass(frozen=True)
class _Row:
    line: int
    labels: tuple[str, ...]
    cells: tuple[Decimal, ...]
    means: bool  # cells are means of ratings, not shares of one whole

    @property
    def name(self) -> str:
        return "/".join(self.labels)


def verify(table: Path, n: int, *, items: int = 1) -> Verification:
    """Check a printed table of shares or means that comes from n participants with one answer per cell.

    Columns of words are labels, columns of numbers are cells, as printed (the number of decimals counts). The
    cells of a row are shares of one whole, unless a column is called `mean`; then that column is checked as
    the mean of `items` whole-number ratings per participant. Raises InputError for a table that cannot be
    read.
    """
    rows = _read(table)
    faults = [fault for row in rows for fault in _faults(row, n * items if row.means else n)]
    bad = {fault.line for fault in faults}
    good = [row for row in rows if row.line not in bad]
    fitting = [
        size
        for size in range(2, 2 * n + 1)
        if good and size != n and not any(_faults(row, size) for row in good)
    ]
    return Verification(
        n=n,
        cells=sum(len(row.cells) for row in rows),
        faults=tuple(faults),
        recomputed=tuple(_recompute(good, n)),
        other_sizes=tuple(fitting),
    )


def counts_behind(printed: Decimal, n: int) -> tuple[int, ...]:
    """Every whole k for which k/n rounds to what is printed, a half rounding either way."""
    half = Fraction(1, 2) / 10 ** _decimals(printed)
    value = Fraction(printed)
    around = floor(value * n)
    reach = floor(half * n) + 1
    return tuple(k for k in range(around - reach, around + reach + 2) if abs(Fraction(k, n) - value) <= half)


def _decimals(printed: Decimal) -> int:
    exponent = printed.as_tuple().exponent
    return max(0, -exponent) if isinstance(exponent, int) else 0


def _faults(row: _Row, n: int) -> list[Fault]:
    impossible = [cell for cell in row.cells if not counts_behind(cell, n)]
    if impossible:
        kind = "mean" if row.means else "share"
        return [Fault(row.line, row.name, f"{cell} is no {kind} of {n} answers") for cell in impossible]
    if row.means:
        return []
    if any(not 0 <= cell <= 1 for cell in row.cells):
        return [Fault(row.line, row.name, f"shares lie between 0 and 1, not {max(row.cells, key=abs)}")]
    if _whole(row, n) is None:
        total = sum(row.cells)
        return [Fault(row.line, row.name, f"shares add up to {total}, and no counts of {n} give them")]
    return []


def _whole(row: _Row, n: int) -> tuple[int, ...] | None:
    """Counts of the row that add up to n, if any do."""
    chosen: list[tuple[int, ...]] = [()]
    for cell in row.cells:
        chosen = [(*before, k) for before in chosen for k in counts_behind(cell, n)]
    return next((counts for counts in chosen if sum(counts) == n), None)


def _recompute(rows: Sequence[_Row], n: int) -> list[Recomputed]:
    """The tests of each pair of rows that share their first label and have two answers."""
    found = []
    by_name: dict[str, list[_Row]] = {}
    for row in rows:
        if not row.means and len(row.cells) == 2 and row.labels:
            by_name.setdefault(row.labels[0], []).append(row)
    for name, pair in by_name.items():
        counts = [_whole(row, n) for row in pair]
        if len(pair) == 2 and counts[0] and counts[1]:
            (k1, _), (k2, _) = counts[0], counts[1]
            student = student_t(_answers(k1, n), _answers(k2, n), "greater")
            both = ((k1, n - k1), (k2, n - k2))
            found.append(Recomputed(name, both, student, fisher(k1, n, k2, n, "greater")))
    return found


def _answers(k: int, n: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """K ones and n − k zeros."""
    return np.repeat([1.0, 0.0], [k, n - k])


def _read(table: Path) -> list[_Row]:
    try:
        with table.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.DictReader(file)
            records = [(reader.line_num, record) for record in reader]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{table}: cannot be read: {error}") from error
    if not records or reader.fieldnames is None:
        raise InputError(f"{table}: holds no rows below its header")
    numeric = [name for name in reader.fieldnames if all(_number(record[name]) for _, record in records)]
    means = "mean" in numeric
    cells = ["mean"] if means else numeric
    if not cells:
        raise InputError(f"{table}: no column holds numbers only; cells are printed numbers such as 0.79")
    labels = [name for name in reader.fieldnames if name not in numeric]
    return [
        _Row(
            line,
            tuple(record[name] or "" for name in labels),
            tuple(Decimal(record[name]) for name in cells),
            means,
        )
        for line, record in records
    ]


def _number(text: str | None) -> bool:
    try:
        return Decimal(text or "").is_finite()
    except InvalidOperation:
        return False
