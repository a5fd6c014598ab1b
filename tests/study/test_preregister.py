"""The preregistration says everything a reader needs to hold the authors to it."""

from pathlib import Path

import pytest

from study.preregister import preregister
from study.protocol import load_protocol
from study.specs import specs

PROTOCOLS = sorted((Path(__file__).parents[2] / "protocols").glob("*/protocol.yaml"))


@pytest.mark.parametrize("path", PROTOCOLS, ids=lambda path: path.parent.name)
def test_every_hypothesis_stimulus_and_rule_is_written_down(path):
    protocol = load_protocol(path)
    document = preregister(protocol)
    assert protocol.sha256 in document
    for name in protocol.analysis.hypotheses:
        assert document.count(f"**{name}") == 2  # stated, and how it is tested
    for stimulus, spec in specs(protocol).items():
        assert f"| `{stimulus}` |" in document
        assert spec.sha256[:16] in document
    assert f"until {protocol.participants.planned} participants" in document
    assert "{" not in document
    assert "None" not in document


def test_hypotheses_are_stated_in_words():
    document = preregister(load_protocol(Path(__file__).parents[2] / "protocols" / "hielscher2025"))
    assert "each stimulus is rated above chance on its target item" in document
    assert "“higher” is chosen more often for high than for low intensity" in document
    assert "the blocks by a Williams design" in document
