"""Questions without a hypothesis are described, whatever their kind; series are scored by their means."""

from __future__ import annotations

import csv
import random
import statistics
from pathlib import Path

import pytest

from analysis.dataset import read_responses
from analysis.description import Counts, Means, Numbers, Written, described, opened
from analysis.fields import ResponsesError
from analysis.further import look_further
from analysis.plan import carry_out
from analysis.results import Provenance, Results
from analysis.web import html
from study.protocol import Protocol, load_protocol

PROTOCOL = """
study: kinds
title: Every kind
contact: a@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
modulations: {calm: {time: 1.3}, lively: {time: 0.85}}
parts:
  impression:
    title: Every kind of question
    stimuli: {gesture: wave, modulations: [calm, lively]}
    ask:
      - rate: {set: rosas}
      - differential: {text: It moves, pairs: {speed: [slowly, fast]}}
      - slider: {text: It is, items: {hurried: in a hurry}, ends: [not at all, extremely]}
      - rank: {text: What matters?, items: {pace: speed, extent: size, ease: smoothness}}
      - select: {item: seen, text: Seen before?, options: ["yes", "no", unsure]}
      - text: {item: remark, text: Anything else?, optional: true}
      - number: {item: metres, text: How far away?, least: 0, most: 20}
demographics:
  - number: {item: age, text: How old are you?, least: 18, most: 99}
  - select: {item: gender, text: You are, options: [female, male, other]}
participants: {planned: 8}
analysis:
  H1: {part: impression, item: warmth, test: paired t, compare: [lively, calm], alternative: two-sided}
"""


@pytest.fixture(scope="module")
def kinds(tmp_path_factory: pytest.TempPathFactory) -> tuple[Protocol, list[tuple[str, ...]], Path]:
    folder = tmp_path_factory.mktemp("kinds")
    (folder / "protocol.yaml").write_text(PROTOCOL, encoding="utf-8")
    protocol, rng = load_protocol(folder), random.Random(2)
    rows = [
        (f"P{person}", stimulus, item, answer)
        for person in range(6)
        for stimulus in ("calm", "lively")
        for question in protocol.parts["impression"].questions
        for item, answer in question.simulate(rng).items()
    ]
    path = folder / "responses.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([("participant", "stimulus", "item", "response"), *rows])
    return protocol, rows, path


def test_every_kind_is_described(kinds: tuple[Protocol, list[tuple[str, ...]], Path]) -> None:
    protocol, rows, path = kinds
    found = {one.columns: one for one in described(carry_out(read_responses(path, protocol), protocol))}
    scores = found["warmth", "competence", "discomfort"]
    ranks, seen = found["pace", "extent", "ease"], found["yes", "no", "unsure"]
    assert isinstance(scores, Means) and isinstance(ranks, Means) and isinstance(seen, Counts)
    assert ("speed",) in found
    given = [int(row[3]) for row in rows if row[1:3] == ("calm", "pace")]
    assert ranks.rows["calm"][0].mean == pytest.approx(sum(given) / 6)
    assert sum(one.mean or 0 for one in ranks.rows["lively"]) == pytest.approx(1 + 2 + 3)
    answers = [row[3] for row in rows if row[1:3] == ("lively", "seen")]
    assert seen.rows["lively"] == tuple(answers.count(option) for option in ("yes", "no", "unsure"))


ABOUT = "participant,part,stimulus,item,response\n"


def test_numbers_words_and_participants_are_described(
    kinds: tuple[Protocol, list[tuple[str, ...]], Path], tmp_path: Path
) -> None:
    protocol, rows, path = kinds
    found = {type(one): one for one in described(carry_out(read_responses(path, protocol), protocol))}
    metres = [float(row[3]) for row in rows if row[1:3] == ("calm", "metres")]
    mean, n, median, least, most = found[Numbers].rows["calm metres"]
    assert (n, least, most) == (6, min(metres), max(metres))
    assert mean.mean == pytest.approx(statistics.mean(metres))
    assert mean.sd == pytest.approx(statistics.stdev(metres)) and median == statistics.median(metres)
    assert found[Written].rows["lively remark"] == (6, 0)
    about = tmp_path / "about.csv"
    about.write_text(
        f"{ABOUT}1,demographics,,age,30\n2,demographics,,age,\n1,demographics,,gender,other\n",
        encoding="utf-8",
    )
    ages, genders = opened(read_responses(about, protocol).open)
    assert isinstance(ages, Numbers) and ages.rows["age"][1:] == (1, 30.0, 30.0, 30.0)
    assert isinstance(genders, Counts) and genders.rows["gender"] == (0, 0, 1)


@pytest.mark.parametrize(("rows", "message"), [
    ("1,demographics,,age,old\n", r"r.csv:2: response 'old' to age is not a number"),
    ("1,demographics,,age,30\n1,demographics,,age,31\n", r"r.csv:3: second answer to \(1, , age\)"),
])  # fmt: skip
def test_numbers_that_are_none_and_second_ones_are_refused(
    kinds: tuple[Protocol, list[tuple[str, ...]], Path], tmp_path: Path, rows: str, message: str
) -> None:
    path = tmp_path / "r.csv"
    path.write_text(ABOUT + rows, encoding="utf-8")
    with pytest.raises(ResponsesError, match=message):
        read_responses(path, kinds[0])


def test_the_report_shows_them(kinds: tuple[Protocol, list[tuple[str, ...]], Path]) -> None:
    protocol, _, path = kinds
    responses = read_responses(path, protocol)
    findings = carry_out(responses, protocol)
    results = Results(findings, Provenance("s", "p", "r", {}), look_further(findings, responses, protocol))
    page = html(results, protocol, {}, {})
    assert "Other answers" in page and "how many gave each answer" in page
    assert len(results.as_json()["described"]) >= 4
    assert set(results.further.scales) == {f"impression: {s}" for s in ("warmth", "competence", "discomfort")}
