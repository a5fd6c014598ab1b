"""What every animation principle is."""

from __future__ import annotations

from enum import IntEnum
from typing import ClassVar, Self

from pydantic import BaseModel, ConfigDict

from stimuli.course import Course
from stimuli.robots.model import Robot


class Stage(IntEnum):
    """Where in a movement primitive a principle acts; stages run in this order, then by name."""

    WEIGHTS = 1
    DURATION = 2
    PHASE = 3
    FORCING = 4
    ACCELERATION = 5
    POSITION = 6
    GOAL = 7


class Principle(BaseModel):
    """One animation principle with its parameters: a function from course to course.

    A kind has a short name for protocols (`kind`), a `title`, a `stage`, and a `neutral` intensity at which
    it changes nothing, bit for bit; at its `strong` one the principle is plain to see.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    kind: ClassVar[str]
    title: ClassVar[str]
    stage: ClassVar[Stage]
    neutral: ClassVar[float] = 0.0
    strong: ClassVar[float]

    intensity: float

    @classmethod
    def example(cls, robot: Robot) -> Self:  # noqa: ARG003
        """This principle, plain to see on that robot."""
        return cls(intensity=cls.strong)

    def apply(self, course: Course) -> Course:
        """The course as this principle changes it; the very same course where the principle is neutral."""
        return course if self.is_neutral else self.modulate(course)

    @property
    def is_neutral(self) -> bool:
        """Whether this changes nothing."""
        return self.intensity == self.neutral

    @property
    def is_affine(self) -> bool:
        """Whether motions change in proportion to the intensity, all else being equal."""
        return False

    @property
    def dial(self) -> str:
        """The parameter that says how strong this is."""
        return "intensity"

    def modulate(self, course: Course) -> Course:
        """The changed course; called only where the principle is not neutral."""
        raise NotImplementedError
