"""Descriptors of a motion: a few numbers that say how long, large, fast, smooth and open it is."""

from __future__ import annotations

import numpy as np

from stimuli.kinematics import link_poses
from stimuli.robots.model import Robot
from stimuli.trajectory import FloatArray, Trajectory

STILL = 0.01  # of a joint's range: joints that move less are not counted as moving

UNITS = {
    "duration_s": "s",
    "amplitude": "of range",
    "speed_mean": "1/s",
    "speed_peak": "1/s",
    "acceleration_peak": "1/s²",
    "jerk_rms": "1/s³",
    "path_length": "of range",
    "hand_width_m": "m",
    "hand_height_m": "m",
    "hand_depth_m": "m",
    "hand_reach_mean_m": "m",
}
"""Units of the descriptors that have one."""


def describe(trajectory: Trajectory, robot: Robot) -> dict[str, float]:
    """Descriptors of a motion; positions count as shares of each joint's range, so that all joints compare.

    `duration_s`; `joints_moving`; `amplitude`: mean peak-to-peak share of range over moving joints;
    `speed_mean`, `speed_peak` (1/s), `acceleration_peak` (1/s²), `jerk_rms` (1/s³): of the moving joints
    together, as Euclidean norms; `path_length`; `log_dimensionless_jerk` (Hogan & Sternad 2009) and `sparc`
    (Balasubramanian et al. 2015), both of that speed, nearer to 0 is smoother.
    """
    ranges = np.array([robot.joint(name).range for name in trajectory.joints])
    y = trajectory.positions / ranges  # (n, d)
    dt = trajectory.duration_s / (len(trajectory.times) - 1)
    moving = np.ptp(y, axis=0) > STILL
    y = y[:, moving]
    velocity = np.gradient(y, dt, axis=0)
    acceleration = np.gradient(velocity, dt, axis=0)
    jerk = np.gradient(acceleration, dt, axis=0)
    speed = np.linalg.norm(velocity, axis=1)
    described = {
        "duration_s": trajectory.duration_s,
        "joints_moving": float(moving.sum()),
        "amplitude": float(np.ptp(y, axis=0).mean()) if moving.any() else 0.0,
        "speed_mean": float(speed.mean()),
        "speed_peak": float(speed.max()),
        "acceleration_peak": float(np.linalg.norm(acceleration, axis=1).max()),
        "jerk_rms": float(np.sqrt(np.mean(np.sum(jerk**2, axis=1)))),
        "path_length": float(np.trapezoid(speed, dx=dt)),
    }
    if speed.max() > 0:
        described["log_dimensionless_jerk"] = log_dimensionless_jerk(speed, jerk, dt)
        described["sparc"] = sparc(speed, dt)
    return described | _extents(trajectory, robot)


def log_dimensionless_jerk(speed: FloatArray, jerk: FloatArray, dt: float) -> float:
    """-ln(T^3 / v_peak^2 · ∫ |jerk|^2 dt) of a movement of duration T (Hogan & Sternad 2009)."""
    duration = dt * (len(speed) - 1)
    return float(-np.log(duration**3 / speed.max() ** 2 * np.trapezoid(np.sum(jerk**2, axis=1), dx=dt)))


def sparc(speed: FloatArray, dt: float, cutoff_hz: float = 10.0, threshold: float = 0.05) -> float:
    """Spectral arc length of a speed profile (Balasubramanian et al. 2015, J. NeuroEng. Rehabil. 12:112).

    Minus the length of the normalised amplitude spectrum up to the last frequency, at most the cutoff, at
    which it exceeds the threshold; frequencies count as shares of that one. The profile is padded 16-fold.
    """
    n = 2 ** (int(np.ceil(np.log2(len(speed)))) + 4)
    frequencies = np.fft.rfftfreq(n, dt)
    spectrum = np.abs(np.fft.rfft(speed, n))
    spectrum = spectrum / spectrum[0]
    inside = np.flatnonzero((frequencies <= cutoff_hz) & (spectrum >= threshold))
    part = slice(inside[0], inside[-1] + 1)
    f, a = frequencies[part], spectrum[part]
    return float(-np.sum(np.hypot(np.diff(f) / (f[-1] - f[0]), np.diff(a))))


def _extents(trajectory: Trajectory, robot: Robot) -> dict[str, float]:
    """How far the hands get, in m: left to right, up and down, forth and back, and off the robot's axis."""
    if not robot.hands:
        return {}
    positions = dict(robot.home) | {name: trajectory.joint(name) for name in trajectory.joints}
    poses = link_poses(robot.joints, positions)
    hands = np.stack(
        [np.broadcast_to(poses[hand], (len(trajectory.times), 4, 4))[:, :3, 3] for hand in robot.hands]
    )
    apart = np.linalg.norm(hands[..., :2], axis=-1)  # (hands, n) horizontal distance from the robot's axis
    return {
        "hand_width_m": float(np.ptp(hands[..., 1])),
        "hand_height_m": float(np.ptp(hands[..., 2])),
        "hand_depth_m": float(np.ptp(hands[..., 0])),
        "hand_reach_mean_m": float(apart.mean()),
    }
