"""The preregistration says everything a reader needs to hold the authors to it."""

from pathlib import Path

import pytest

from study.preregister import preregister
from study.protocol import load_protocol
from study.specs import specs
from study.words import stated

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
    assert (
        "rated above chance (3, the middle of the scale from 1 to 5) on the item it is meant to" in document
    )
    assert "“higher” is chosen more often for *high* than for *low* of the same principle" in document
    assert (
        "- **H2.1**: Student's t-test of independent samples (one-sided, greater) of the answer “higher” "
        in (document)
    )
    assert "it then closes itself: nobody else may begin" in document
    assert "exactly after every 6 participants" in document
    assert "the blocks by a Williams design" in document


def test_orders_that_are_drawn_for_each_are_not_called_balanced():
    document = preregister(load_protocol(Path(__file__).parents[2] / "protocols" / "online"))
    assert "balanced is so exactly" not in document and "after every 1 " not in document


@pytest.mark.parametrize(
    ("against", "said"),
    [
        ("midpoint", "(3, the middle of the scale from 1 to 5)"),
        ("2.5", "above chance (2.5)"),
        ("other items", "(the mean rating of the other items for the same stimulus)"),
        ("equal share", "(1/6, an equal share of the points given to the stimulus)"),
    ],
)
def test_the_chance_level_is_named(tmp_path, against, said):
    paper = Path(__file__).parents[2] / "protocols" / "hielscher2025" / "protocol.yaml"
    text = paper.read_text(encoding="utf-8").replace("against: midpoint", f"against: {against}")
    (tmp_path / "protocol.yaml").write_text(text, encoding="utf-8")
    protocol = load_protocol(tmp_path)
    assert said in stated(protocol, protocol.analysis.hypotheses["H1"])
