"""Designs: tables of orders, one row per participant, in which conditions are balanced."""

from __future__ import annotations

Row = tuple[int, ...]


def latin_square(n: int) -> tuple[Row, ...]:
    """Cyclic square: each of n conditions stands once in each position over n rows."""
    return tuple(tuple((row + place) % n for place in range(n)) for row in range(n))


def williams(n: int) -> tuple[Row, ...]:
    """Balance first-order carry-over too: each condition follows each other one equally often.

    The first row is 0, 1, n-1, 2, n-2, …; the others add 1, 2, … modulo n. For odd n the mirrored rows are
    needed as well, so there are 2n. Williams (1949), Aust. J. Sci. Res. 2, 149–168.
    """
    if n == 1:
        return ((0,),)
    first = [0]
    for step in range(1, n):
        first.append((step + 1) // 2 if step % 2 else n - step // 2)
    rows = tuple(tuple((condition + row) % n for condition in first) for row in range(n))
    return rows if n % 2 == 0 else rows + tuple(row[::-1] for row in rows)
