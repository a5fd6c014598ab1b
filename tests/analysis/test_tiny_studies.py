"""Whole analyses of tiny studies, whatever was answered: each number is finite, or null beside a reason."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.dataset import read_responses
from analysis.further import look_further
from analysis.plan import carry_out
from analysis.report import tables
from analysis.results import Provenance, Results
from analysis.web import html
from analysis.words import sentences
from study.protocol import Protocol, load_protocol
from tests.analysis.conftest import PAPER
from tests.analysis.test_hypotheses import MORE, with_hypotheses

PROTOCOLS = PAPER.parent


@pytest.fixture(scope="module")
def studies(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Protocol]:
    """The paper's study with every kind of test, and one of groups."""
    folder = tmp_path_factory.mktemp("protocol")
    text = (PROTOCOLS / "godspeed" / "protocol.yaml").read_text(encoding="utf-8")
    (folder / "groups.yaml").write_text(
        text.replace("straight_lining: true", "incomplete: false"), encoding="utf-8"
    )
    paper = with_hypotheses(folder, MORE).path
    smaller = {
        "participants: {planned: 36}": "participants: {planned: 36, exclude: {incomplete: false}}",
        "[joy, sadness, anger, fear, shame, hurry]": "[joy, fear]",
        "levels: [arc, ant, time, exa, sec, follow]": "levels: [arc]",
    }
    source = paper.read_text(encoding="utf-8")
    for whole, part in smaller.items():
        source = source.replace(whole, part)
    paper.write_text(source, encoding="utf-8")
    return {"paper": load_protocol(paper), "groups": load_protocol(folder / "groups.yaml")}


@st.composite
def answers(draw: st.DrawFn, protocol: Protocol) -> list[tuple[str, str, str, str, str]]:
    """Rows of up to five people who use one, two or all of the options, and leave out some, many or none."""
    rng = draw(st.randoms(use_true_random=False))
    options = draw(st.sampled_from([1, 2, 9]))
    kept = draw(st.sampled_from([1.0, 0.8, 0.3]))
    rows = []
    for person in range(draw(st.integers(1, 5))):
        for part in protocol.parts.values():
            shown = rng.sample(part.stimuli, part.shown or len(part.stimuli))
            for trial, stimulus in enumerate(shown, 1):
                for question in part.questions:
                    used = list(question.values or ("",))[-options:]
                    rows += [
                        (f"P{person}", str(trial), stimulus, item, rng.choice(used))
                        for item in question.items
                        if rng.random() < kept
                    ]
    return rows


def numbers(value: Any, path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every object in a JSON value with its place."""
    if isinstance(value, dict):
        yield path, value
        for key, inner in value.items():
            yield from numbers(inner, f"{path}/{key}")
    elif isinstance(value, list):
        for place, inner in enumerate(value):
            yield from numbers(inner, f"{path}/{place}")


@pytest.mark.parametrize("study", ["paper", "groups"])
@settings(max_examples=8)
@given(data=st.data())
def test_every_number_is_finite_or_null_beside_a_reason(
    studies: dict[str, Protocol], tmp_path_factory: pytest.TempPathFactory, study: str, data: st.DataObject
) -> None:
    protocol = studies[study]
    path = tmp_path_factory.getbasetemp() / f"{study}.csv"
    rows = data.draw(answers(protocol))
    path.write_text(
        "participant,trial,stimulus,item,response\n" + "".join(",".join(row) + "\n" for row in rows),
        encoding="utf-8",
    )
    responses = read_responses(path, protocol)
    findings = carry_out(responses, protocol)
    results = Results(findings, Provenance("s", "p", "r", {}), look_further(findings, responses, protocol))
    written = json.loads(json.dumps(results.as_json(), allow_nan=False))
    for place, found in numbers(written):
        for name, value in found.items():
            if name == "p" or name.startswith("p_"):
                assert value is None or 0 < value <= 1, (place, name, value)
        if "p" in found and found["p"] is None:
            assert found.get("reason") or found.get("note"), (place, found)
    said = "".join([*tables(findings).values(), html(results, protocol, {}, {})])
    said += "".join(line for outcome in findings.outcomes.values() for line in sentences(outcome).values())
    assert not {"nan", "inf", "None", "p = .000", "p = 0"} & set(
        said.replace(",", " ").replace("<", " ").split()
    )
