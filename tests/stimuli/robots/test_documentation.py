"""The robot shown in docs/robots.md works as it is written there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from stimuli.gestures import read_gesture
from stimuli.rendering import Renderer
from stimuli.robots import load_robot

TEXT = (Path(__file__).parents[3] / "docs" / "robots.md").read_text(encoding="utf-8")


def test_the_lamp_of_the_documentation_is_drawn_and_moves(tmp_path: Path) -> None:
    (model,) = re.findall(r"^```xml\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    _, facts = re.findall(r"^```yaml\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
    (tmp_path / "lamp.urdf").write_text(model, encoding="utf-8")
    (tmp_path / "lamp.yaml").write_text(facts, encoding="utf-8")
    robot = load_robot("lamp.yaml", tmp_path)
    assert {joint.name: joint.max_velocity for joint in robot.joints} == {"lean": 2.0, "nod": 3.0}
    gesture = tmp_path / "nod.yaml"
    gesture.write_text("gesture: nod\nunit: deg\nduration: 2 s\njoints: {nod: {0: home, 1: 50, 2: home}}\n")
    shown = read_gesture(gesture, robot)
    with Renderer(robot, width=96, height=96, camera="full_body") as renderer:
        poses = [dict(zip(shown.joints, shown.positions[at].tolist(), strict=True)) for at in (0, 100)]
        before, after = (renderer.frame(pose).astype(int) for pose in poses)
    assert np.abs(before - after).max() > 50
    assert (before[..., 0] - before[..., 2]).max() > 50  # the orange shade
    assert before[-1].min() > 100  # all of the dark foot is in the picture
