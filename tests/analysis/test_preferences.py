"""Paired comparisons: the share that chose one over the other, by the exact binomial test."""

import csv
import json
from pathlib import Path

import pytest

from analysis.dataset import read_responses
from analysis.fields import ResponsesError
from analysis.plan import carry_out
from analysis.report import analyse
from analysis.simulated_power import simulated_power
from study.protocol import load_protocol

STUDY = """
study: liked
title: Which is better?
contact: a@example.org
robot: pepper
seed: 3
gestures: {wave: wave.yaml, nod: nod.yaml}
modulations: {calm: {time: 1.3}, lively: {time: 0.8}}
parts:
  liked:
    title: Which do you like better?
    stimuli: {gesture: [wave, nod], modulations: [calm, lively]}
    pairs: all
    ask:
      - rate: {text: I am, items: [sure], ends: ["no", "yes"]}
      - prefer: {text: Which do you like better?}
participants: {planned: 34}
analysis:
  H1: {part: liked, test: binomial, compare: [lively, calm], alternative: two-sided, correction: holm}
  H2: {part: liked, item: sure, test: binomial, compare: [calm, lively], alternative: greater}
"""


@pytest.fixture
def protocol(tmp_path):
    text = STUDY.replace("  H2: {part: liked, item: sure, ", "  H2: {part: liked, ")
    (tmp_path / "protocol.yaml").write_text(text, encoding="utf-8")
    return load_protocol(tmp_path)


def written(path: Path, *, lively: int, n: int = 34, odd: str | None = None) -> Path:
    """`lively` of n prefer the lively wave; every second the lively nod."""
    rows = []
    for person in range(n):
        chosen = {"wave": "lively" if person < lively else "calm", "nod": ("lively", "calm")[person % 2]}
        for gesture, name in chosen.items():
            pair = f"{gesture}_calm_or_{gesture}_lively"
            rows += [(person, pair, "preferred", f"{gesture}_{name}"), (person, pair, "sure", 1 + person % 5)]
    if odd:
        rows[0] = (*rows[0][:3], odd)
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([("participant", "stimulus", "item", "response"), *rows])
    return path


def test_shares_and_intervals_agree_with_r(protocol, tmp_path):
    found = carry_out(read_responses(written(tmp_path / "r.csv", lively=27), protocol), protocol)
    wave, nod = (found.outcomes["H1"].results[name] for name in ("wave", "nod"))
    # R: binom.test(27, 34); binom.test(7, 34, alternative = "greater")
    assert (wave.test.k, wave.test.n) == (27, 34)
    assert wave.test.p == pytest.approx(0.0008213953115, rel=1e-9)
    assert wave.test.ci95 == pytest.approx((0.6210222514603, 0.9129786945419), rel=1e-9)
    assert wave.verdict.p_adjusted == pytest.approx(2 * wave.test.p) and wave.verdict.significant
    assert nod.test.p == pytest.approx(1) and nod.test.estimate == 0.5 and not nod.verdict.significant
    assert found.outcomes["H2"].results["wave"].test.k == 7
    assert found.outcomes["H2"].results["wave"].test.p == pytest.approx(0.9999024372, rel=1e-9)


def test_the_report_tells_the_share_in_every_form(protocol, tmp_path):
    analyse(written(tmp_path / "r.csv", lively=27), protocol, tmp_path / "out")
    results = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert results["liked_H1"]["wave"]["test"]["estimate"] == pytest.approx(27 / 34)
    assert results["hypotheses"]["H1"]["results"] == "liked_H1"
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    assert "27 of 34 preferred wave_lively to wave_calm (.79, 95% CI [0.62, 0.91]), p &lt; .001" in page
    with (tmp_path / "out" / "tables" / "liked_H1.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["pair"], row["chosen"], row["n"]) for row in rows] == [
        ("wave", "27", "34"),
        ("nod", "17", "34"),
    ]
    assert (tmp_path / "out" / "figures" / "liked_H1.svg").is_file()
    assert r"$27/34$ & $.79$ & $[0.62, 0.91]$" in (tmp_path / "out" / "tables" / "liked_H1.tex").read_text(
        encoding="utf-8"
    )


@pytest.mark.parametrize("odd", ["nod_calm", "sure"])
def test_an_answer_that_was_not_on_the_page_is_refused(protocol, tmp_path, odd):
    with pytest.raises(ResponsesError, match=r"wave_calm_or_wave_lively|is not an answer to preferred"):
        carry_out(read_responses(written(tmp_path / "r.csv", lively=27, odd=odd), protocol), protocol)


def test_with_no_answers_there_is_no_share(protocol, tmp_path):
    path = tmp_path / "r.csv"
    path.write_text("participant,stimulus,item,response\np,wave_calm_or_wave_lively,preferred,\n", "utf-8")
    study = protocol.model_copy(
        update={
            "participants": protocol.participants.model_copy(
                update={"exclude": protocol.participants.exclude.model_copy(update={"incomplete": False})}
            )
        }
    )
    found = carry_out(read_responses(path, study), study)
    assert found.outcomes["H1"].results["wave"].test.p is None


def test_power_by_simulation_is_high_where_the_effect_is_and_alpha_where_it_is_not(protocol):
    there = {(one.hypothesis, one.test): one.power for one in simulated_power(protocol, runs=12, effect=1.2)}
    gone = [one.power for one in simulated_power(protocol, runs=12, effect=0.0)]
    assert max(there.values()) > 0.7
    assert max(gone) < 0.4
