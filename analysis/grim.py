"""Which whole-number answers can be behind a printed number.

A share or a mean of n answers is k/n for a whole k, so most printed ones are impossible for a wrong n or a
misprint: the GRIM test (Brown & Heathers 2017, Soc. Psychol. Personal. Sci. 8). A standard deviation beside
the mean fixes the sum of squares, which is whole too, and odd where the sum is: the GRIMMER test (Anaya 2016,
PeerJ Preprints 2400v1; in this form Allard 2018, "Analytic-GRIMMER").
"""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from math import ceil, floor

FLOAT_DECIMALS, SQUARED_DECIMALS = 15, 12  # what a computer writes beyond them is its rounding


def counts_behind(printed: Decimal, n: int) -> tuple[int, ...]:
    """Every whole k for which k/n rounds to what is printed, a half rounding either way."""
    value, half = Fraction(printed), _half(printed, FLOAT_DECIMALS)
    around, reach = floor(value * n), floor(half * n) + 1
    return tuple(k for k in range(around - reach, around + reach + 2) if abs(Fraction(k, n) - value) <= half)


def sd_is_possible(sd: Decimal, mean: Decimal, n: int, items: int = 1) -> bool:
    """Whether n people's means of `items` whole numbers can have this mean and SD (with n − 1 below it)."""
    value, half = Fraction(sd), _half(sd, SQUARED_DECIMALS)
    least, most = max(value - half, Fraction(0)) * items, (value + half) * items
    for total in counts_behind(mean, n * items):
        each, more = divmod(total, n)  # at their most even, `more` people are one above the others
        fewest = n * each**2 + more * (2 * each + 1)
        squares = max(fewest, ceil((n - 1) * least**2 + Fraction(total**2, n)))
        squares += (squares - total) % 2
        if squares <= (n - 1) * most**2 + Fraction(total**2, n):
            return True
    return False


def _half(printed: Decimal, decimals: int) -> Fraction:
    """Half of the last decimal that is printed and means something."""
    exponent = printed.as_tuple().exponent
    places = max(0, -exponent) if isinstance(exponent, int) else 0
    return Fraction(1, 2 * 10 ** min(places, decimals))
