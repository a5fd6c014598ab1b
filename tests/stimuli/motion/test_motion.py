"""From the description of a stimulus to a motion the robot can do, and its relations."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from stimuli.dmp import Learning, Primitive
from stimuli.errors import InputError
from stimuli.feasibility import TOLERANCE, in_short, violations
from stimuli.kinematics import link_poses
from stimuli.motion import generate, learn
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.relations import found, relations_of
from stimuli.robots.model import Relation
from stimuli.spec import StimulusSpec, Video

GESTURE = """
gesture: lift
unit: rad
duration: 2.0 s
joints:
  Hip: {0.0: home, 0.9: 0.6, 2.0: home}
  Shoulder: {0.0: home, 0.5: 1.5, 1.0: 2.0, 1.4: 1.8, 2.0: home}
"""


@pytest.fixture
def spec(tmp_path):
    path = tmp_path / "lift.yaml"
    path.write_text(GESTURE)

    def make(**modulation) -> StimulusSpec:
        return StimulusSpec(
            id="lift_high", robot="toy", robot_sha256="", gesture=path, gesture_sha256="",
            modulation=Modulation.model_validate(modulation), learning=Learning(), video=Video(),
        )  # fmt: skip

    return make


def test_a_motion_too_short_to_tell_its_speed_is_refused(spec, robot):
    with pytest.raises(
        InputError, match=r"^lift_high: lasts 0\.002 s, less than 10 steps of 0\.01 s; take a larger time"
    ):
        generate(spec(time=0.001), robot)
    with pytest.raises(InputError, match=r"^lift_high: ant\.intensity: 5"):
        generate(spec(ant={"intensity": 5}), robot)


def test_a_plain_stimulus_moves_as_demonstrated(spec, robot):
    motion = generate(spec(), robot)
    assert motion.trajectory.duration_s == pytest.approx(2.0, abs=0.2)
    shown = motion.demonstration
    assert np.abs(motion.trajectory.at(shown.times) - shown.positions).max() < 2e-3
    assert motion.margins["Shoulder"]["position"] == pytest.approx(1.0, abs=1e-2)
    assert 0.9 < motion.margins["Shoulder"]["velocity"] < 1


def test_a_gesture_learned_once_moves_as_one_learned_anew(spec, robot):
    wanted = spec(exa=1.2, time=0.9)
    anew = generate(wanted, robot)
    lesson = learn(wanted.gesture, robot, wanted.learning)
    wanted.gesture.unlink()
    np.testing.assert_array_equal(
        generate(wanted, robot, lesson).trajectory.positions, anew.trajectory.positions
    )


@pytest.mark.parametrize(
    ("modulation", "named"),
    [({"exa": 2}, "exa.intensity"), ({"goal": {"Hip": 0.5}, "exa": 2}, "exa.intensity")],
)
def test_what_the_robot_cannot_do_is_refused_with_the_largest_intensity_that_fits(
    modulation, named, spec, robot
):
    with pytest.raises(
        InputError, match=r"lift_high: Shoulder at 1\.\d+ s: position 3\.\d+ rad, limit 3"
    ) as error:
        generate(spec(**modulation), robot)
    fits = float(str(error.value).split(f"{named} ")[1].rstrip("."))
    assert 1.4 < fits < 1.6
    generate(spec(**{**modulation, "exa": fits - 0.005}), robot)
    with pytest.raises(InputError):
        generate(spec(**{**modulation, "exa": fits + 0.01}), robot)


def test_of_many_limits_exceeded_the_worst_are_named_and_the_others_counted(robot, demonstrate):
    joints = tuple(replace(joint, lower=0.0, upper=0.4, max_velocity=0.5) for joint in robot.joints)
    exceeded = violations(demonstrate(3), replace(robot, joints=joints))
    told = in_short(exceeded)
    assert told.startswith(str(max(exceeded, key=lambda violation: violation.excess)))
    assert told.count(" at ") == 4
    assert told.endswith(f"; and {len(exceeded) - 4} more limits exceeded")
    hand = next(one for one in exceeded if (one.joint, one.quantity) == ("Hand", "position"))
    assert f"position {hand.value:.4g}, limit {hand.limit:g}" in str(hand)  # no unit


def test_too_fast_is_refused_too(spec, robot):
    joints = tuple(replace(joint, max_velocity=6.0) for joint in robot.joints)
    slow = replace(robot, joints=joints)
    generate(spec(), slow)
    with pytest.raises(
        InputError, match=r"Shoulder at .* velocity .* rad/s, limit -?6\. It would fit with time"
    ):
        generate(spec(time=0.5), slow)


def test_a_motion_too_fast_may_be_asked_to_last_longer(spec, robot):
    joints = tuple(replace(joint, max_velocity=6.0) for joint in robot.joints)
    slow = replace(robot, joints=joints)
    motion = generate(spec(time={"intensity": 0.5, "fit": "scale"}), slow)
    used = motion.modulation["time"].intensity
    assert 0.5 < used < 1
    generate(spec(time=used + 1e-3), slow)
    with pytest.raises(InputError):
        generate(spec(time=used - 1e-2), slow)
    at_ease = generate(spec(time={"intensity": 1.5, "fit": "scale"}), slow)
    assert at_ease.modulation == spec(time={"intensity": 1.5, "fit": "scale"}).modulation
    with pytest.raises(InputError, match=r"Shoulder at .* position"):  # no duration helps there
        generate(spec(exa=2, time={"intensity": 0.5, "fit": "scale"}), slow)


def test_the_largest_intensity_is_exact_where_motions_are_affine_in_it(spec, robot):
    with pytest.raises(InputError) as error:
        generate(spec(exa=2), robot)
    shoulder = robot.joint("Shoulder")
    primitive = Primitive.learn(generate(spec(), robot).demonstration)
    one, two = (
        primitive.rollout(Modulation.model_validate({"exa": p}), robot).joint("Shoulder").max()
        for p in (1, 2)
    )
    exact = 1 + (shoulder.upper + TOLERANCE * shoulder.range - one) / (two - one)
    told = float(str(error.value).split("exa.intensity ")[1].rstrip("."))
    assert 0 <= exact - told < 0.01  # three digits, rounded towards neutral


def test_where_no_single_intensity_fits_all_of_them_together_are_advised(spec, robot):
    wild = {"exa": 2.5, "goal": {"Shoulder": 3.5}}
    with pytest.raises(InputError, match=r"No single intensity makes it fit; all of them would") as error:
        generate(spec(**wild), robot)
    exa, goal = (
        float(str(error.value).split(f"{kind}.intensity ")[1].split(",")[0].rstrip("."))
        for kind in ("exa", "goal")
    )
    generate(spec(exa=exa - 0.01, goal={"Shoulder": 3.5, "intensity": goal - 0.01}), robot)


@pytest.mark.parametrize(
    "wanted",
    [
        {"exa": 2},
        {"rand": 9},
        {"goal": {"Shoulder": 7}},
        {"exa": 2, "time": 0.9},
        {"ant": {"dip": 6.0, "form": "mirror"}},
        {"sec": 3},
    ],
    ids=str,
)
def test_what_is_advised_fits_as_it_is_written_and_no_more_does(wanted, spec, robot):
    narrow = replace(robot, joints=tuple(replace(joint, lower=-1.5, upper=2.3) for joint in robot.joints))
    with pytest.raises(InputError) as error:
        generate(spec(**wanted), narrow)
    advised = re.findall(r"(?:with|or) (\w+)\.(\w+) ([-\d.e]+\d)", str(error.value))
    assert advised, error.value

    def turned(kind: str, dial: str, value: float) -> dict:
        written = wanted[kind] if isinstance(wanted[kind], dict) else {}
        return {**wanted, kind: {**written, dial: value}}

    for kind, dial, told in advised:
        neutral = PRINCIPLES[kind].neutral if dial == "intensity" else 0.0
        value = float(told)
        generate(spec(**turned(kind, dial, value)), narrow)
        with pytest.raises(InputError):
            generate(spec(**turned(kind, dial, value + 0.02 * np.copysign(value, value - neutral))), narrow)


def test_advice_that_would_not_do_is_not_given(spec, robot):
    """A progression stays what it is at every intensity; a gesture out of bounds is not saved by any."""
    quick = replace(robot, joints=tuple(replace(joint, max_velocity=6.0) for joint in robot.joints))
    with pytest.raises(InputError, match=r"No intensity makes it fit; it would fit without time\."):
        generate(spec(time={"progression": [1, 1, 1, 30], "intensity": 1.0}, ant=0.05), quick)
    weak = replace(robot, joints=tuple(replace(joint, max_acceleration=1.0) for joint in robot.joints))
    with pytest.raises(InputError, match=r"The gesture itself does not fit, .*: Shoulder at .* acceleration"):
        generate(spec(time=0.9), weak)


@pytest.mark.parametrize("form", ["literal", "mirror"])
@pytest.mark.parametrize("dip", ["4 deg", 0.2])
def test_anticipation_dips_as_far_as_wanted(form, dip, spec, robot):
    written = {"dip": dip, "form": form, "count": 2}
    plain, dipped = (generate(spec(**ant), robot).trajectory for ant in ({}, {"ant": written}))
    for name in ("Hip", "Shoulder"):
        assert plain.joint(name).min() > 0.099  # both go up from there
        wanted = np.radians(4) if dip == "4 deg" else dip
        assert 0.1 - dipped.joint(name).min() == pytest.approx(wanted, rel=0.02)
    modulation = Modulation.model_validate({"ant": written})
    assert Modulation.model_validate_json(modulation.model_dump_json()) == modulation


def test_a_dip_is_refused_where_it_cannot_be_or_is_one_too_many(robot, demonstrate):
    primitive = Primitive.learn(demonstrate(5))
    with pytest.raises(InputError, match=r"ant\.dip: \w+ dips by at most"):
        primitive.course(Modulation.model_validate({"ant": {"dip": 500}}), robot)
    with pytest.raises(ValueError, match=r"ant\.dip: is given besides"):
        Modulation.model_validate({"ant": {"dip": 0.1, "intensity": 0.2}})


def test_the_growth_of_an_anticipation_stands_among_the_margins(spec, robot):
    motion = generate(spec(ant=0.2), robot)
    grown = {
        name: left["anticipation_growth"]
        for name, left in motion.margins.items()
        if "anticipation_growth" in left
    }
    assert grown == {"Shoulder": pytest.approx(np.exp(25 * (0.2 + np.sqrt(0.24)) * 0.075))}


def test_a_demonstration_out_of_range_is_named_as_such(spec, robot):
    exact, narrow = (
        replace(robot, joints=tuple(replace(joint, upper=upper) for joint in robot.joints))
        for upper in (2, 1.9)
    )
    assert not violations(generate(spec(), exact).trajectory, exact)  # what learning misses is tolerated
    with pytest.raises(
        InputError, match=r"joints\.Shoulder: 2 at 1 s is outside the joint's range, -3 to 1\.9 rad"
    ):
        generate(spec(), narrow)
    table = spec().gesture.with_suffix(".csv")
    table.write_text("time,Shoulder\n0,0.1\n0.5,1\n1,2\n1.5,1\n2,0.1\n")
    with pytest.raises(
        InputError, match=r"lift\.csv: the demonstration itself exceeds .* Shoulder at 1\.00 s"
    ):
        generate(spec().model_copy(update={"gesture": table}), narrow)


def test_relations_follow_from_the_tree(robot):
    first, *gated = found(robot)
    assert first == Relation("Hip", "Waist", -1)
    assert [(one.source, one.target, one.sign) for one in gated] == [
        ("Waist", "Elbow", s) for s in (1, -1, 1)
    ]
    middle = gated[1].while_[0]
    assert middle.joint == "Shoulder"
    assert [middle.lower, middle.upper] == pytest.approx(np.radians([-30, 30]), abs=0.01)
    assert gated[0].while_[0].upper == pytest.approx(np.radians(-150), abs=0.01)
    assert np.isinf(gated[0].while_[0].lower)
    own = (Relation("Waist", "Elbow", 1), Relation("Hip", "Waist", 1))
    assert relations_of(replace(robot, relations=own), robot.joint_names) == own[::-1]
    assert relations_of(robot, ("Hip", "Elbow")) == ()
    circle = (Relation("Waist", "Elbow", 1), Relation("Elbow", "Waist", 1))
    with pytest.raises(InputError, match="toy: relations form a cycle"):
        relations_of(replace(robot, relations=circle), robot.joint_names)


def test_kinematics_place_the_links(robot):
    upright = dict.fromkeys(robot.joint_names, 0.0)
    assert link_poses(robot.joints, upright)["forearm"][:3, 3] == pytest.approx([0, 0, 1.2])
    bent = link_poses(robot.joints, upright | {"Hip": np.array([0.0, np.pi / 2])})["forearm"]
    assert bent[:, :3, 3] == pytest.approx(np.array([[0, 0, 1.2], [0.9, 0, 0.3]]))
