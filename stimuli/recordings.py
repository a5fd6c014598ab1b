"""What real gestures are like: descriptors of animations made by Pepper's makers, to measure our own by.

Measured with `stimuli.descriptors.describe` on five animations of softbankrobotics-labs/pepper-core-anims
(BSD-3-Clause), as read by `stimuli.gestures.qianim` at 100 Hz. The animations are not part of this project.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from stimuli.descriptors import DESCRIPTORS
from stimuli.trajectory import Trajectory

MEASURED = (
    "joints_moving",
    "amplitude",
    "speed_peak",
    "acceleration_peak",
    "log_dimensionless_jerk",
    "sparc",
)

RECORDED: Mapping[str, tuple[float, ...]] = {
    "Enumeration_01": (17, 0.1992, 2.213, 21.04, -12.06, -2.421),
    "Hello_01": (16, 0.3003, 2.135, 10.46, -14.21, -3.358),
    "NiceReaction_01": (17, 0.1784, 2.205, 33.58, -14.18, -3.048),
    "PointFrontR_01": (17, 0.239, 2.348, 24.27, -12.72, -3.16),
    "Show_Tablet_01": (14, 0.2311, 7.837, 239.6, -14.18, -1.865),
}

_RESTING = 0.02  # of the fastest change of pose


def recorded_range(descriptor: str) -> tuple[float, float]:
    """The least and the most that any recording has."""
    values = [row[MEASURED.index(descriptor)] for row in RECORDED.values()]
    return min(values), max(values)


def rests(gesture: Trajectory) -> tuple[bool, bool]:
    """Whether a gesture is at rest at its start and at its end."""
    change = np.linalg.norm(np.diff(gesture.positions, axis=0), axis=1)
    return bool(change[0] <= _RESTING * change.max()), bool(change[-1] <= _RESTING * change.max())


def gestures_as_markdown(described: Mapping[str, Mapping[str, float]]) -> str:
    """Descriptors of gestures, by name, beside the recordings' and their range, as a document.

    What lies below or above all recordings is marked with < or >.
    """
    rows = [
        f"| {name} | {' | '.join(_marked(values[d], d) for d in MEASURED)} |"
        for name, values in described.items()
    ]
    recorded = [
        f"| *{name}* | {' | '.join(f'{value:.3g}' for value in row)} |" for name, row in RECORDED.items()
    ]
    spans = [" to ".join(f"{end:.3g}" for end in recorded_range(descriptor)) for descriptor in MEASURED]
    return "\n".join(
        [
            "# The gestures beside real ones",
            "",
            "Authored gestures, and, in italics, five animations by Pepper's makers (measured, not included: "
            "softbankrobotics-labs/pepper-core-anims, BSD-3-Clause). What would lie below or above all of "
            "these is marked < or >: nothing does. All authored gestures rest at both ends.",
            "",
            f"| gesture | {' | '.join(MEASURED)} |",
            "|---" * (len(MEASURED) + 1) + "|",
            *rows,
            *recorded,
            f"| **range of the animations** | {' | '.join(spans)} |",
            "",
            *(f"- `{name}`: {DESCRIPTORS[name]}" for name in MEASURED),
            "",
        ]
    )


def _marked(value: float, descriptor: str) -> str:
    least, most = recorded_range(descriptor)
    mark = "<" if value < least else ">" if value > most else ""
    return f"{mark}{value:.3g}"
