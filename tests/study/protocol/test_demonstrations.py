"""The paper's robot demonstrations: three robots in one protocol, each gesture shown by its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from stimuli.motion import generate
from stimuli.robots import load_robot
from study.check import check
from study.protocol import load_protocol
from study.specs import specs

FOLDER = Path(__file__).parents[3] / "protocols" / "demonstrations"


def test_every_robot_can_do_its_demonstrations_and_arrives() -> None:
    protocol = load_protocol(FOLDER)
    robots = {name: load_robot(name, FOLDER) for name in protocol.robots}
    assert protocol.robots == ("pepper", "daryl", "iiwa14")
    for stimulus, spec in specs(protocol).items():
        motion = generate(spec, robots[spec.robot])
        shown, goal = motion.trajectory.positions, motion.demonstration.positions[-1]
        if not {"goal", "rand"} & {principle.kind for principle in spec.modulation.principles}:
            reach = np.ptp(shown, axis=0).max()
            np.testing.assert_allclose(shown[-1], goal, atol=0.02 * reach, err_msg=stimulus)
        if stimulus != "daryl_rest_neutral":
            assert np.ptp(shown, axis=0).max() > 0.015, stimulus


def test_the_head_heads_elsewhere_while_it_nods() -> None:
    spec = specs(load_protocol(FOLDER))["nod_goal_moves"]
    trajectory = generate(spec, load_robot("pepper", FOLDER)).trajectory
    yaw = np.degrees(trajectory.joint("HeadYaw"))
    assert np.abs(yaw[trajectory.times < 0.4]).max() < 5
    assert yaw.max() > 20
    assert abs(yaw[-1] + 24) < 1


def test_the_arm_goes_behind_the_body_before_it_is_raised() -> None:
    spec = specs(load_protocol(FOLDER))["arm_raise_anticipation"]
    pitch = np.degrees(generate(spec, load_robot("pepper", FOLDER)).trajectory.joint("RShoulderPitch"))
    assert pitch.max() > pitch[0] + 20
    assert pitch.argmax() < pitch.argmin()


def test_a_robot_nobody_knows_is_named_at_the_gesture_that_asks_for_it(tmp_path: Path) -> None:
    text = (FOLDER / "protocol.yaml").read_text(encoding="utf-8")
    (tmp_path / "protocol.yaml").write_text(text.replace("robot: iiwa14", "robot: iiwa15"), encoding="utf-8")
    report = check(load_protocol(tmp_path))
    assert not report.good
    assert "gestures.jagged.robot: 'iiwa15' is not a robot; did you mean iiwa14?" in str(report)
