"""Pepper (SoftBank/Aldebaran): 17 degrees of freedom, and a body lofted from sections."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from stimuli.robots.facts import read_facts, sources_sha256
from stimuli.robots.model import Robot

if TYPE_CHECKING:
    import mujoco


def load() -> Robot:
    """Pepper in its StandInit posture."""
    facts = read_facts("pepper")
    return Robot(
        name="pepper",
        title=facts.title,
        joints=tuple(joint.joint for joint in facts.joints),
        home=facts.home,
        build=build,
        qpos=drive_fingers,
        hands=facts.hands,
        head=facts.head,
        sources=facts.sources,
        sha256=sources_sha256("robots/pepper.yaml", "robots/pepper.py"),
    )


def build() -> mujoco.MjSpec:
    """Pepper's body."""
    raise NotImplementedError


def drive_fingers(positions: Mapping[str, float]) -> Mapping[str, float]:
    """MuJoCo joint positions: Hand becomes the angles of the fourteen finger joints."""
    body = read_facts("pepper").body["fingers"]
    curl = body["curl"]
    angles = {name: value for name, value in positions.items() if not name.endswith("Hand")}
    for hand in ("LHand", "RHand"):
        if hand in positions:
            for finger, facts in body.items():
                if isinstance(facts, dict):
                    for k in range(facts["phalanges"]):
                        angles[f"{hand[0]}{finger}{k + 1}"] = curl * positions[hand]
    return angles
