"""Joints that follow others: a URDF's <mimic>, or an MJCF's <equality> of two joints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from stimuli.errors import InputError


@dataclass(frozen=True)
class Mimic:
    """A joint at `multiplier` times another's position, plus `offset`."""

    joint: str
    multiplier: float
    offset: float


def mimicked(positions: Mapping[str, float], mimics: Mapping[str, Mimic]) -> dict[str, float]:
    """Positions of all joints, those that follow others too."""
    following = {
        name: mimic.multiplier * positions[mimic.joint] + mimic.offset for name, mimic in mimics.items()
    }
    return {**positions, **following}


def by_their_leaders(written: Mapping[str, Mimic], place: Callable[[str], str]) -> dict[str, Mimic]:
    """Each joint that follows another, by the one that leads them all; `place` says where it is written."""

    def led(name: str) -> Mimic:
        mimic, seen = written[name], {name}
        while mimic.joint in written:
            if mimic.joint in seen:
                raise InputError(f"{place(name)}: joint {name!r}: mimic: it follows itself")
            seen.add(mimic.joint)
            leader = written[mimic.joint]
            multiplier = mimic.multiplier * leader.multiplier
            mimic = Mimic(leader.joint, multiplier, mimic.multiplier * leader.offset + mimic.offset)
        return mimic

    return {name: led(name) for name in written}


def coupled(model: mujoco.MjModel, source: object) -> dict[str, Mimic]:
    """What the equalities of an MJCF say of two joints: y − y₀ = a + b (x − x₀), from the reference pose."""
    written: dict[str, Mimic] = {}
    for index in np.flatnonzero(model.eq_type == mujoco.mjtEq.mjEQ_JOINT):
        if model.eq_obj2id[index] < 0 or not model.eq_active0[index]:
            continue
        follower, leader = (model.joint(ids[index]) for ids in (model.eq_obj1id, model.eq_obj2id))
        a, b, *curved = model.eq_data[index, :5]
        if any(curved):
            raise InputError(
                f"{source}: joint {follower.name!r} follows {leader.name!r} along a curve; only "
                f'polycoef="A B 0 0 0", a straight line, can be used'
            )
        here, there = (float(model.qpos0[joint.qposadr[0]]) for joint in (follower, leader))
        written[follower.name] = Mimic(leader.name, float(b), here + float(a) - float(b) * there)
    return by_their_leaders(written, lambda _: str(source))
