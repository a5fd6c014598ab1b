"""Timing: faster or slower as a whole, and faster or slower in parts."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator, Field

from stimuli.course import Course, Curve
from stimuli.principles.principle import Principle, Stage

SPEEDS = {"slow": 0.5, "even": 1.0, "fast": 1.5}

Speed = Annotated[float, BeforeValidator(lambda value: SPEEDS.get(value, value)), Field(gt=0, le=100)]


class Time(Principle):
    """Scale the duration, tau' = p tau, and let the motion progress at another speed in each sector of time.

    `progression` lists the speeds of equally long sectors, as numbers or `slow`, `even`, `fast`; only their
    ratios count. The phase follows a monotone cubic through the sectors' borders, so it never runs backwards.

    `form: phase`, as in the paper, changes the phase alone: the forcing term follows it, the spring stays in
    real time. `form: retime` runs the whole motion by that clock, so that the path stays the same exactly.

    `fit: scale` lets a motion that would be too fast for the robot last longer, by as little as makes it fit;
    otherwise it is refused.
    """

    kind: ClassVar[str] = "time"
    title: ClassVar[str] = "Timing"
    stage: ClassVar[Stage] = Stage.DURATION
    neutral: ClassVar[float] = 1.0
    strong: ClassVar[float] = 0.75

    intensity: float = Field(1.0, gt=0, le=100)
    progression: tuple[Speed, ...] = ()
    form: Literal["phase", "retime"] = "phase"
    fit: Literal["refuse", "scale"] = "refuse"

    @property
    def is_neutral(self) -> bool:
        """Neither the whole nor a part is faster or slower."""
        return self.intensity == 1 and len(set(self.progression)) <= 1

    def modulate(self, course: Course) -> Course:
        """Scale the duration and bend the phase or the clock."""
        course = replace(course, tau_s=self.intensity * course.tau_s)
        if len(set(self.progression)) <= 1:
            return course
        curve = sectors(self.progression)
        if self.form == "phase":
            return replace(course, progress=curve.after(course.progress))
        return replace(course, clock=curve.after(course.clock))


def sectors(speeds: tuple[float, ...]) -> Curve:
    """The monotone curve from (0, 0) to (1, 1) with these relative speeds in equally long sectors."""
    from scipy.interpolate import PchipInterpolator  # late: slow to import

    borders = np.linspace(0.0, 1.0, len(speeds) + 1)
    gone = np.concatenate([[0.0], np.cumsum(speeds) / np.sum(speeds)])
    spline = PchipInterpolator(borders, gone)
    return Curve(spline, spline.derivative())
