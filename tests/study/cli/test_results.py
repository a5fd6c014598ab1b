"""The commands from responses to statistics, as they are typed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from study.cli import app

PROTOCOL = """
study: small
title: A small study
contact: lab@example.org
robot: pepper
seed: 3
gestures: {nod: nod.yaml}
modulations: {quick: {time: 0.8}}
parts:
  nods:
    title: How lively is it?
    stimuli: {gesture: nod, modulations: [quick]}
    ask: [{rate: {text: It is, items: [quick], points: 5, ends: [no, yes]}}]
participants: {planned: 4}
analysis:
  H1: {part: nods, test: one-sample t, of: target, against: midpoint, alternative: greater}
"""
NOD = "gesture: nod\nrobot: pepper\nduration: 1 s\njoints: {HeadPitch: {0.0: home, 0.5: 10 deg, 1.0: home}}\n"


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study with the answers of three people."""
    (tmp_path / "protocol.yaml").write_text(PROTOCOL, encoding="utf-8")
    (tmp_path / "nod.yaml").write_text(NOD, encoding="utf-8")
    rows = [f"P{person},quick,quick,{answer}\n" for person, answer in enumerate("453")]
    (tmp_path / "r.csv").write_text("participant,stimulus,item,response\n" + "".join(rows), encoding="utf-8")
    return tmp_path


def analyse(study: Path, time: str) -> int:
    typed = [
        "analyse",
        f"{study}/r.csv",
        "--protocol",
        str(study),
        "--out",
        f"{study}/report",
        "--time",
        time,
    ]
    return CliRunner().invoke(app, typed).exit_code


def test_the_time_of_the_analysis_is_in_the_report_as_it_was_said(study: Path) -> None:
    assert analyse(study, "2026-11-22T10:00+0100") == 0
    results = json.loads((study / "report" / "results.json").read_text(encoding="utf-8"))
    assert results["analysed_at"] == "2026-11-22T10:00+01:00"
    assert "2026-11-22T10:00+01:00" in (study / "report" / "report.html").read_text(encoding="utf-8")


def test_a_time_that_is_none_is_refused_before_anything_is_written(study: Path) -> None:
    assert analyse(study, "yesterday") == 2
    assert not (study / "report").exists()
