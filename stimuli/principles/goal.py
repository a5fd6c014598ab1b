"""Interactive Goal: end somewhere else, with the same characteristic shape."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

from pydantic import Field, field_validator, model_validator

from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.principles.principle import Principle, Stage
from stimuli.robots.model import Robot
from stimuli.units import POSITION, in_base_unit


class Goal(Principle):
    """Replace the goal of the named joints: `{HeadPitch: 22 deg}`, positions in the joint's unit or as text.

    The spring leaves for a new goal at once, with an acceleration that jumps; `lag_s` > 0 lets the goal glide
    there from the demonstrated one, g(t) = g' + (g - g') exp(-t / lag).
    """

    kind: ClassVar[str] = "goal"
    title: ClassVar[str] = "Interactive Goal"
    stage: ClassVar[Stage] = Stage.GOAL
    neutral: ClassVar[float] = 0.0
    strong: ClassVar[float] = 1.0

    intensity: float = Field(1.0, ge=0, le=1)  # share of the way from the demonstrated goal to the new one
    joints: dict[str, float] = Field(default_factory=dict)
    lag_s: float = Field(0.0, ge=0, le=60)

    @classmethod
    def example(cls, robot: Robot) -> Goal:
        """The first joint heads for three quarters of its range."""
        joint = robot.joints[0]
        return cls(intensity=cls.strong, joints={joint.name: joint.lower + 0.75 * joint.range})

    @model_validator(mode="before")
    @classmethod
    def _names_joints_directly(cls, value: Any) -> Any:
        if not isinstance(value, Mapping):
            return value
        own = {name: entry for name, entry in value.items() if name in cls.model_fields}
        joints = {name: entry for name, entry in value.items() if name not in cls.model_fields}
        return own | ({"joints": {**own.get("joints", {}), **joints}} if joints else {})

    @field_validator("joints", mode="before")
    @classmethod
    def _in_joint_units(cls, joints: Any) -> Any:
        if not isinstance(joints, Mapping):
            return joints
        return {str(name): _position(str(name), value) for name, value in sorted(joints.items())}

    @property
    def is_neutral(self) -> bool:
        """No joint gets another goal."""
        return self.intensity == 0 or not self.joints

    def modulate(self, course: Course) -> Course:
        """Move the goal."""
        goal = course.goal.copy()
        for name, position in self.joints.items():
            if name not in course.joints:
                near = difflib.get_close_matches(name, course.joints, 1)
                hint = f"; did you mean {near[0]}?" if near else f". Known: {', '.join(course.joints)}"
                raise InputError(f"goal.{name}: {course.robot.name} has no such joint{hint}")
            column = course.joints.index(name)
            goal[column] += self.intensity * (position - goal[column])
        return replace(course, goal=goal, former_goal=course.goal, goal_lag_s=self.lag_s)


def _position(name: str, value: object) -> float:
    try:
        return in_base_unit(value, POSITION)
    except ValueError as err:
        raise ValueError(f"goal.{name}: {err}; write 22 deg, 0.35 rad, 0.1 m or a bare number") from err
