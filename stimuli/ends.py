"""Demonstrations that do not rest at their ends, as recordings cut out of a longer motion."""

from __future__ import annotations

import numpy as np

from stimuli.trajectory import FloatArray, Trajectory

MOVING = 0.05  # of the fastest speed anywhere: a demonstration faster than that at an end does not rest there
EASE_S = 0.2  # of the demonstration, sped up from or slowed down to rest


def rests_at_ends(demonstration: Trajectory) -> tuple[bool, bool]:
    """Whether it rests at its start and at its end."""
    steps = np.abs(np.diff(demonstration.positions, axis=0))
    allowed = MOVING * steps.max()
    return bool(steps[0].max() <= allowed), bool(steps[-1].max() <= allowed)


def eased(demonstration: Trajectory) -> Trajectory:
    """The same path, from rest to rest: sped up, and slowed down, over what took `EASE_S`, in twice that.

    Time passes at the rate 3 u^2 - 2 u^3, u from 0 to 1 during the easing, so speeds rise smoothly and no
    position is added that was not shown. A demonstration that rests already is returned as it is.
    """
    at_start, at_end = rests_at_ends(demonstration)
    if at_start and at_end:
        return demonstration
    ease = min(EASE_S, demonstration.duration_s / 4)
    before, after = (0.0 if rests else ease for rests in (at_start, at_end))
    dt = demonstration.duration_s / (len(demonstration.times) - 1)
    longer = demonstration.duration_s + before + after
    times = np.linspace(0.0, longer, round(longer / dt) + 1)
    shown = np.clip(times - before, 0.0, demonstration.duration_s)
    if before:
        shown = np.where(times < 2 * before, _run_up(times, before), shown)
    if after:
        left = longer - times
        shown = np.where(left < 2 * after, demonstration.duration_s - _run_up(left, after), shown)
    return Trajectory(times, demonstration.resampled_at(shown), demonstration.joints)


def _run_up(times: FloatArray, ease: float) -> FloatArray:
    """Time gone by in the demonstration, `ease` after 2 ease."""
    u = np.clip(times / (2 * ease), 0.0, 1.0)
    gone: FloatArray = 2 * ease * (u**3 - u**4 / 2)
    return gone
