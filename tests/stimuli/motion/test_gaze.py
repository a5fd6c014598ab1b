"""A robot told to look at a point ends looking at it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from stimuli.dmp import Primitive
from stimuli.errors import InputError
from stimuli.gestures import read_gesture
from stimuli.kinematics import link_poses
from stimuli.principles import Modulation
from stimuli.robots import load_robot

WAVE = Path("protocols/hielscher2025/gestures/wave.yaml")


@pytest.mark.parametrize("point", [(1.5, 0.0, 1.2), (1.0, 0.8, 1.4), (2.0, -1.5, 0.9)])
@pytest.mark.parametrize("others", [{}, {"HipPitch": "-15 deg", "HipRoll": "8 deg"}])
def test_pepper_ends_looking_at_the_point(point, others):
    pepper = load_robot("pepper", Path())
    primitive = Primitive.learn(read_gesture(WAVE, pepper))
    written = {"goal": {"look_at": [f"{point[0]} m", *point[1:]], **others}}
    goal = primitive.course(Modulation.model_validate(written), pepper).goal
    head = link_poses(pepper.joints, dict(zip(primitive.joints, goal, strict=True)))["Head"]
    way = np.array(point) - (head[:3, 3] + [0, 0, 0.334])  # the knee's height above the floor
    assert head[:3, 0] == pytest.approx(way / np.linalg.norm(way), abs=1e-6)


def test_what_cannot_be_looked_at_is_refused(robot, demonstrate):
    pepper = load_robot("pepper", Path())
    behind = Modulation.model_validate({"goal": {"look_at": [-1.0, 0.1, 1.0]}})
    with pytest.raises(InputError, match=r"goal\.look_at: .* off, within HeadYaw -120…120 deg, HeadPitch"):
        Primitive.learn(read_gesture(WAVE, pepper)).course(behind, pepper)
    with pytest.raises(InputError, match=r"goal\.look_at: toy has no head"):
        Primitive.learn(demonstrate()).course(behind, robot)
    for bad in ([1, 2], "there", [1, "2 deg", 3]):
        with pytest.raises(ValueError, match=r"goal\.look_at"):
            Modulation.model_validate({"goal": {"look_at": bad}})
