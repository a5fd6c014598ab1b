"""Every example of docs/formats.md is read as the page says, and the defaults it gives are the defaults."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from stimuli.dmp import Learning
from stimuli.ends import EASE_S, MOVING, WINDOW_S
from stimuli.gestures import READERS, read_gesture
from stimuli.robots import load_robot

PAGE = Path("docs/formats.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
SUFFIXES = {"yaml": ".yaml", "csv": ".csv", "xml": ".qianim", "python": ".py"}
GESTURES = BLOCKS[:-1]


@pytest.mark.parametrize(("language", "text"), GESTURES, ids=[language for language, _ in GESTURES])
def test_the_example_of_each_format_is_read(language, text, tmp_path):
    path = tmp_path / f"example{SUFFIXES[language]}"
    path.write_text(text, encoding="utf-8")
    shown = read_gesture(path, load_robot("pepper", Path()))
    assert 0 < shown.duration_s <= 4
    assert np.ptp(shown.positions, axis=0).max() > 0.01


def test_every_format_has_its_example():
    assert {SUFFIXES[language] for language, _ in GESTURES} | {".yml"} == set(READERS)


def test_the_defaults_of_learning_are_as_written():
    language, text = BLOCKS[-1]
    assert language == "yaml"
    written = yaml.safe_load(text)["learning"]
    assert set(written) == set(Learning.model_fields)
    assert Learning.model_validate(written) == Learning()
    assert (EASE_S, MOVING, WINDOW_S) == (0.2, 0.05, 0.1)
