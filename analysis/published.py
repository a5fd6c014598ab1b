"""Published numbers as data, and whether they can be true.

Shares, means and standard deviations must come from whole answers (`analysis.grim`), and counts must add up.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

import numpy as np

from analysis.apa import probability, t_sentence
from analysis.grim import counts_behind, sd_is_possible
from analysis.printed_table import Kind, PrintedRow, PrintedTable, read_table
from analysis.statistics.fisher import Fisher, fisher
from analysis.statistics.samples import Moments
from analysis.statistics.student_t import student_t, student_t_of
from analysis.statistics.t_test import TTest

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
        where = f"line {self.line}, {self.row}" if self.row else f"line {self.line}"
        return f"{where}: {self.message}"


@dataclass(frozen=True)
class Recomputed:
    """The tests that follow from two printed rows."""

    name: str
    counts: tuple[tuple[int, int], tuple[int, int]] | None  # of both rows: first answer, second answer
    student: TTest  # one-sided, first row above second; of means as they are printed
    fisher: Fisher | None  # of counts

    def __str__(self) -> str:
        if self.counts is None or self.fisher is None:
            return f"{self.name}: {t_sentence(self.student)}"
        (first, _), (second, _) = self.counts
        return (
            f"{self.name}: {first} against {second} of {sum(self.counts[0])}; {t_sentence(self.student)}; "
            f"Fisher's exact p {probability(self.fisher.p)}"
        )


@dataclass(frozen=True)
class Verification:
    """What a printed table says about itself."""

    n: int
    kind: Kind
    cells: int  # shares, counts or means checked
    spreads: int  # standard deviations checked beside means
    unchecked: tuple[str, ...]  # columns that hold nothing to check
    faults: tuple[Fault, ...]
    recomputed: tuple[Recomputed, ...]
    other_sizes: tuple[int, ...] | None  # numbers of participants up to twice n that fit too; None for counts

    def __str__(self) -> str:
        faults = [f"{len(self.faults)} cannot be:", *(f"  {fault}" for fault in self.faults)]
        tests = [f"  {one}" for one in self.recomputed]
        spreads = ", and their standard deviations" if self.spreads else ""
        skipped = f" Not checked: {', '.join(self.unchecked)}." if self.unchecked else ""
        return "\n".join(
            [
                f"{self.cells} printed {self.kind} checked against n = {self.n}{spreads}.{skipped}",
                *(faults if self.faults else ["All of them are possible."]),
                *(
                    ["What follows from the possible rows (independent groups, one-sided):", *tests]
                    if tests
                    else []
                ),
                *self._sizes(),
            ]
        )

    def _sizes(self) -> list[str]:
        if self.other_sizes is None:
            return []
        if not self.other_sizes:
            return [f"There is no other n up to {2 * self.n} that fits possible rows."]
        fitting = ", ".join(map(str, self.other_sizes[:SIZES_SAID]))
        more = len(self.other_sizes) - SIZES_SAID
        return [f"The possible rows would also fit n = {fitting}{f' and {more} more' if more > 0 else ''}."]


SIZES_SAID = 12


def verify(table: Path, n: int, *, items: int = 1) -> Verification:
    """Check a printed table of shares, percentages, counts or means from n participants, one answer per cell.

    The cells of a row are the shares of one whole where most rows add up to 1 (or 100%, or n); else each is
    checked alone. A column called `mean` or `M` holds means of `items` whole-number ratings per participant.
    How a table is written: `analysis.printed_layout`. Raises InputError where it cannot be read.
    """
    return verify_printed(read_table(table, n), n, items=items)


def verify_printed(printed: PrintedTable, n: int, *, items: int = 1) -> Verification:
    """Check a table that has been read."""
    items = items if printed.kind == "means" else 1
    faults = [
        fault
        for row in printed.rows
        for fault in _faults(row, row.n or n, printed.kind, items=items, whole=printed.whole)
    ]
    bad = {(fault.line, fault.row) for fault in faults}
    good = [row for row in printed.rows if (row.line, row.name) not in bad]
    return Verification(
        n=n,
        kind=printed.kind,
        cells=sum(len(row.cells) for row in printed.rows),
        spreads=sum(row.sd is not None for row in printed.rows),
        unchecked=printed.unchecked,
        faults=tuple(faults),
        recomputed=tuple(_recompute(good, n, printed)),
        other_sizes=None
        if printed.kind == "counts" or any(row.n for row in printed.rows)
        else tuple(
            size
            for size in range(2, 2 * n + 1)
            if good
            and size != n
            and not any(_faults(row, size, printed.kind, items=items, whole=printed.whole) for row in good)
        ),
    )


def _faults(row: PrintedRow, n: int, kind: Kind, *, items: int, whole: bool) -> list[Fault]:
    """What is wrong with a row; cells are shares (of percentages the hundredth), counts or means."""
    answers = n * items
    if kind == "counts":
        return _count_faults(row, n, whole=whole)
    if kind != "means" and (outside := [cell for cell in row.cells if not 0 <= cell <= 1]):
        return [Fault(row.line, row.name, f"{_said(outside[0], kind)} is no share: they lie between 0 and 1")]
    if impossible := [cell for cell in row.cells if not counts_behind(cell, answers)]:
        what = "mean" if kind == "means" else "share"
        return [Fault(row.line, row.name, f"{_said(cell, kind)} is no {what} of {answers} answers")
                for cell in impossible]  # fmt: skip
    if row.sd is not None and not sd_is_possible(row.sd, row.cells[0], n, items):
        beside = f"{answers} whole answers with the mean {row.cells[0]}"
        return [Fault(row.line, row.name, f"{row.sd} is no standard deviation (n − 1) of {beside}")]
    if whole and _whole(row, n) is None:
        total = _said(sum(row.cells, Decimal(0)), kind)
        return [Fault(row.line, row.name, f"shares add up to {total}, and no counts of {n} give them")]
    return []


def _count_faults(row: PrintedRow, n: int, *, whole: bool) -> list[Fault]:
    if outside := [cell for cell in row.cells if not 0 <= cell <= n]:
        return [Fault(row.line, row.name, f"{outside[0]} is no count among {n} answers")]
    if whole and sum(row.cells) != n:
        return [Fault(row.line, row.name, f"counts add up to {sum(row.cells)}, not {n}")]
    return []


def _said(cell: Decimal, kind: Kind) -> str:
    """A cell as printed."""
    return f"{cell.scaleb(2)}%" if kind == "percentages" else str(cell)


def _whole(row: PrintedRow, n: int) -> tuple[int, ...] | None:
    """Counts of the row that add up to n, if any do."""
    chosen: set[tuple[int, ...]] = {()}
    for cell in row.cells:
        chosen = {(*before, k) for before in chosen for k in counts_behind(cell, n) if k + sum(before) <= n}
    return next((counts for counts in sorted(chosen) if sum(counts) == n), None)


def _recompute(rows: Sequence[PrintedRow], n: int, printed: PrintedTable) -> Iterator[Recomputed]:
    """The tests of each two rows that share their first label: of two answers, or of means with SDs."""
    by_name: dict[str, list[PrintedRow]] = {}
    for row in rows:
        if row.labels:
            by_name.setdefault(row.labels[0], []).append(row)
    for name, pair in by_name.items():
        if len(pair) != 2:
            continue
        if printed.kind == "means" and all(row.sd is not None for row in pair):
            first, second = (_moments(row, n) for row in pair)
            yield Recomputed(name, None, student_t_of(first, second, "greater"), None)
        elif printed.whole and all(len(row.cells) == 2 for row in pair):
            counts = [_counts(row, n) for row in pair]
            if counts[0] and counts[1]:
                (k1, _), (k2, _) = counts[0], counts[1]
                student = student_t(_answers(k1, n), _answers(k2, n), "greater")
                both = ((k1, n - k1), (k2, n - k2))
                yield Recomputed(name, both, student, fisher(k1, n, k2, n, "greater"))


def _moments(row: PrintedRow, n: int) -> Moments:
    size, sd = row.n or n, float(row.sd or 0)
    return Moments(size, float(row.cells[0]), sd, sd / size**0.5)


def _counts(row: PrintedRow, n: int) -> tuple[int, ...] | None:
    return tuple(int(cell) for cell in row.cells) if sum(row.cells) == n else _whole(row, n)


def _answers(k: int, n: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """K ones and n − k zeros."""
    return np.repeat([1.0, 0.0], [k, n - k])
