"""How a benchmark is run: ours and the peer's in turn, and the median of the ratios."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """One comparison: how many times faster (smaller, …) than the peer, and what was to be reached."""

    what: str
    peer: str
    ratio: float  # peer / ours where more is better, ours / peer where `at_most`
    reach: float
    at_most: bool = False  # the ratio must not exceed `reach`, instead of reaching it
    detail: str = ""

    @property
    def reached(self) -> bool:
        """Whether the goal is met."""
        return self.ratio <= self.reach if self.at_most else self.ratio >= self.reach


def seconds(call: Callable[[], object], repeats: int = 1) -> float:
    """Wall time of one call, over some repeats."""
    start = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - start) / repeats


def times_faster(
    ours: Callable[[], object],
    peer: Callable[[], object],
    *,
    rounds: int = 7,
    repeats: int = 1,
    peer_repeats: int = 1,
) -> float:
    """How many times faster ours is: the median over interleaved rounds of peer time / our time."""
    ours(), peer()
    ratios = []
    for _ in range(rounds):
        our_s = seconds(ours, repeats)
        ratios.append(seconds(peer, peer_repeats) / our_s)
    return statistics.median(ratios)
