"""Demonstrations that do not rest at their ends, as recordings cut out of a longer motion."""

from __future__ import annotations

import numpy as np

from stimuli.trajectory import FloatArray, Trajectory

MOVING = 0.05  # of the fastest speed anywhere: a demonstration faster than that at an end does not rest there
WINDOW_S = 0.1  # at an end, over which a noisy demonstration is judged
CERTAIN = 4.0  # standard errors by which its speed there must exceed that
EASE_S = 0.2  # of the demonstration, sped up from or slowed down to rest


def rests_at_ends(demonstration: Trajectory) -> tuple[bool, bool]:
    """Whether it rests at its start and at its end."""
    y = demonstration.positions
    dt_s = demonstration.duration_s / (len(y) - 1)
    return _rests_at_start(y, dt_s), _rests_at_start(y[::-1], dt_s)


def _rests_at_start(y: FloatArray, dt_s: float) -> bool:
    """Whether a motion, (n, d), begins with a slow step, or its slope in the window may be mere noise."""
    steps = np.abs(np.diff(y, axis=0))
    n = min(round(WINDOW_S / dt_s), len(y) - 1) + 1
    slow = bool(steps[0].max() <= MOVING * steps.max())
    if slow or n < 4:
        return slow
    times = (np.arange(n) - (n - 1) / 2) * dt_s
    slopes = np.abs(times @ y[:n]) / (times @ times)
    fastest = np.abs(y[n - 1 :] - y[: 1 - n]).max() / ((n - 1) * dt_s)
    return bool(np.all(slopes <= MOVING * fastest + CERTAIN * _noise(y) / np.sqrt(times @ times)))


def _noise(y: FloatArray) -> FloatArray:
    """Standard deviation of white noise on each joint, (d,), from third differences, free of the motion."""
    spread: FloatArray = np.median(np.abs(np.diff(y, 3, axis=0)), axis=0)
    deviation: FloatArray = spread / (0.6745 * np.sqrt(20.0))  # of a normal median, and of 1, 3, 3, 1
    return deviation


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
