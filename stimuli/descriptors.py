"""Descriptors of a motion: a few numbers that say how long, large, fast, smooth and open it is."""

from __future__ import annotations

import numpy as np

from stimuli.kinematics import chain, link_poses
from stimuli.robots.model import Robot
from stimuli.trajectory import FloatArray, Trajectory

DESCRIPTORS = {  # what each is, with its unit; of moving joints together: Euclidean norms
    "duration_s": "s, until every joint rests",
    "joints_moving": "joints that move by more than a hundredth of their range",
    "amplitude": "peak-to-peak share of the range, mean over moving joints",
    "speed_mean": "shares of range per s",
    "speed_peak": "shares of range per s",
    "acceleration_mean": "shares of range per s²",
    "acceleration_peak": "shares of range per s²",
    "jerk_mean": "shares of range per s³",
    "jerk_peak": "shares of range per s³",
    "jerk_rms": "shares of range per s³",
    "path_length": "shares of range",
    "log_dimensionless_jerk": "nearer to 0 is smoother (Hogan & Sternad 2009)",
    "sparc": "spectral arc length of the speed; nearer to 0 is smoother (Balasubramanian et al. 2015)",
    "hand_width_m": "m, left to right, that the hands' paths span together",
    "hand_height_m": "m, up and down",
    "hand_depth_m": "m, forth and back",
    "hand_reach_mean_m": "m, mean horizontal distance of the hands from the robot's vertical axis",
    "contraction_index": "1 minus that distance over the longest possible (after Camurri et al. 2003)",
    "gaze_elevation_mean_rad": "rad, mean, up is positive",
    "head_forward_mean_m": "m, mean position of the head ahead of the robot's vertical axis",
}

_EVEN = 1e-6  # duration² · jerk / speed below which a motion is even: its jerk is rounding and has no log

STILL = 0.01  # of a joint's range: joints that move less are not counted as moving

UNITS = {
    "duration_s": "s",
    "amplitude": "of range",
    "speed_mean": "1/s",
    "speed_peak": "1/s",
    "acceleration_mean": "1/s²",
    "acceleration_peak": "1/s²",
    "jerk_mean": "1/s³",
    "jerk_peak": "1/s³",
    "jerk_rms": "1/s³",
    "path_length": "of range",
    "hand_width_m": "m",
    "hand_height_m": "m",
    "hand_depth_m": "m",
    "hand_reach_mean_m": "m",
    "gaze_elevation_mean_rad": "rad",
    "head_forward_mean_m": "m",
}
"""Units of the descriptors that have one."""


def describe(trajectory: Trajectory, robot: Robot) -> dict[str, float]:
    """Descriptors of a motion, as listed in `DESCRIPTORS`, without those that it or the robot cannot have.

    Positions count as shares of each joint's range, so that all joints compare.
    """
    ranges = np.array([robot.joint(name).range for name in trajectory.joints])
    y = trajectory.positions / ranges  # (n, d)
    dt = trajectory.duration_s / (len(trajectory.times) - 1)
    moving = np.ptp(y, axis=0) > STILL
    y = y[:, moving]
    velocity = np.gradient(y, dt, axis=0)
    acceleration = np.gradient(velocity, dt, axis=0)
    jerk = np.gradient(acceleration, dt, axis=0)
    speed, push, jolt = (np.linalg.norm(rate, axis=1) for rate in (velocity, acceleration, jerk))
    described = {
        "duration_s": trajectory.duration_s,
        "joints_moving": float(moving.sum()),
        "amplitude": float(np.ptp(y, axis=0).mean()) if moving.any() else 0.0,
        "speed_mean": float(speed.mean()),
        "speed_peak": float(speed.max()),
        "acceleration_mean": float(push.mean()),
        "acceleration_peak": float(push.max()),
        "jerk_mean": float(jolt.mean()),
        "jerk_peak": float(jolt.max()),
        "jerk_rms": float(np.sqrt(np.mean(jolt**2))),
        "path_length": float(np.trapezoid(speed, dx=dt)),
    }
    if speed.max() > 0:
        if jolt.max() * trajectory.duration_s**2 > _EVEN * speed.max():
            described["log_dimensionless_jerk"] = log_dimensionless_jerk(speed, jerk, dt)
        described["sparc"] = sparc(speed, dt)
    return described | _posture(trajectory, robot)


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


def _posture(trajectory: Trajectory, robot: Robot) -> dict[str, float]:
    """Where hands and head get, with x ahead, y to the left and z up from the robot's root."""
    positions = dict(robot.home) | {name: trajectory.joint(name) for name in trajectory.joints}
    poses = link_poses(robot.joints, positions)
    described: dict[str, float] = {}
    if robot.hands:
        shape = (len(trajectory.times), 4, 4)
        hands = np.stack([np.broadcast_to(poses[hand], shape)[:, :3, 3] for hand in robot.hands])
        apart = float(np.linalg.norm(hands[..., :2], axis=-1).mean())  # of (hands, n)
        longest = np.mean([_arm_m(robot, hand) for hand in robot.hands])
        described |= {
            "hand_width_m": float(np.ptp(hands[..., 1])),
            "hand_height_m": float(np.ptp(hands[..., 2])),
            "hand_depth_m": float(np.ptp(hands[..., 0])),
            "hand_reach_mean_m": apart,
            "contraction_index": float(1 - apart / longest),
        }
    if robot.head:
        upright = link_poses(robot.joints, dict.fromkeys(robot.joint_names, 0.0))[robot.head]
        gaze = poses[robot.head][..., :3, :3] @ upright[0, :3]
        described |= {
            "gaze_elevation_mean_rad": float(np.arcsin(np.clip(gaze[..., 2], -1, 1)).mean()),
            "head_forward_mean_m": float(np.mean(poses[robot.head][..., 0, 3])),
        }
    return described


def _arm_m(robot: Robot, hand: str) -> float:
    """Longest way from the axis to a hand: across to the shoulder, then along the stretched arm."""
    lengths = [np.array(joint.origin_xyz) for joint in chain(robot.joints, hand)]
    off_axis = next((at for at, xyz in enumerate(lengths) if np.any(np.abs(xyz[:2]) > 1e-9)), 0)
    shoulder = float(np.linalg.norm(lengths[off_axis][:2]))
    return shoulder + float(sum(np.linalg.norm(xyz) for xyz in lengths[off_axis + 1 :]))
