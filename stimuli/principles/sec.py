"""Secondary Action: other parts join in."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, Literal

from pydantic import Field

from stimuli.course import Course
from stimuli.principles.principle import Principle, Stage

STEP_S = 1 / 60  # at which the authors' program adds the term


class Sec(Principle):
    """Carry the source's velocity over to the target's position: y_T becomes y_T + delta p y_S'.

    `form: output` is the formula as printed: the shown position is moved, the spring knows nothing of it, p
    is in seconds. As that contains a velocity, what is shown jumps in velocity where accelerations jump:
    where a motion sets out for a new goal, and where an anticipation ends. Changes under way are smoothed.

    `form: state` moves the state itself, as a program does that adds the term in every step; it is written
    here as a rate, y_T' gains delta (p / (1/60 s)) y_S', so that the step size drops out. It is much
    stronger: p = 0.05 is plain to see in it and nearly invisible in `output`. No velocity jumps in it.
    """

    kind: ClassVar[str] = "sec"
    title: ClassVar[str] = "Secondary Action"
    stage: ClassVar[Stage] = Stage.POSITION
    strong: ClassVar[float] = 0.15

    intensity: float = Field(0.0, ge=0, le=100)
    form: Literal["output", "state"] = "output"

    @property
    def is_affine(self) -> bool:
        """Whether motions change in proportion to the intensity, all else being equal."""
        return self.form == "output"

    def modulate(self, course: Course) -> Course:
        """Couple velocities to positions."""
        if self.form == "output":
            return replace(course, carried=course.coupling(self.intensity))
        return replace(course, induced=course.coupling(self.intensity / STEP_S))
