"""Whatever was answered or not: every number is finite or null with a reason, and the report is written."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.dataset import read_responses
from analysis.further import look_further
from analysis.plan import carry_out
from analysis.report import analyse
from analysis.results import Provenance, Results
from study.protocol import Exclusions, Protocol
from tests.analysis.conftest import Row, Write, choices, ratings

CONSTANT = [(p, s, i, "5") for p, s, i, _ in ratings(n=6)] + [
    (p, s, i, "higher") for p, s, i, _ in choices(n=6)
]
CASES: dict[str, list[Row]] = {
    "no answers": [],
    "one participant": [*ratings(n=1), *choices(n=1)],
    "two participants": [*ratings(n=2), *choices(n=2)],
    "everyone answers the same": CONSTANT,
    "every second answer missing": [*ratings(n=8), *choices(n=8)][::2],
    "one clip nobody rated": [row for row in [*ratings(n=9), *choices(n=9)] if row[1] != "fear"],
}


def everyone(protocol: Protocol) -> Protocol:
    """The study without exclusions."""
    kept = protocol.participants.model_copy(update={"exclude": Exclusions(incomplete=False)})
    copy = protocol.model_copy(update={"participants": kept})
    copy._source = protocol._source
    return copy


@pytest.mark.parametrize("case", CASES)
def test_degenerate_responses_give_a_whole_report(
    case: str, paper: Protocol, write: Write, tmp_path: Path
) -> None:
    analyse(write(CASES[case]), everyone(paper), tmp_path)
    text = (tmp_path / "results.json").read_text(encoding="utf-8")
    assert "NaN" not in text and "Infinity" not in text
    for part in ("recognition", "intensity"):
        for found in json.loads(text)[part].values():
            test = found["t_test" if part == "recognition" else "student"]
            assert (test["p"] is None) == ("reason" in test)
            assert test["p"] is None or 0 < test["p"] <= 1
    assert "nan" not in (tmp_path / "tables" / "recognition.csv").read_text(encoding="utf-8")


@settings(max_examples=5)
@given(st.integers(0, 2**20), st.integers(1, 12), st.floats(0, 1))
def test_any_holes_in_the_data_leave_strict_json(
    paper: Protocol, tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, kept: float
) -> None:
    rng = random.Random(seed)
    rows = [row for row in [*ratings(n, seed), *choices(n)] if rng.random() < kept]
    path = tmp_path_factory.mktemp("holes") / "r.csv"
    path.write_text(
        "participant,stimulus,item,response\n" + "".join(",".join(row) + "\n" for row in rows),
        encoding="utf-8",
    )
    responses = read_responses(path, paper)
    findings = carry_out(responses, everyone(paper))
    results = Results(findings, Provenance("s", "p", "r", {}), look_further(findings, responses, paper))
    json.dumps(results.as_json(), allow_nan=False)


def test_participants_are_left_out_by_the_declared_rules_and_named(paper: Protocol, write: Write) -> None:
    rows = [row for row in [*ratings(n=6), *choices(n=6)] if row[:3] != ("P02", "fear", "joy")]
    flat = [(p, s, i, "3" if p == "P04" and i in {"joy", "sadness", "anger", "fear", "shame", "hurry"} else r)
            for p, s, i, r in rows]  # fmt: skip
    rules = paper.participants.model_copy(
        update={"exclude": Exclusions(incomplete=True, straight_lining=True)}
    )
    protocol = paper.model_copy(update={"participants": rules})
    flow = carry_out(read_responses(write(flat), paper), protocol).flow
    assert (flow.answered, flow.analysed) == (6, 4)
    assert {one.participant: one.rule for one in flow.excluded} == {
        "P02": "incomplete",
        "P04": "same answer throughout a part",
    }


def test_the_fast_are_left_out_by_their_median_time(paper: Protocol, tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    rows = [*ratings(n=3), *choices(n=3)]
    path.write_text(
        "participant,stimulus,item,response,rt_ms\n"
        + "".join(f"{','.join(row)},{200 if row[0] == 'P01' else 2000}\n" for row in rows),
        encoding="utf-8",
    )
    rules = paper.participants.model_copy(update={"exclude": Exclusions(faster_than="0.5 s")})
    flow = carry_out(read_responses(path, paper), paper.model_copy(update={"participants": rules})).flow
    assert [one.participant for one in flow.excluded] == ["P01"]
