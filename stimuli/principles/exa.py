"""Exaggeration: more, or less, of what makes the motion special."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, Literal

from pydantic import Field

from stimuli.course import Course
from stimuli.principles.principle import Principle, Stage


class Exa(Principle):
    """Scale the forcing term: f' = p f.

    `around: goal`, as in the paper, scales what distinguishes the motion from an unforced spring, which
    leaves for the goal at once and fast. Where start and goal agree, that is the motion's own shape; on a
    reach, p > 1 makes it set out backwards and p < 1 makes it faster. `around: straight` scales what
    distinguishes it from a minimum-jerk reach instead, so that a straight reach stays as it is.
    """

    kind: ClassVar[str] = "exa"
    title: ClassVar[str] = "Exaggeration"
    stage: ClassVar[Stage] = Stage.FORCING
    neutral: ClassVar[float] = 1.0
    strong: ClassVar[float] = 1.5

    intensity: float = Field(1.0, ge=-100, le=100)
    around: Literal["goal", "straight"] = "goal"

    @property
    def is_affine(self) -> bool:
        """Whether motions change in proportion to the intensity, all else being equal."""
        return True

    def modulate(self, course: Course) -> Course:
        """Set the factor and what it acts around."""
        return replace(course, exaggeration=self.intensity, around=self.around)
