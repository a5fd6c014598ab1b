"""Which item each participant saw most in each stimulus, and how far that beats guessing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

TieRule = Literal["miss", "share"]


@dataclass(frozen=True)
class UnbiasedHitRate:
    """Wagner's Hu of one stimulus, with what guessing would give."""

    hit_rate: float | None
    hu: float | None
    chance: float | None


def confusion(ratings: ArrayLike, ties: TieRule = "share") -> NDArray[np.float64]:
    """Highest-rated items, ratings (participants, stimuli, items) → counts (stimuli, items).

    A tie for the highest is shared among the tied items, or counts for none. A participant with a missing
    rating of a stimulus is left out there.
    """
    table = np.asarray(ratings, dtype=float)
    complete = ~np.isnan(table).any(axis=2)
    highest = table == table.max(axis=2, keepdims=True)
    tied = highest.sum(axis=2, keepdims=True)
    votes = highest / np.maximum(tied, 1) if ties == "share" else highest * (tied == 1)
    counts: NDArray[np.float64] = (votes * complete[:, :, None]).sum(axis=0)
    return counts


def unbiased_hit_rates(counts: ArrayLike, targets: list[int]) -> list[UnbiasedHitRate]:
    """Hu = hits² / (times the stimulus was shown · times the item was chosen); targets[s] is its item.

    Chance is the product of both shares. Wagner (1993), Journal of Nonverbal Behavior 17.
    """
    table = np.asarray(counts, dtype=float)
    rows, columns, total = table.sum(axis=1), table.sum(axis=0), float(table.sum())
    rates = []
    for s, i in enumerate(targets):
        hits, row, column = float(table[s, i]), float(rows[s]), float(columns[i])
        rates.append(
            UnbiasedHitRate(
                hit_rate=hits / row if row else None,
                hu=hits**2 / (row * column) if row and column else None,
                chance=row * column / total**2 if total else None,
            )
        )
    return rates
