"""Participants who gave the same answers to the same things: their rows once, and how many they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Alike:
    """The rows of one participant of each kind, kind by kind; a likelihood need look at no others."""

    rows: IntArray  # (kept,) places among all rows
    kind: IntArray  # (kept,) of each kept row
    starts: IntArray  # (kinds,) where each begins among the kept
    participants: FloatArray  # (kinds,) how many are of it


def alike(group: IntArray, *columns: FloatArray) -> Alike:
    """Find who is alike in all columns (n,), in whatever order a participant's rows stand."""
    order = np.lexsort((*columns, group))
    edges = np.flatnonzero(np.diff(group[order])) + 1
    told = np.column_stack(columns)
    kinds: dict[bytes, list[IntArray]] = {}
    for own in np.split(order, edges):
        kinds.setdefault(told[own].tobytes(), []).append(own)
    kept = [members[0] for members in kinds.values()]
    sizes = [own.size for own in kept]
    return Alike(
        rows=np.concatenate(kept),
        kind=np.repeat(np.arange(len(kept)), sizes),
        starts=np.cumsum([0, *sizes[:-1]]),
        participants=np.array([float(len(members)) for members in kinds.values()]),
    )
