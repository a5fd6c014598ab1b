"""Relations that hold while joints between are within limits."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stimuli.dmp import Primitive
from stimuli.errors import InputError
from stimuli.kinematics import axes
from stimuli.principles import Modulation
from stimuli.relations import ALIGNED_RAD, described, found, in_short, relations_of
from stimuli.robots import ROBOTS, load_robot
from stimuli.robots.model import Relation, Within
from stimuli.rollout import integrate

FOLLOW = Modulation.model_validate({"follow": 3})
SEC = Modulation.model_validate({"sec": 0.15})
STATE = Modulation.model_validate({"sec": {"intensity": 0.05, "form": "state"}})


def with_shoulder(robot, lower, upper):
    """The robot with one relation, from waist to elbow while the shoulder is there."""
    return replace(robot, relations=(Relation("Waist", "Elbow", -1, (Within("Shoulder", lower, upper),)),))


@pytest.mark.parametrize("modulation", [FOLLOW, SEC, STATE], ids=["follow", "sec", "sec state"])
def test_a_gate_that_stays_open_is_no_gate_and_one_that_stays_closed_no_relation(
    modulation, robot, demonstrate
):
    primitive = Primitive.learn(demonstrate(2))

    def moved(relations, by=modulation):
        return integrate(primitive.course(by, replace(robot, relations=relations)), 0.01, 400)[0]

    gated, closed = (with_shoulder(robot, *limits).relations for limits in ((-9, 9), (5, 9)))
    always = (Relation("Waist", "Elbow", -1),)
    assert np.abs(moved(gated) - moved(always)).max() < 1e-11
    assert np.abs(moved(closed) - moved(closed, Modulation())).max() < 1e-11
    assert np.abs(moved(always) - moved(closed)).max() > 0.01


@pytest.mark.parametrize("modulation", [FOLLOW, SEC, STATE], ids=["follow", "sec", "sec state"])
def test_a_gate_that_opens_and_closes_under_way_makes_no_jump(modulation, robot, demonstrate):
    shown = demonstrate(2)
    shoulder = shown.joint("Shoulder")
    halfway = with_shoulder(robot, shoulder.min() - 1, (shoulder.min() + shoulder.max()) / 2)
    course = Primitive.learn(shown).course(modulation, halfway)
    always = replace(course, relations=(Relation("Waist", "Elbow", -1),))
    changes = []
    for each in (
        course,
        Primitive.learn(shown).course(modulation, replace(halfway, relations=always.relations)),
    ):
        velocity = np.diff(integrate(each, 0.001, 3500)[0], axis=0) / 0.001
        changes.append(np.abs(np.diff(velocity, axis=0)).max())
    assert changes[0] < 3 * changes[1]  # as smooth as without a gate


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_found_relations_hold_where_they_say_the_axes_are_aligned(name):
    robot = load_robot(name, Path())
    rng = np.random.default_rng(0)
    for relation in found(robot):
        pose = dict(robot.home)
        if len(relation.while_) == 1:  # alone, a joint may be anywhere within its limits
            (within,) = relation.while_
            joint = robot.joint(within.joint)
            pose[joint.name] = rng.uniform(max(within.lower, joint.lower), min(within.upper, joint.upper))
        elif relation.while_:
            continue
        directions = axes(robot.joints, pose)
        cosine = relation.sign * np.dot(directions[relation.source], directions[relation.target])
        assert cosine >= np.cos(ALIGNED_RAD) - 1e-6, described(relation, robot)


def test_the_elbow_of_pepper_follows_the_shoulder_that_its_upper_arm_lets_through():
    pepper = load_robot("pepper", Path())
    listed = [described(relation, pepper) for relation in relations_of(pepper, pepper.joint_names)]
    assert "HipPitch -> RShoulderPitch (opposed)" in listed
    assert "RShoulderRoll -> RElbowRoll while RElbowYaw -29…29 deg" in listed
    assert (
        "RShoulderPitch -> RElbowRoll (opposed) while RShoulderRoll > -30 deg and RElbowYaw > 62 deg"
        in listed
    )


def test_relations_on_one_line_show_their_signs_and_what_they_depend_on(robot):
    assert in_short(found(robot)) == (
        "Hip -> -Waist; Waist -> ±Elbow [Shoulder] ([…]: while these are within limits)"
    )
    assert in_short(()) == "no joint drives another"


def test_a_joint_that_opens_a_gate_is_carried_out_before_it(robot):
    ring = (
        Relation("Waist", "Elbow", 1, (Within("Shoulder", -1, 1),)),
        Relation("Elbow", "Shoulder", 1),
    )
    with pytest.raises(InputError, match="cycle"):
        relations_of(replace(robot, relations=ring), robot.joint_names)
    in_line = (ring[0], Relation("Hip", "Shoulder", 1))
    assert relations_of(replace(robot, relations=in_line), robot.joint_names) == in_line[::-1]
