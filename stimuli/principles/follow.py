"""Follow Through: loose parts drag behind and swing on."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from pydantic import Field

from stimuli.course import Course
from stimuli.principles.principle import Principle, Stage


class Follow(Principle):
    """Take the source's acceleration off the target's: y_T'' becomes y_T'' - delta p y_S''.

    Sources and targets come from the robot's kinematic tree (`stimuli.relations`). Sources are carried out
    before their targets, so a chain of relations sees accelerations as modulated, none of them stale.
    """

    kind: ClassVar[str] = "follow"
    title: ClassVar[str] = "Follow Through"
    stage: ClassVar[Stage] = Stage.ACCELERATION
    strong: ClassVar[float] = 3.0

    intensity: float = Field(0.0, ge=0, le=100)

    def modulate(self, course: Course) -> Course:
        """Couple the accelerations."""
        return replace(course, dragged=course.coupling(self.intensity))
