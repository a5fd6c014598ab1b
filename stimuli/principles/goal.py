"""Interactive Goal: end somewhere else, with the same characteristic shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from pydantic import Field, field_validator, model_validator

from stimuli.attractor import filtered_goal
from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.gaze import looking_at
from stimuli.principles.principle import Principle, Stage
from stimuli.robots.model import Robot, Vector
from stimuli.units import LENGTH, POSITION, TIME, in_base_unit


class Goal(Principle):
    """Replace the goal of the named joints: `{HeadPitch: 22 deg}`, positions in the joint's unit or as text.

    A goal may move under way: `{HeadYaw: {0.5: 25 deg, 1.6: -20 deg}}` heads for 25 degrees from 0.5 s on and
    for -20 from 1.6 s on; before that, for the demonstrated goal.

    `look_at: [x, y, z]` sets goals of the head such that it ends looking at that point, in m from the floor
    below the robot: x ahead, y to its left, z up. The rest of the body is then at its own goals.

    The spring leaves for a new goal at once, with an acceleration that jumps; `lag_s` > 0 lets the goal glide
    there from the demonstrated one, g(t) = g' + (g - g') exp(-t / lag).
    """

    kind: ClassVar[str] = "goal"
    title: ClassVar[str] = "Interactive Goal"
    stage: ClassVar[Stage] = Stage.GOAL
    neutral: ClassVar[float] = 0.0
    strong: ClassVar[float] = 1.0

    intensity: float = Field(1.0, ge=0, le=1)  # share of the way from the demonstrated goal to the new one
    joints: dict[str, float | dict[float, float]] = Field(default_factory=dict)  # s: position, if it moves
    look_at: Vector | None = None
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
        return {str(name): _positions(str(name), value) for name, value in sorted(joints.items())}

    @field_validator("look_at", mode="before")
    @classmethod
    def _in_metres(cls, point: Any) -> Any:
        if isinstance(point, str) or not isinstance(point, Sequence):
            return point
        try:
            return [in_base_unit(coordinate, LENGTH) for coordinate in point]
        except ValueError as err:
            raise ValueError(f"goal.look_at: {err}") from err

    @property
    def is_neutral(self) -> bool:
        """No joint gets another goal."""
        return self.intensity == 0 or (not self.joints and self.look_at is None)

    @property
    def is_affine(self) -> bool:
        """Whether motions change in proportion to the intensity, all else being equal."""
        return True

    def modulate(self, course: Course) -> Course:
        """Move the goal, once or at one moment after the other."""
        demonstrated = course.goal
        moments: dict[float, dict[int, float]] = {}
        for name, positions in self.joints.items():
            column = course.column(name, "goal")
            for moment, position in (positions if isinstance(positions, dict) else {0.0: positions}).items():
                moments.setdefault(moment, {})[column] = position
        if self.look_at is not None:
            moments.setdefault(0.0, {}).update(self._gaze(self.look_at, course, moments))
        for moment in sorted(moments):
            goal, since = course.goal.copy(), moment / course.tau_s
            for column, position in moments[moment].items():
                goal[column] = demonstrated[column] + self.intensity * (position - demonstrated[column])
            course = replace(
                course,
                goal=goal,
                former_goal=filtered_goal(course, np.array([since]))[0],
                goal_lag_s=self.lag_s,
                goal_since=since,
                until_then=course if since > 0 else None,
            )
        return course

    @staticmethod
    def _gaze(
        point: Vector, course: Course, moments: Mapping[float, Mapping[int, float]]
    ) -> dict[int, float]:
        """Goals of the head's joints, the others being where they are to end."""
        pose = dict(course.robot.home) | dict(zip(course.joints, course.goal.tolist(), strict=True))
        for moment in sorted(moments):
            pose |= {course.joints[column]: position for column, position in moments[moment].items()}
        try:
            gaze = looking_at(point, course.robot, pose)
        except InputError as err:
            raise InputError(f"goal.look_at: {err}") from err
        return {course.column(name, "goal.look_at"): position for name, position in gaze.items()}


def _positions(name: str, value: object) -> float | dict[float, float]:
    try:
        if not isinstance(value, Mapping):
            return in_base_unit(value, POSITION)
        moving = {in_base_unit(at, TIME): in_base_unit(entry, POSITION) for at, entry in value.items()}
    except ValueError as err:
        raise ValueError(f"goal.{name}: {err}; write 22 deg, 0.35 rad, 0.1 m or a bare number") from err
    if not moving or min(moving) < 0:
        raise ValueError(f"goal.{name}: a goal that moves needs moments from 0 s on, as {{0.5: 25 deg}}")
    return dict(sorted(moving.items()))
