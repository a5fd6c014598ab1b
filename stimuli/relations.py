"""Which joints drive which, for Secondary Action and Follow Through, from the robot's kinematic tree.

A target hangs below its source in the same kinematic chain, and their axes are aligned within a threshold
(Hielscher et al. 2025, section III-B). Joints between the two may turn the axes apart, so a relation holds
while each of these is within limits: those at which the axes are the threshold apart, the other joints being
at home; but the joint that turns them most is taken, for that, to the middle of its own limits. delta is 1
where the axes point the same way and -1 where they are opposed. A source whose motion already comes to the
target by a joint between them is not taken again. A robot may give its relations instead.

For Pepper this finds, for instance, HipPitch -> ShoulderPitch always, and ShoulderPitch -> ElbowRoll with
ElbowYaw around 90 degrees but ShoulderRoll -> ElbowRoll with ElbowYaw around 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import groupby

import numpy as np

from stimuli.errors import InputError
from stimuli.kinematics import chain, moved, placed
from stimuli.robots.model import Joint, Relation, Robot, Within
from stimuli.trajectory import FloatArray

ALIGNED_RAD = math.radians(30.0)  # largest angle between axes that count as parallel
_SIGNS = {frozenset({1}): "", frozenset({-1}): "-", frozenset({1, -1}): "±"}
_POSES = 721  # of a joint, looked at within its range


def relations_of(robot: Robot, joints: tuple[str, ...]) -> tuple[Relation, ...]:
    """Relations among these joints, sources before their targets."""
    relations = found(robot) if robot.relations is None else robot.relations
    moving = [relation for relation in relations if set(_joints_of(relation)) <= set(joints)]
    return in_causal_order(robot.name, moving)


def found(robot: Robot, aligned_rad: float = ALIGNED_RAD) -> tuple[Relation, ...]:
    """The relations that the robot's tree suggests."""
    return _found(robot.joints, tuple(sorted(robot.home.items())), aligned_rad)


@lru_cache(maxsize=32)
def _found(
    joints: tuple[Joint, ...], home: tuple[tuple[str, float], ...], aligned_rad: float
) -> tuple[Relation, ...]:
    relations: list[Relation] = []
    for target in joints:
        above = chain(joints, target.parent)
        for at in reversed(range(len(above))):
            source = above[at]
            if target.kind != source.kind or target.kind == "dimensionless":
                continue
            if source.name not in _sources_of(target.name, relations):
                relations += _between(source, above[at + 1 :], target, dict(home), aligned_rad)
    return tuple(relations)


def _sources_of(target: str, relations: list[Relation]) -> set[str]:
    """Joints whose motion comes to the target, by others or not."""
    direct = {relation.source for relation in relations if relation.target == target}
    return direct.union(*(_sources_of(source, relations) for source in direct))


def _between(
    source: Joint, between: list[Joint], target: Joint, home: dict[str, float], aligned_rad: float
) -> Iterator[Relation]:
    """Relations of a source to a target: several where a joint between them may turn the axes either way."""
    least = math.cos(aligned_rad) - 1e-12

    def cosines(joint: Joint, pose: Mapping[str, float]) -> FloatArray:
        """Cosines of the angle between the axes over a joint's range, the others being in a pose."""
        return _cosines(source, between, target, {**pose, joint.name: _range(joint)})

    def limits(joint: Joint, pose: Mapping[str, float]) -> list[tuple[float, float]]:
        """Stretches of the joint's range in which the axes are aligned."""
        aligned = zip(_range(joint).tolist(), (np.abs(cosines(joint, pose)) >= least).tolist(), strict=True)
        stretches = [[at for at, _ in run] for good, run in groupby(aligned, lambda pair: pair[1]) if good]
        return [(stretch[0], stretch[-1]) for stretch in stretches]

    turning = [joint for joint in between if np.ptp(cosines(joint, home)) > 1e-9]
    if not turning:
        cosine = float(_cosines(source, between, target, home))
        if abs(cosine) >= least:
            yield Relation(source.name, target.name, 1 if cosine > 0 else -1)
        return
    decisive = max(turning, key=lambda joint: float(np.ptp(cosines(joint, home))))
    for lower, upper in limits(decisive, home):
        within = {decisive.name: (lower, upper)}
        pose = home | {decisive.name: (lower + upper) / 2}
        for joint in turning:
            if joint is not decisive:
                holding = [ends for ends in limits(joint, pose) if ends[0] <= home[joint.name] <= ends[1]]
                within[joint.name] = holding[0] if holding else (0.0, 0.0)
        cosine = float(_cosines(source, between, target, pose))
        if all(upper > lower for lower, upper in within.values()):
            conditions = tuple(
                Within(
                    joint.name,
                    lower if lower > joint.lower else -math.inf,
                    upper if upper < joint.upper else math.inf,
                )
                for joint in turning
                for lower, upper in [within[joint.name]]
                if (lower, upper) != (joint.lower, joint.upper)
            )
            yield Relation(source.name, target.name, 1 if cosine > 0 else -1, conditions)


