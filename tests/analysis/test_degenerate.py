"""Whatever was answered or not: every number is finite or null with a reason, and the report is written."""

from __future__ import annotations

import json
import random
import resource
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.dataset import read_responses
from analysis.further import look_further
from analysis.plan import carry_out
from analysis.report import analyse, tables
from analysis.results import Provenance, Results
from analysis.web import html
from stimuli.errors import InputError
from study.protocol import Exclusions, Protocol, load_protocol
from tests.analysis.conftest import EMOTIONS, PAPER, Row, Write, choices, ratings

CONSTANT = [(p, s, i, "5") for p, s, i, _ in ratings(n=6)] + [
    (p, s, i, "higher") for p, s, i, _ in choices(n=6)
]
CASES: dict[str, list[Row]] = {
    "no answers": [("P1", "joy", "joy", "")],
    "one participant": [*ratings(n=1), *choices(n=1)],
    "two participants": [*ratings(n=2), *choices(n=2)],
    "everyone answers the same": CONSTANT,
    "every second answer missing": [*ratings(n=8), *choices(n=8)][::2],
    "everybody left out": [("P1", "joy", "joy", "4")],
    "one clip nobody rated": [row for row in [*ratings(n=9), *choices(n=9)] if row[1] != "fear"],
}


def everyone(protocol: Protocol) -> Protocol:
    """The study without exclusions."""
    kept = protocol.participants.model_copy(update={"exclude": Exclusions(incomplete=False)})
    copy = protocol.model_copy(update={"participants": kept})
    copy._source = protocol._source
    return copy


@pytest.mark.parametrize("case", CASES)
def test_degenerate_responses_give_every_number_or_a_reason(case: str, paper: Protocol, write: Write) -> None:
    responses = read_responses(write(CASES[case]), paper)
    study = paper if case == "everybody left out" else everyone(paper)
    findings = carry_out(responses, study)
    further = look_further(findings, responses, study)
    results = Results(findings, Provenance("s", "p", "r", {}), further)
    text = json.dumps(results.as_json(), allow_nan=False)
    for part in ("recognition", "intensity"):
        for found in json.loads(text)[part].values():
            test = found["t_test" if part == "recognition" else "student"]
            assert (test["p"] is None) == ("reason" in test)
            assert test["p"] is None or 0 < test["p"] <= 1
    assert "nan" not in "".join(tables(findings).values())
    assert html(results, paper, {}, {}).count("<table>") >= 6


@pytest.mark.parametrize("case", ["no answers", "everyone answers the same"])
def test_degenerate_responses_give_a_whole_report(
    case: str, paper: Protocol, write: Write, tmp_path: Path
) -> None:
    analyse(write(CASES[case]), everyone(paper), tmp_path)
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "figures" / "recognition.svg").exists()
    assert not (tmp_path / "figures" / "effects.svg").exists()  # an axis with nothing on it


def test_a_report_for_which_there_is_no_room_leaves_the_one_before(
    paper: Protocol, write: Write, tmp_path: Path
) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "results.json").write_text("of before")
    least, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, most))
    try:
        with pytest.raises(InputError, match=r"out: could not be written: File too large"):
            analyse(write([*ratings(n=6), *choices(n=6)]), everyone(paper), tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (least, most))
    assert [path.name for path in (tmp_path / "out").rglob("*")] == ["results.json"]
    assert (tmp_path / "out" / "results.json").read_text() == "of before"
    with pytest.raises(InputError, match=r"results.json: could not be written: File exists"):
        analyse(write(ratings(n=2)), everyone(paper), tmp_path / "out" / "results.json")


def test_simulated_answers_are_labelled_in_everything_written(paper: Protocol, tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text(
        "participant,trial,stimulus,item,response,session\n"
        + "".join(
            f"{p},{1 + (int(p[1:]) + place) % 18},{s},{i},{r},simulated\n"
            for place, s in enumerate(paper.stimuli)
            for p, t, i, r in [*ratings(n=5), *choices(n=5)]
            if t == s
        ),
        encoding="utf-8",
    )
    analyse(path, paper, tmp_path)
    note = "Simulated answers, no data"
    assert json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))["data"] == "simulated"
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert f"<title>[{note}]" in report and 'class="nodata" role="note"' in report
    assert "Order and carry-over" in report
    written = [*(tmp_path / "tables").iterdir()]
    assert len(written) == 5
    for file in written:
        assert note in file.read_text(encoding="utf-8"), file
    for figure in (tmp_path / "figures").glob("*.svg"):
        assert note in figure.read_text(encoding="utf-8"), figure


@settings(max_examples=5)
@given(st.integers(0, 2**20), st.integers(1, 12), st.floats(0, 1))
def test_any_holes_in_the_data_leave_strict_json(
    paper: Protocol, tmp_path_factory: pytest.TempPathFactory, seed: int, n: int, kept: float
) -> None:
    rng = random.Random(seed)
    first, *more = [*ratings(n, seed), *choices(n)]
    rows = [first, *(row for row in more if rng.random() < kept)]
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


def test_who_fails_attention_checks_is_left_out_and_the_report_says_what_changed(tmp_path: Path) -> None:
    written = (PAPER / "protocol.yaml").read_text(encoding="utf-8")
    check = "      - attention: {text: Choose no., options: {yes_: Yes, no_: No}, expected: no_}\n"
    written = written.replace("          item_order: fixed\n", "          item_order: fixed\n" + check, 1)
    written = written.replace(
        "participants: {planned: 36}",
        "participants: {planned: 36, exclude: {failed_attention: 2, incomplete: false}}",
    )
    (tmp_path / "protocol.yaml").write_text(written, encoding="utf-8")
    protocol = load_protocol(tmp_path)
    checks = [(f"P{p:02}", s, "attention", "yes_" if p == 3 or (p == 1 and s == "joy") else "no_")
              for p in range(6) for s in EMOTIONS]  # fmt: skip
    path = tmp_path / "r.csv"
    rows = [*ratings(n=6), *choices(n=6), *checks]
    path.write_text(
        "participant,stimulus,item,response\n" + "".join(",".join(row) + "\n" for row in rows),
        encoding="utf-8",
    )
    responses = read_responses(path, protocol)
    findings = carry_out(responses, protocol)
    assert [(one.participant, one.rule) for one in findings.flow.excluded] == [
        ("P03", "failed 2 or more attention checks")
    ]
    before = look_further(findings, responses, protocol).before
    assert before["H1"].results["joy"].summary.n == 6
    assert findings.outcomes["H1"].results["joy"].summary.n == 5
