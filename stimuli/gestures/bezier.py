"""Curves of keys joined by cubic Bezier pieces, as animation editors draw them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from stimuli.trajectory import FloatArray

Handle = tuple[float, float]  # offset in time and in value from the key to its handle


@dataclass(frozen=True)
class Key:
    """A point of a curve with the handles that shape it to the left and to the right; None: straight."""

    time_s: float
    value: float
    left: Handle | None = None
    right: Handle | None = None


def from_home(keys: list[Key], home: float) -> list[Key]:
    """The keys with one at home before them, where the first comes later than 0.

    As on a NAOqi robot, which goes from wherever it stands to the first key: it sets out at rest.
    """
    first = min(keys, key=lambda key: key.time_s)
    if first.time_s <= 0:
        return keys
    third = first.time_s / 3  # level handles of a third make the way there ease in and out
    reached = replace(first, left=first.left or (-third, 0.0))
    return [Key(0.0, home, None, (third, 0.0)), *(reached if key is first else key for key in keys)]


def sample(keys: list[Key], times: FloatArray) -> FloatArray:
    """Values of the curve at these times, (n,); held before the first key and after the last.

    Each piece is the cubic Bezier curve in time and value through two keys and their handles. Handles that
    reach beyond the other key are shortened, in proportion, so that time never runs backwards.
    """
    keys = sorted(keys, key=lambda key: key.time_s)
    values = np.where(times < keys[0].time_s, keys[0].value, keys[-1].value)
    for start, end in pairwise(keys):
        inside = (times >= start.time_s) & (times <= end.time_s)
        if end.time_s > start.time_s and inside.any():
            values[inside] = _piece(start, end, times[inside])
    return values


def _piece(start: Key, end: Key, times: FloatArray) -> FloatArray:
    span, rise = end.time_s - start.time_s, end.value - start.value
    out_t, out_y = _within(start.right or (span / 3, rise / 3), span)
    in_t, in_y = _within(end.left or (-span / 3, -rise / 3), span)
    share = (times - start.time_s) / span
    u = _parameter(share, out_t / span, 1 + in_t / span)
    return start.value + _bernstein(u, out_y, rise + in_y, rise)


def _within(handle: Handle, span: float) -> Handle:
    reach = abs(handle[0])
    return handle if reach <= span else (handle[0] * span / reach, handle[1] * span / reach)


def _bernstein(u: FloatArray, second: float, third: float, last: float) -> FloatArray:
    """Cubic with control values 0, second, third, last."""
    return 3 * (1 - u) ** 2 * u * second + 3 * (1 - u) * u**2 * third + u**3 * last


def _parameter(share: FloatArray, second: float, third: float) -> FloatArray:
    """Parameters at which the piece has gone these shares of its time: bisection, time being monotone."""
    low, high = np.zeros_like(share), np.ones_like(share)
    for _ in range(52):
        middle = (low + high) / 2
        early = _bernstein(middle, second, third, 1.0) < share
        low, high = np.where(early, middle, low), np.where(early, high, middle)
    return (low + high) / 2
