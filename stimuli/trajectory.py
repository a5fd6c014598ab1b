"""Joint motion on a uniform time grid: what gestures are read into and what the primitives make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.intp]


def even_times(duration_s: float, dt_s: float) -> FloatArray:
    """Times from 0 to the duration in even steps as near to dt_s as fit."""
    return np.linspace(0.0, duration_s, max(1, round(duration_s / dt_s)) + 1)


@dataclass(frozen=True)
class Trajectory:
    """Joint motion on a uniform time grid.

    Positions are in the joint's own unit: rad for hinges, m for slides, and 0–1 for Pepper's hands.
    """

    times: FloatArray  # (n,) seconds, from 0
    positions: FloatArray  # (n, d), columns as in `joints`
    joints: tuple[str, ...]

    def __post_init__(self) -> None:
        if self.positions.shape != (len(self.times), len(self.joints)):
            raise ValueError(
                f"positions have shape {self.positions.shape}; {len(self.times)} times and "
                f"{len(self.joints)} joints need ({len(self.times)}, {len(self.joints)})"
            )

    @property
    def duration_s(self) -> float:
        """Time from the first to the last sample, in seconds."""
        return float(self.times[-1] - self.times[0])

    def joint(self, name: str) -> FloatArray:
        """Positions of one joint, shape (n,). Raises KeyError for a joint that does not move here."""
        try:
            return self.positions[:, self.joints.index(name)]
        except ValueError:
            raise KeyError(name) from None

    def at(self, times: FloatArray) -> FloatArray:
        """Positions at the given times, shape (len(times), d): linear between samples, held outside."""
        return np.stack([np.interp(times, self.times, column) for column in self.positions.T], axis=1)

    def resampled(self, dt_s: float) -> Trajectory:
        """The same motion in even steps as near to dt_s as fit; itself where they do already.

        Between samples by monotone cubics (PCHIP), which never leave the range of the samples.
        """
        times = even_times(self.duration_s, dt_s)
        if len(times) == len(self.times):
            return self
        return Trajectory(times, self.resampled_at(times + self.times[0]), self.joints)

    def resampled_at(self, times: FloatArray) -> FloatArray:
        """Positions at these times, (len(times), d), by monotone cubics (PCHIP)."""
        from scipy.interpolate import PchipInterpolator  # late: slow to import

        return np.asarray(PchipInterpolator(self.times, self.positions)(times), dtype=np.float64)
