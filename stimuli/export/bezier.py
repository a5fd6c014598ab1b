"""A motion as keys with slopes, as programs want it that join keys by cubic Bezier pieces."""

from __future__ import annotations

import numpy as np

from stimuli.trajectory import FloatArray, Trajectory


def bezier_keys(trajectory: Trajectory, dt_s: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times (n,), positions and slopes per s (n, d) of keys every dt_s, the last one at or after the end."""
    n = int(np.ceil(trajectory.duration_s / dt_s - 1e-9))
    times: FloatArray = np.arange(n + 1, dtype=np.float64) * dt_s
    speeds = np.gradient(trajectory.positions, trajectory.times, axis=0)
    speeds[[0, -1]] = 0.0  # at rest
    slopes = np.stack([np.interp(times, trajectory.times, speed) for speed in speeds.T], axis=1)
    return times, trajectory.at(times), slopes
