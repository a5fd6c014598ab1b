"""Recorded gestures: CSV with a header of `time` and joints, one row per sample, in s and the joints' units.

Samples may be uneven, unsorted and repeated: they are sorted, those with the same time averaged, and joined
by monotone cubics (PCHIP), which never leave the range of the samples. A header may say a column's unit:
`time [ms]`, `HeadYaw [deg]`.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from stimuli.errors import InputError
from stimuli.gestures.reading import (
    LONGEST_S,
    each_once,
    known_joint,
    read_text,
    sampled_times,
    unit_factor,
    whole_body,
)
from stimuli.robots.model import Robot
from stimuli.trajectory import FloatArray, Trajectory
from stimuli.units import TIME

SUFFIXES = (".csv",)

LARGEST = 8_000_000  # bytes; ten minutes of 17 joints at 100 Hz


def read(path: Path, robot: Robot, dt_s: float) -> Trajectory:
    """The gesture in a table of samples."""
    rows = list(csv.reader(read_text(path, LARGEST).splitlines()))
    header = [cell.strip() for cell in rows[0]] if rows else []
    second = _second(header, f"{path}:1")
    columns = [_column(title, robot, f"{path}:1") for title in header[1:]]
    each_once((name for name, _ in columns), f"{path}:1")
    samples = np.array(
        [_numbers(row, header, f"{path}:{n}") for n, row in enumerate(rows[1:], 2) if any(row)]
    )
    if len(samples) < 2 or np.ptp(samples[:, 0]) <= 0:
        raise InputError(f"{path}: {len(samples)} samples; at least two at different times are needed")
    moments, values = _in_order(samples[:, 0] * second, samples[:, 1:])
    duration_s = float(np.ptp(moments))
    if duration_s > LONGEST_S and second == 1:
        raise InputError(
            f"{path}: the samples span {duration_s:g} s, more than {LONGEST_S:g} s; times are in s. "
            "If these are ms, head the column 'time [ms]'"
        )
    times = sampled_times(duration_s, dt_s, str(path))
    smooth = PchipInterpolator(moments - moments[0], values)(times)
    moving = {name: column * factor for (name, factor), column in zip(columns, smooth.T, strict=True)}
    return whole_body(times, moving, robot)


def _second(header: list[str], place: str) -> float:
    """What times are multiplied by to be in s, as the first column's title says."""
    name, unit = _named(header[0]) if header else ("", None)
    if name not in ("time", "time_s", "t") or (unit or "s") not in TIME:
        raise InputError(
            f"{place}: the first column is 'time' in s, or 'time [ms]', the others are joints; "
            f"it is {header[:1]}"
        )
    return TIME[unit or "s"]


def _column(title: str, robot: Robot, place: str) -> tuple[str, float]:
    """The joint that a title names, and what its values are multiplied by to be in the joint's unit."""
    name, unit = _named(title)
    joint = known_joint(name, robot, place)
    return joint.name, 1.0 if unit is None else unit_factor(unit, joint, place)


def _named(title: str) -> tuple[str, str | None]:
    """Name and unit of a column, `HeadYaw [deg]`."""
    name, bracket, unit = title.partition("[")
    return name.strip(), unit.strip(" ]") if bracket else None


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
