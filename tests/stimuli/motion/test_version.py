"""A motion that changes must change its name, or clips of the old motion would pass for the new."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from stimuli.dmp import Learning, Primitive
from stimuli.gestures import read_gesture
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.robots import load_robot
from stimuli.spec import MOTION

GESTURE = """\
gesture: point
robot: pepper
title: {en: Point}
unit: deg
duration: 2 s
joints:
  RShoulderPitch: {0: home, 0.8: 20, 2: 30}
  RElbowRoll: {0: home, 1.2: 20, 2: home}
  HeadPitch: {0: home, 1: 10, 2: home}
"""
KNOWN = (
    "motion/3",
    {  # principle: duration (s), norm of the pose at 0.4 of it, norm of the mean pose
        "": (2.00, 2.601465, 2.661885),
        "arc": (2.27, 2.603278, 2.659813),
        "rand": (2.22, 2.600745, 2.659744),
        "time": (1.50, 2.601465, 2.662074),
        "slow": (2.10, 2.675116, 2.730064),
        "exa": (2.00, 2.599158, 2.661241),
        "ant": (2.00, 2.601601, 2.667912),
        "follow": (2.31, 2.610247, 2.660006),
        "sec": (2.00, 2.601447, 2.674945),
        "goal": (2.00, 2.614159, 2.672353),
    },
)


def test_the_motion_is_that_of_its_version(tmp_path: Path) -> None:
    """Where nothing was to change, mend the motion; else raise MOTION and write KNOWN anew."""
    (tmp_path / "point.yaml").write_text(GESTURE)
    pepper = load_robot("pepper", Path())
    demonstration = read_gesture(tmp_path / "point.yaml", pepper, Learning().dt_s)
    primitive = Primitive.learn(demonstration, Learning())
    variants = {"": ()} | {name: (kind.example(pepper),) for name, kind in PRINCIPLES.items()}
    seen = {}
    for name, principles in variants.items():
        motion = primitive.rollout(Modulation(principles=principles), pepper)
        middle = motion.at(np.array([0.4 * motion.duration_s]))[0]
        rows = (middle, motion.positions.mean(axis=0))
        seen[name] = [motion.duration_s, *(float(np.linalg.norm(row)) for row in rows)]
    version, known = KNOWN
    assert version == MOTION
    assert seen == {name: pytest.approx(numbers, abs=2e-6) for name, numbers in known.items()}
