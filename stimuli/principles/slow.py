"""Slow In and Slow Out: start slowly, gather speed, end slowly."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from stimuli.course import Course, Curve
from stimuli.principles.principle import Principle, Stage
from stimuli.trajectory import FloatArray


class Slow(Principle):
    """Let the motion progress along a sigmoid instead of evenly: progress(s) = (1 - p) s + p sigmoid(s).

    The sigmoid is logistic with the given `steepness`, shifted and scaled to run exactly from (0, 0) to (1,
    1).

    `form: phase`, as in the paper, bends the phase alone. The spring goes on in real time, so the start is
    less slow than drawn, and peaks and dips are lost. `form: retime` runs the whole motion by the bent clock,
    and so slows both ends exactly as drawn and keeps the path.
    """

    kind: ClassVar[str] = "slow"
    title: ClassVar[str] = "Slow In and Slow Out"
    stage: ClassVar[Stage] = Stage.PHASE
    strong: ClassVar[float] = 1.0

    intensity: float = Field(0.0, ge=0, le=1)
    steepness: float = Field(10.0, gt=0, le=100)
    form: Literal["phase", "retime"] = "phase"

    def modulate(self, course: Course) -> Course:
        """Bend the phase or the clock."""
        if self.form == "phase":
            return replace(course, progress=self.curve().after(course.progress))
        return replace(course, clock=self.curve().after(course.clock))

    def curve(self) -> Curve:
        """Share of the motion gone by at a share of time."""
        p, half = self.intensity, self.steepness / 2
        scale = 2 * np.tanh(half / 2)

        def gone(share: FloatArray) -> FloatArray:
            sigmoid: FloatArray = 0.5 + np.tanh(half * (share - 0.5)) / scale
            return (1 - p) * share + p * sigmoid

        def slope(share: FloatArray) -> FloatArray:
            bend: FloatArray = half / scale / np.cosh(half * (share - 0.5)) ** 2
            return (1 - p) + p * bend

        return Curve(gone, slope)