def _range(joint: Joint) -> FloatArray:
    return np.linspace(joint.lower, joint.upper, _POSES)


def _cosines(
    source: Joint, between: list[Joint], target: Joint, pose: Mapping[str, float | FloatArray]
) -> FloatArray:
    """Cosine of the angle between the axes of source and target, for every pose of the joints between."""
    axis = placed(target)[:3, :3] @ np.array(target.axis)[:, None]
    for joint in reversed(between):
        axis = placed(joint)[:3, :3] @ moved(joint, pose[joint.name])[..., :3, :3] @ axis
    made: FloatArray = axis[..., 0] @ np.array(source.axis)
    return made


def _joints_of(relation: Relation) -> tuple[str, ...]:
    return (relation.source, relation.target, *(within.joint for within in relation.while_))


def in_causal_order(robot: str, relations: list[Relation]) -> tuple[Relation, ...]:
    """Sorted so that a joint is a target before others depend on it. InputError where they form a cycle."""
    waiting, done = list(relations), []
    while waiting:
        targets = {relation.target for relation in waiting}
        free = [
            relation
            for relation in waiting
            if relation.source not in targets and not targets & {within.joint for within in relation.while_}
        ]
        if not free:
            names = " -> ".join(relation.source for relation in waiting)
            raise InputError(f"{robot}: relations form a cycle among {names}; remove one of them")
        done += free
        waiting = [relation for relation in waiting if relation not in free]
    return tuple(done)


def in_short(relations: tuple[Relation, ...]) -> str:
    """Sources and what they drive, `HipRoll -> ±HeadPitch [HeadYaw]`: either way, by where HeadYaw is."""
    signs: dict[str, dict[str, set[int]]] = {}
    for relation in relations:
        gate = ", ".join(within.joint for within in relation.while_)
        driven = relation.target + (f" [{gate}]" if gate else "")
        signs.setdefault(relation.source, {}).setdefault(driven, set()).add(relation.sign)
    listed = "; ".join(
        f"{source} -> {', '.join(_SIGNS[frozenset(found)] + driven for driven, found in targets.items())}"
        for source, targets in signs.items()
    )
    gated = any(relation.while_ for relation in relations)
    return (listed or "no joint drives another") + (" ([…]: while these are within limits)" if gated else "")


def described(relation: Relation, robot: Robot) -> str:
    """A relation in words, such as `HipPitch -> HeadPitch (opposed) while HeadYaw -30…30 deg`."""
    opposed = " (opposed)" if relation.sign < 0 else ""
    limits = " and ".join(_limits(within, robot) for within in relation.while_)
    return f"{relation.source} -> {relation.target}{opposed}" + (f" while {limits}" if limits else "")


def _limits(within: Within, robot: Robot) -> str:
    revolute = robot.joint(within.joint).kind == "revolute"
    unit = " deg" if revolute else ""
    lower, upper = (
        f"{math.degrees(limit):.0f}" if revolute else f"{limit:g}" for limit in (within.lower, within.upper)
    )
    if math.isinf(within.lower):
        return f"{within.joint} < {upper}{unit}"
    if math.isinf(within.upper):
        return f"{within.joint} > {lower}{unit}"
    return f"{within.joint} {lower}…{upper}{unit}"
