"""Motions as CSV: what `stimuli.gestures.samples` reads back."""

from __future__ import annotations

import csv
from pathlib import Path

from stimuli.trajectory import Trajectory


def write_csv(trajectory: Trajectory, path: Path) -> None:
    """One row per sample: `time` in s, then each joint in its own unit, with all digits."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time", *trajectory.joints])
        for time, positions in zip(trajectory.times.tolist(), trajectory.positions.tolist(), strict=True):
            writer.writerow([time, *positions])
