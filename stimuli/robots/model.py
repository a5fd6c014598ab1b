"""What a robot is, apart from how it looks: joints, limits, kinematic tree, home pose and relations.

Units: m, rad, s. Pepper's hands are dimensionless (0 closed, 1 open), so amplitudes of different joints
are compared only after division by the joint's range.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    import mujoco

Vector = tuple[float, float, float]
JointKind = Literal["revolute", "prismatic", "dimensionless"]


@dataclass(frozen=True)
class Joint:
    """One degree of freedom between two links."""

    name: str
    parent: str
    child: str
    kind: JointKind
    origin_xyz: Vector  # m, in the parent link's frame
    origin_rpy: Vector  # rad, fixed axes x-y-z as in URDF
    axis: Vector  # unit vector in the joint's frame; (0, 0, 0) where dimensionless
    lower: float
    upper: float
    max_velocity: float | None  # per second; None where unknown
    max_acceleration: float | None = None

    @property
    def unit(self) -> str:
        """Unit of positions: rad, m, or 1 for dimensionless joints."""
        return {"revolute": "rad", "prismatic": "m", "dimensionless": "1"}[self.kind]

    @property
    def range(self) -> float:
        """Width of the position range."""
        return self.upper - self.lower


@dataclass(frozen=True)
class Within:
    """A joint's limits within which something holds."""

    joint: str
    lower: float  # minus infinity where there is none
    upper: float
    edge: float = math.radians(10.0)  # the way inside a limit on which what holds fades


@dataclass(frozen=True)
class Relation:
    """A source joint whose motion is carried over to a target joint (Secondary Action, Follow Through)."""

    source: str
    target: str
    sign: Literal[1, -1]  # the paper's delta
    while_: tuple[Within, ...] = ()  # joints between them, and where these keep the axes aligned


@dataclass(frozen=True)
class View:
    """From where the camera looks at a robot; home's front is +x."""

    azimuth_deg: float = 14.0  # to the robot's left of straight ahead
    elevation_deg: float = 4.0  # above its middle


@dataclass(frozen=True)
class Robot:
    """A robot's kinematic facts, and how to build its MuJoCo body."""

    name: str
    title: str  # shown to people; says "reconstruction" where the model is one
    joints: tuple[Joint, ...]
    home: Mapping[str, float]  # every joint's resting position
    build: Callable[[], mujoco.MjSpec]  # the bare robot, without lights, floor or cameras
    qpos: Callable[[Mapping[str, float]], Mapping[str, float]] = field(default=dict)
    """From joint positions to MuJoCo joint positions: identity, but for joints that drive others (hands)."""
    relations: tuple[Relation, ...] | None = None  # None: found from the tree
    hands: tuple[str, ...] = ()  # links whose reach is measured
    head: str | None = None  # link that looks
    base_xyz: Vector = (0.0, 0.0, 0.0)  # of the root link, from the floor below the robot
    view: View = View()
    sources: tuple[str, ...] = ()  # where the facts come from
    sha256: str = ""  # of everything the look and the motion depend on

    def joint(self, name: str) -> Joint:
        """The joint of that name. Raises KeyError."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise KeyError(name)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of all degrees of freedom, in the robot's order."""
        return tuple(joint.name for joint in self.joints)
