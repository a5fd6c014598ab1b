"""P-values of a family of tests, adjusted for their number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from analysis.statistics.samples import numbers
from stimuli.errors import nearest

Correction = Literal["holm", "bonferroni", "benjamini-hochberg", "none"]
Vector = NDArray[np.float64]


def adjust(family: Mapping[str, float | None], correction: Correction) -> dict[str, float | None]:
    """Adjusted p-values by name. A test without a p-value still counts in the size of the family.

    >>> adjust({"joy": 0.01, "fear": 0.04}, "holm")
    {'joy': 0.02, 'fear': 0.04}
    """
    if correction not in ADJUSTMENTS:
        raise ValueError(f"correction {correction!r}: {nearest(correction, ADJUSTMENTS)}")
    p = numbers(np.array([*family.values()], dtype=object))
    there = ~np.isnan(p)
    adjusted = iter(ADJUSTMENTS[correction](p[there], p.size).tolist())
    return {name: next(adjusted) if known else None for name, known in zip(family, there, strict=True)}


def holm(p: Vector, m: int) -> Vector:
    """Holm's step-down: as R `p.adjust(p, "holm", m)`. Holm (1979), Scand. J. Statist. 6."""
    order = np.argsort(p, kind="stable")
    stepped = np.maximum.accumulate((m - np.arange(p.size)) * p[order])
    return _unsorted(np.minimum(stepped, 1), order)


def benjamini_hochberg(p: Vector, m: int) -> Vector:
    """False discovery rate: as R `p.adjust(p, "BH", m)`. Benjamini & Hochberg (1995), JRSS B 57."""
    order = np.argsort(p, kind="stable")
    raw = p[order] * m / np.arange(1, p.size + 1)
    return _unsorted(np.minimum(np.minimum.accumulate(raw[::-1])[::-1], 1), order)


def bonferroni(p: Vector, m: int) -> Vector:
    """Each p times the number of tests, at most 1."""
    return np.minimum(p * m, 1)


def _unsorted(values: Vector, order: NDArray[np.int64]) -> Vector:
    result = np.empty_like(values)
    result[order] = values
    return result


ADJUSTMENTS: Mapping[Correction, Callable[[Vector, int], Vector]] = {
    "holm": holm,
    "bonferroni": bonferroni,
    "benjamini-hochberg": benjamini_hochberg,
    "none": lambda p, m: p,  # noqa: ARG005
}
