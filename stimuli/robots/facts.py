"""A robot's facts as a YAML file: joints, limits, home pose, sources, and measures for its body.

The body's measures are free in form; the robot's own module reads them.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import yaml
from pydantic import BaseModel, ConfigDict, Field

from stimuli.robots.model import Joint, JointKind, Robot, Vector

if TYPE_CHECKING:
    import mujoco

LOOK = (
    *(f"robots/{name}.py" for name in ("facts", "model", "shapes", "skeleton")),
    *("outline.py", "scene.py", "rendering.py", "video.py"),
)
"""The code every robot's pictures depend on, beside its own."""


class JointFacts(BaseModel):
    """One joint as written in the file."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str
    parent: str
    child: str
    kind: JointKind = "revolute"
    xyz: Vector = (0, 0, 0)
    rpy: Vector = (0, 0, 0)
    axis: Vector = (0, 0, 0)
    lower: float
    upper: float
    max_velocity: float | None = None
    max_acceleration: float | None = None

    @property
    def joint(self) -> Joint:
        """The joint as the rest of the program knows it."""
        return Joint(
            name=self.name,
            parent=self.parent,
            child=self.child,
            kind=self.kind,
            origin_xyz=self.xyz,
            origin_rpy=self.rpy,
            axis=self.axis,
            lower=self.lower,
            upper=self.upper,
            max_velocity=self.max_velocity,
            max_acceleration=self.max_acceleration,
        )


class Base(BaseModel):
    """The link that stands in the world, and where."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    link: str
    xyz: Vector


class Facts(BaseModel):
    """All that is known of a robot, with its sources."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    title: str
    sources: tuple[str, ...]
    base: Base
    joints: tuple[JointFacts, ...]
    home: Mapping[str, float]
    hands: tuple[str, ...] = ()
    head: str | None = None
    body: Mapping[str, Any] = Field(default_factory=dict)


@cache
def read_facts(name: str) -> Facts:
    """Read the packaged facts of a robot."""
    text = files("stimuli.robots").joinpath(f"{name}.yaml").read_text(encoding="utf-8")
    return Facts.model_validate(yaml.safe_load(text))


def assembled(
    name: str,
    build: Callable[[], mujoco.MjSpec],
    qpos: Callable[[Mapping[str, float]], Mapping[str, float]] = dict,
) -> Robot:
    """The packaged robot of that name: its facts, and the function that builds its body."""
    facts = read_facts(name)
    own = sorted(
        f"robots/{file.name}" for file in files("stimuli.robots").iterdir() if _is_of(file.name, name)
    )
    return Robot(
        name=name,
        title=facts.title,
        joints=tuple(joint.joint for joint in facts.joints),
        home=facts.home,
        build=build,
        qpos=qpos,
        hands=facts.hands,
        head=facts.head,
        base_xyz=facts.base.xyz,
        sources=facts.sources,
        sha256=sources_sha256(*own, *LOOK),
    )


def _is_of(file: str, robot: str) -> bool:
    """Whether a packaged file is one of a robot's own: `pepper.yaml`, `pepper.py`, `pepper_arms.py`."""
    return re.fullmatch(rf"{robot}(_\w+)?\.(py|yaml)", file) is not None


def sources_sha256(*names: str) -> str:
    """Hash of packaged files, given relative to the package `stimuli`: what a robot's look depends on."""
    digest = hashlib.sha256()
    for name in names:
        digest.update(files("stimuli").joinpath(*name.split("/")).read_bytes())
    return digest.hexdigest()
