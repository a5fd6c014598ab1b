"""Recorded gestures: CSV with a header of `time` and joints, one row per sample, in s and the joints' units.

Samples may be uneven, unsorted and repeated: they are sorted, those with the same time averaged, and joined
by monotone cubics (PCHIP), which never leave the range of the samples. A header may say a joint's unit,
`HeadYaw [deg]`.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from stimuli.errors import InputError
from stimuli.gestures.reading import in_joint_unit, known_joint, read_text, whole_body
from stimuli.robots.model import Robot
from stimuli.trajectory import FloatArray, Trajectory, even_times

SUFFIXES = (".csv",)


def read(path: Path, robot: Robot, dt_s: float) -> Trajectory:
    """The gesture in a table of samples."""
    rows = list(csv.reader(read_text(path).splitlines()))
    header = [cell.strip() for cell in rows[0]] if rows else []
    if not header or header[0] not in ("time", "time_s", "t"):
        raise InputError(
            f"{path}:1: the first column is 'time' in s, the others are joints; it is {header[:1]}"
        )
    samples = np.array(
        [_numbers(row, header, f"{path}:{n}") for n, row in enumerate(rows[1:], 2) if any(row)]
    )
    if len(samples) < 2 or np.ptp(samples[:, 0]) <= 0:
        raise InputError(f"{path}: {len(samples)} samples; at least two at different times are needed")
    moments, values = _in_order(samples[:, 0], samples[:, 1:])
    times = even_times(float(np.ptp(moments)), dt_s)
    smooth = PchipInterpolator(moments - moments[0], values)(times)
    moving = {}
    for column, title in zip(smooth.T, header[1:], strict=True):
        name, _, unit = title.partition("[")
        joint = known_joint(name.strip(), robot, f"{path}:1")
        moving[joint.name] = column * in_joint_unit(1.0, unit.strip(" ]") or "rad", joint)
    return whole_body(times, moving, robot)


def _numbers(row: list[str], header: list[str], place: str) -> list[float]:
    if len(row) != len(header):
        raise InputError(f"{place}: {len(row)} cells; the header has {len(header)}")
    try:
        numbers = [float(cell) for cell in row]
    except ValueError as err:
        raise InputError(f"{place}: {err}; every cell is a number") from err
    if not np.isfinite(numbers).all():
        raise InputError(f"{place}: {row} has a value that is not finite; leave such samples out")
    return numbers


def _in_order(moments: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Sorted by time, repeated times averaged into one."""
    distinct, group = np.unique(moments, return_inverse=True)
    sums = np.zeros((len(distinct), values.shape[1]))
    np.add.at(sums, group, values)
    return distinct, sums / np.bincount(group)[:, None]
