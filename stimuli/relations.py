"""Which joints drive which, for Secondary Action and Follow Through, from the robot's kinematic tree.

A target hangs below its source in the same kinematic chain, and their axes are nearly parallel at the home
pose (Hielscher et al. 2025, section III-B). Of several sources the nearest in the chain is taken. delta is 1
where the axes point the same way and -1 where they are opposed. A robot file may give its relations instead.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from stimuli.errors import InputError
from stimuli.kinematics import axes, chain
from stimuli.robots.model import Joint, Relation, Robot

ALIGNED_RAD = math.radians(15.0)  # largest angle between axes that count as parallel


def relations_of(robot: Robot, joints: tuple[str, ...]) -> tuple[Relation, ...]:
    """Relations among these joints, sources before their targets."""
    relations = found(robot) if robot.relations is None else robot.relations
    moving = [relation for relation in relations if {relation.source, relation.target} <= set(joints)]
    return in_causal_order(robot.name, moving)


def found(robot: Robot, aligned_rad: float = ALIGNED_RAD) -> tuple[Relation, ...]:
    """The relations that the robot's tree suggests."""
    return _found(robot.joints, tuple(sorted(robot.home.items())), aligned_rad)


@lru_cache(maxsize=32)
def _found(
    joints: tuple[Joint, ...], home: tuple[tuple[str, float], ...], aligned_rad: float
) -> tuple[Relation, ...]:
    directions = axes(joints, dict(home))
    relations = []
    for target in joints:
        for source in reversed(chain(joints, target.parent)):
            if target.name not in directions or source.name not in directions or source.kind != target.kind:
                continue
            cosine = float(np.dot(directions[source.name], directions[target.name]))
            if abs(cosine) >= math.cos(aligned_rad) - 1e-12:
                relations.append(Relation(source.name, target.name, 1 if cosine > 0 else -1))
                break
    return tuple(relations)


def in_causal_order(robot: str, relations: list[Relation]) -> tuple[Relation, ...]:
    """Sorted so that a joint is a target before it is a source. InputError where they form a cycle."""
    waiting, done = list(relations), []
    while waiting:
        targets = {relation.target for relation in waiting}
        free = [relation for relation in waiting if relation.source not in targets]
        if not free:
            names = " -> ".join(relation.source for relation in waiting)
            raise InputError(f"{robot}: relations form a cycle among {names}; remove one of them")
        done += free
        waiting = [relation for relation in waiting if relation not in free]
    return tuple(done)
