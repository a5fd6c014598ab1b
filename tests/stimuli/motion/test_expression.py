"""Six expressions show as sources or we say, levels differ, and gestures are like real ones; docs agree."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from stimuli.descriptors import DESCRIPTORS, describe
from stimuli.dmp import Primitive
from stimuli.emotions import DEPARTED_FROM, FINDINGS, SOURCES, change, emotions_as_markdown
from stimuli.feasibility import violations
from stimuli.gestures import read_gesture
from stimuli.principles import Modulation
from stimuli.recordings import MEASURED, gestures_as_markdown, recorded_range, rests
from stimuli.robots import load_robot

STUDY = Path("protocols/hielscher2025")
PROTOCOL = yaml.safe_load((STUDY / "protocol.yaml").read_text())
GESTURES = sorted([*STUDY.glob("gestures/*.yaml"), *Path("protocols/demonstrations/gestures").glob("*.yaml")])


@pytest.fixture(scope="module")
def pepper():
    return load_robot("pepper", Path())


@pytest.fixture(scope="module")
def shown(pepper):
    """Authored gestures of Pepper by name."""
    ours = [path for path in GESTURES if "robot: pepper" in path.read_text()]
    return {path.stem: read_gesture(path, pepper) for path in ours}


@pytest.fixture(scope="module")
def expressions(pepper, shown):
    """Descriptors of the explaining gesture, neutral and under each modulation of the study."""
    primitive = Primitive.learn(shown["explain"])
    return {
        name: describe(primitive.rollout(Modulation.model_validate(written), pepper), pepper)
        for name, written in {"neutral": {}, **PROTOCOL["modulations"]}.items()
    }


@pytest.mark.parametrize("finding", FINDINGS, ids=lambda f: f"{f.emotion}-{f.descriptor}")
def test_an_expression_moves_as_is_said(finding, expressions):
    assert change(finding, expressions) > 0.05 * abs(expressions["neutral"][finding.descriptor])
    assert set(finding.sources) <= set(SOURCES)


@pytest.mark.parametrize("finding", DEPARTED_FROM, ids=lambda f: f"{f.emotion}-{f.descriptor}")
def test_what_is_said_not_to_be_followed_is_not(finding, expressions):
    assert change(finding, expressions) < 0
    assert finding not in FINDINGS


def test_every_expression_is_defended():
    assert {finding.emotion for finding in FINDINGS} == set(PROTOCOL["modulations"])


@pytest.mark.parametrize("kind", ["ant", "sec", "follow"])
def test_a_higher_level_is_further_from_neutral_and_the_robot_can_do_it(kind, pepper, shown):
    primitive = Primitive.learn(shown["wave"])
    plain = primitive.rollout(Modulation(), pepper)
    away = []
    for level in PROTOCOL["levels"][kind]:
        moved = primitive.rollout(Modulation.model_validate({kind: level}), pepper)
        assert not violations(moved, pepper)
        away.append(np.abs(moved.at(plain.times) - plain.positions).max())
    assert away[0] > np.radians(3)
    assert np.all(np.diff(away) > np.radians(5))


def test_gestures_are_within_the_range_of_real_ones_and_rest_at_both_ends(pepper, shown):
    for name, gesture in shown.items():
        described = describe(gesture, pepper)
        for descriptor in MEASURED:
            least, most = recorded_range(descriptor)
            assert least <= described[descriptor] <= most, (name, descriptor)
        assert rests(gesture) == (True, True), name


def test_every_descriptor_is_described(expressions):
    assert list(expressions["neutral"]) == list(DESCRIPTORS)


def test_the_documents_say_what_the_motions_do(expressions, pepper, shown):
    """Where this fails after a change, write both files anew, with these two functions."""
    measured = {name: describe(gesture, pepper) for name, gesture in sorted(shown.items())}
    assert Path("docs/emotions.md").read_text() == emotions_as_markdown(expressions)
    assert Path("docs/gestures.md").read_text() == gestures_as_markdown(measured)
