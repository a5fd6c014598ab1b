"""The worked protocols, tiny: each is checked, rendered, taken by simulated participants and analysed."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from analysis.dataset import read_responses
from analysis.plan import carry_out
from study.cli import app
from study.protocol import load_protocol
from study.simulation import rehearse

PROTOCOLS = Path(__file__).parent.parent / "protocols"
TINY = "video: {size: 64x36, fps: 4, camera: full_body, lead_in: 0 s, hold: 0 s}\n"


@pytest.fixture(scope="module", params=["godspeed", "online"])
def gone_through(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A worked protocol with small videos, after `check`, `render` and `rehearse`."""
    folder = tmp_path_factory.mktemp("worked") / request.param
    shutil.copytree(PROTOCOLS / request.param, folder, ignore=shutil.ignore_patterns("stimuli", "data"))
    protocol = folder / "protocol.yaml"
    text = re.sub(r"(?m)^video: .*\n", "", protocol.read_text(encoding="utf-8"))
    protocol.write_text(text + TINY, encoding="utf-8")
    for command in (["check"], ["render"], ["rehearse", "-n", "12", "--out", folder / "report"]):
        name, *options = map(str, command)
        done = CliRunner().invoke(app, [name, str(folder), *options], catch_exceptions=False)
        assert done.exit_code == 0, done.output
    return folder


def answers(folder: Path) -> list[dict[str, str]]:
    with (folder / "report" / "responses.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def results(folder: Path) -> dict[str, object]:
    found: dict[str, object] = json.loads((folder / "report" / "results.json").read_text(encoding="utf-8"))
    return found


@pytest.mark.parametrize("gone_through", ["godspeed"], indirect=True)
def test_groups_are_compared_on_the_means_of_series(gone_through: Path) -> None:
    rows = [row for row in answers(gone_through) if row["part"] == "impression"]
    seen = {
        row["participant"]: {r["stimulus"] for r in rows if r["participant"] == row["participant"]}
        for row in rows
    }
    assert len(seen) == 12
    assert sorted(map(sorted, seen.values())) == [["fluent"]] * 6 + [["stiff"]] * 6
    found = results(gone_through)
    assert found["participants"]["excluded"] == []
    compared = found["impression_H2"]["animacy"]
    animacy = [
        r
        for r in rows
        if r["item"] in {"alive", "lively", "organic", "lifelike_2", "interactive", "responsive"}
    ]
    for group in ("fluent", "stiff"):
        points = [int(row["response"]) for row in animacy if row["stimulus"] == group]
        assert compared["summaries"][group]["mean"] == pytest.approx(sum(points) / len(points))
    assert compared["student"]["df"] == 10
    series = {name: set(found[f"impression_{name}"]) for name in ("H1", "H2", "H3")}
    assert series == {"H1": {"anthropomorphism"}, "H2": {"animacy"}, "H3": {"likeability"}}


@pytest.mark.parametrize("gone_through", ["online"], indirect=True)
def test_online_participants_are_checked_spared_and_compared(gone_through: Path) -> None:
    rows = answers(gone_through)
    people = {row["participant"] for row in rows}
    assert len(people) == 12
    checks = [row for row in rows if row["item"] == "attention"]
    assert {(row["part"], row["trial"]) for row in checks} == {("hurry", "4"), ("hurry", "9")}
    assert len(checks) == 24
    experience = {row["participant"]: row["response"] for row in rows if row["item"] == "experience"}
    asked = {row["participant"] for row in rows if row["part"] == "experts"}
    assert asked == {person for person, answer in experience.items() if answer in {"sometimes", "often"}}
    for person in asked:
        ranks = [
            r["response"]
            for r in rows
            if r["participant"] == person and r["item"] in {"speed", "size", "smoothness"}
        ]
        assert sorted(ranks) == ["1", "2", "3"]
    found = results(gone_through)
    failed = {
        p for p in people if sum(r["response"] != "fairly" for r in checks if r["participant"] == p) == 2
    }
    excluded = {one["participant"] for one in found["participants"]["excluded"] if "attention" in one["rule"]}
    assert excluded == failed
    assert not any(
        "unanswered" in one["rule"] or one["rule"] == "incomplete"
        for one in found["participants"]["excluded"]
    )
    assert found["hurry"]["hurried"]["paired"]["n"] == found["participants"]["n"]


def test_the_papers_own_study_is_taken_and_tested_as_it_stands(tmp_path: Path) -> None:
    protocol = load_protocol(PROTOCOLS / "hielscher2025")  # clips need not be rendered to be rated
    table = rehearse(protocol, 6, tmp_path, shares={"attentive": 1.0})
    responses = read_responses(table, protocol)
    assert {(question.part, question.codes.shape) for question in responses.questions} == {
        ("recognition", (6, 6, 6)),
        ("intensity", (6, 12, 1)),
    }
    assert all((question.codes >= 0).all() for question in responses.questions)
    outcomes = carry_out(responses, protocol).outcomes
    assert list(outcomes) == ["H1", "H2.1", "H2.2"]
    assert set(outcomes["H1"].results) == set(protocol.modulations)
    assert set(outcomes["H2.1"].results) == set(outcomes["H2.2"].results) == set(protocol.levels)
