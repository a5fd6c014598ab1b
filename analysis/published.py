"""Published numbers as data, and whether they can be true."""

from __future__ import annotations

from collections.abc import Mapping

# Of 34 participants, how many called the high- and the low-intensity motion "higher" (Hielscher, Bulling &
# Arras, IROS 2025, Table II): the only counts that give the printed proportions. The printed row Arc/low,
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
