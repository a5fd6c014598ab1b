"""What a statistic cannot be asked for, refused before it gives a number that means something else."""

from __future__ import annotations

from numpy.typing import ArrayLike

from analysis.statistics.samples import FloatArray, numbers


def refuse_impossible_count(k: int, n: int) -> None:
    """Raise ValueError unless k of n can have been counted."""
    if k != int(k) or n != int(n) or not 0 <= k <= n:
        raise ValueError(f"{k} of {n} is no count: both are whole numbers, the first from 0 to the second")


def refuse_other_than_yes_and_no(answers: FloatArray) -> None:
    """Raise ValueError unless every answer is 1 (yes) or 0 (no)."""
    if (other := answers[(answers != 0) & (answers != 1)]).size:
        raise ValueError(f"answers are 1 for yes and 0 for no, not {other[0]:g}")


def as_table(values: ArrayLike, shape: str) -> FloatArray:
    """The values as an array of that shape, (rows, columns); ValueError where they have no two dimensions."""
    table = numbers(values)
    if table.ndim != 2:
        raise ValueError(f"needs a table {shape}; this has the shape {table.shape}")
    return table
