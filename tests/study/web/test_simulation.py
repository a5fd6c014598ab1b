from __future__ import annotations

import csv
import json
import random
from collections import Counter
from pathlib import Path
from statistics import fmean

import pytest

from stimuli.errors import InputError
from study.export import guarded
from study.protocol import Protocol
from study.simulation import MANNERS, USUAL, choose, crowd_of, rehearse, target_of


def test_a_rehearsal_leaves_a_whole_table_that_nobody_takes_for_data(
    protocol: Protocol, tmp_path: Path
) -> None:
    table = rehearse(protocol, 4, tmp_path / "out")
    with table.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    cells = Counter((row["participant"], row["stimulus"], row["item"]) for row in rows)
    assert len(cells) == len(rows) == 4 * (2 + 2 * 6 + 2 * 1)
    assert {row["session"] for row in rows} == {"simulated"}
    assert all(row["participant"].startswith("simulated-") for row in rows)
    assert "practice" not in {row["stimulus"] for row in rows}
    codebook = json.loads((tmp_path / "out" / "responses.codebook.json").read_text("utf-8"))
    assert codebook["is_data"] is False
    assert list(rows[0]) == list(codebook["columns"])
    asked = {entry["item"]: entry for part in codebook["parts"].values() for entry in part["items"]}
    for row in rows[2:16]:
        assert row["response"] in asked[row["item"]]["values"]


def test_orders_fill_the_design_whatever_the_crowd(protocol: Protocol, tmp_path: Path) -> None:
    table = rehearse(protocol, 4, tmp_path / "out")
    with table.open(newline="", encoding="utf-8") as file:
        firsts = Counter(
            row["stimulus"]
            for row in csv.DictReader(file)
            if row["part"] == "recognition" and row["trial"] == "1"
        )
    assert firsts == {"joy": 12, "sadness": 12}


def test_targets_are_what_the_hypotheses_expect(protocol: Protocol) -> None:
    targets = {}
    for part in protocol.parts.values():
        for stimulus in part.stimuli:
            targets[stimulus] = target_of(protocol, protocol.stimuli[stimulus], part.questions[0])
    assert targets == {"joy": "joy", "sadness": "sadness", "time_low": "lower", "time_high": "higher"}


def test_each_manner_answers_as_its_name_says(protocol: Protocol) -> None:
    stimulus = protocol.judged["joy"]
    [question] = protocol.parts["recognition"].questions

    def mean(manner: str, item: str) -> float:
        rng = random.Random(1)
        answers = [choose(protocol, stimulus, question, MANNERS[manner], rng)[item] for _ in range(300)]
        return fmean(map(float, answers))

    for attentive in ("attentive", "dropout"):
        assert mean(attentive, "joy") > mean("unsure", "joy") + 0.2 > mean("unsure", "fear") + 0.4
    assert abs(mean("random clicker", "joy") - 3) < 0.2
    assert mean("yea-sayer", "joy") == mean("yea-sayer", "fear") == 5
    assert max(MANNERS, key=lambda name: -MANNERS[name].rt_s) == "speeder"


def test_a_crowd_is_of_known_manners() -> None:
    assert crowd_of(()) == USUAL
    assert crowd_of(("dropout", "speeder")) == {"dropout": 1.0, "speeder": 1.0}
    with pytest.raises(InputError, match=r"'Yea sayer' is no manner of answering: did you mean yea-sayer\?"):
        crowd_of(("Yea sayer",))


def test_those_who_drop_out_leave_what_they_answered(protocol: Protocol, tmp_path: Path) -> None:
    assert MANNERS["dropout"].drops_out > 0
    table = rehearse(protocol, 6, tmp_path / "out", shares=crowd_of(("dropout",)))
    with table.open(newline="", encoding="utf-8") as file:
        counts = Counter(row["participant"] for row in csv.DictReader(file))
    assert min(counts.values(), default=0) < 16


def test_formulas_are_disarmed_and_numbers_are_not() -> None:
    assert guarded("=1+1") == "'=1+1"
    assert guarded("@SUM(A1)") == "'@SUM(A1)"
    assert guarded("-3.5") == "-3.5"
    assert guarded("joy") == "joy"
