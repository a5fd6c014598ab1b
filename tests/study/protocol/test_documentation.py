"""Every example in docs/protocol.md is a piece of a protocol that loads, is ordered and is answered."""

import random
import re
from pathlib import Path

import pytest
import yaml

from study.orders import draw_plan

DOCS = Path(__file__).parents[3] / "docs" / "protocol.md"
EXAMPLES = re.findall(r"```yaml\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
REST = """
study: example
title: Example
contact: a@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
parts:
  only:
    title: Only
    stimuli: {gesture: wave, modulations: [neutral]}
    ask:
      - attention: {text: Choose b, options: [a, b], expected: b}
      - attention: {item: again, text: Choose a, options: [a, b], expected: a}
participants: {planned: 2}
"""


def test_the_page_has_its_examples():
    assert len(EXAMPLES) >= 9


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.split(":")[0][:20].strip("# "))
def test_the_example_runs(example, load):
    fields = yaml.load(example, Loader=yaml.CSafeLoader).keys()
    rest = {name: value for name, value in yaml.safe_load(REST).items() if name not in fields}
    protocol = load(example + yaml.safe_dump(rest, allow_unicode=True))
    rng = random.Random(1)
    for slot in range(3):
        for trial in draw_plan(protocol, slot).trials:
            for question in protocol.parts[trial.part].questions:
                question.check(question.simulate(rng))
