"""Pairs of clips side by side: which are formed, refused, balanced, planned and put into words."""

from collections import Counter

import pytest

from study.balance import balance
from study.orders import cycle, draw_plan
from study.power import power, preference_power
from study.protocol import ProtocolError
from study.simulation import MANNERS, target_of

STUDY = """
study: paired
title: Which looks happier?
contact: a@example.org
robot: pepper
seed: 3
gestures: {wave: wave.yaml, nod: nod.yaml}
modulations: {calm: {time: 1.3}, lively: {time: 0.8}}
levels: {arc: [1, 3, 8], exa: [0.6, 1.0, 1.2]}
parts:
  liked:
    title: Which do you like better?
    stimuli: {gesture: [wave, nod], modulations: [calm, lively, neutral]}
    pairs: all
    order: williams
    ask: [{prefer: {item: liked, text: Which do you like better?}}]
  stronger:
    title: Which is more intense?
    stimuli: {gesture: wave, levels: [arc, exa]}
    pairs: [[high, low], [high, medium]]
    order: {principles: latin square, stimuli: shuffled}
    ask: [{prefer: {text: Which is more intense?}}, {rate: {text: I am, items: [sure], ends: [not, very]}}]
participants: {planned: 12}
analysis:
  H1: {part: liked, test: binomial, compare: [lively, calm], alternative: two-sided, correction: holm}
  H2: {part: stronger, test: binomial, compare: [high, low], alternative: greater}
"""


@pytest.fixture
def paired(load):
    return load(STUDY)


def test_pairs_are_of_the_same_gesture_or_principle(paired):
    wave = ["wave_calm_or_wave_lively", "wave_calm_or_wave_neutral", "wave_lively_or_wave_neutral"]
    assert paired.parts["liked"].stimuli == (*wave, *(pair.replace("wave", "nod") for pair in wave))
    assert paired.parts["stronger"].pairs == {
        f"{kind}_high_or_{kind}_{other}": (f"{kind}_high", f"{kind}_{other}")
        for kind in ("arc", "exa")
        for other in ("low", "medium")
    }
    assert set(paired.stimuli) == {
        *(f"{gesture}_{name}" for gesture in ("wave", "nod") for name in ("calm", "lively", "neutral")),
        *(f"{kind}_{level}" for kind in ("arc", "exa") for level in ("low", "medium", "high")),
    }
    assert paired.length[0] == 2 * (6 + 4)


@pytest.mark.parametrize("part", ["liked", "stronger"])
def test_every_clip_of_every_pair_stands_on_each_side_equally_often(paired, part):
    plans = [draw_plan(paired, slot) for slot in range(cycle(paired))]
    trials = [trial for plan in plans for trial in plan.trials if trial.part == part]
    assert {trial.stimulus for trial in trials} == set(paired.parts[part].pairs)
    for trial in trials:
        assert sorted(trial.pair) == sorted(paired.parts[part].pairs[trial.stimulus])
    sides = Counter((trial.stimulus, trial.pair[0]) for trial in trials)
    assert set(sides.values()) == {len(plans) / 2}
    counted = next(found for found in balance(paired, plans) if found.part == part)
    assert counted.left_range == (len(plans) / 2, len(plans) / 2)


def test_half_of_the_pairs_of_one_participant_are_turned_round(paired):
    for slot in range(8):
        trials = [trial for trial in draw_plan(paired, slot).trials if trial.part == "liked"]
        turned = [trial.pair != paired.parts["liked"].pairs[trial.stimulus] for trial in trials]
        assert sum(turned) == 3


def test_groups_of_participants_see_one_pair_each_from_both_sides(load):
    study = load(STUDY.replace("order: williams", "order: between participants"))
    assert cycle(study) == 12
    seen = [trial for slot in range(12) for trial in draw_plan(study, slot).trials if trial.part == "liked"]
    assert len(seen) == 12
    assert set(Counter((trial.stimulus, trial.pair[0]) for trial in seen).values()) == {1}


def test_one_may_practise_on_a_pair(load):
    study = load(
        STUDY + "practice: {stimulus: {gesture: nod}, beside: {gesture: nod, modulation: calm}, ask: liked}"
    )
    first = draw_plan(study, 0).trials[0]
    assert first.practice and first.pair == ("practice", "practice_beside")
    question, _, _ = next(first.asked(study.parts["liked"]))
    assert list(question.values) == ["practice", "practice_beside"]
    assert study.stimuli["practice_beside"].modulation == study.modulations["calm"]


def test_the_preferred_one_is_what_the_hypothesis_says(paired):
    pair = paired.judged["arc_high_or_arc_low"]
    question = paired.parts["stronger"].questions[0]
    assert target_of(paired, pair, question) == "arc_high"
    assert target_of(paired, paired.judged["arc_high_or_arc_medium"], question) is None
    assert MANNERS["attentive"].effect == 1


def test_power_is_that_of_the_binomial_test(paired):
    # R: sum(dbinom(10:12, 12, .9)), where 10 is the least k with binom.test(k, 12, alt = "g")$p.value < .05
    assert preference_power(12, 0.9, 0.05) == pytest.approx(0.8891300223, rel=1e-9)
    found = {one.hypothesis: one for one in power(paired)}
    assert (found["H1"].tests, found["H1"].alpha) == (2, 0.025)
    assert (found["H2"].tests, found["H2"].effect) == (2, "share")
    assert preference_power(12, found["H2"].smallest, 0.05) >= 0.8


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("pairs: all", "pairs: []", "must be all, or a list of pairs"),
        ("pairs: all", "pairs: [[calm, calm], [lively, neutral]]", "compares calm with itself"),
        ("pairs: all", "pairs: [[calm, livly], [lively, neutral]]", "did you mean lively"),
        ("pairs: all", "pairs: [[calm, lively]]", "leaves wave_neutral, nod_neutral without another"),
        ("pairs: all", "pairs: [[calm, lively], [lively, calm], [lively, neutral]]", "a second time"),
        ("pairs: all", "pairs: [[calm, lively, neutral]]", "must be all, or a list of pairs"),
        ("    pairs: all\n", "", "is for a part with pairs"),
        (
            "pairs: [[high, low], [high, medium]]",
            "pairs: all\n    reference: medium",
            "does not go with pairs",
        ),
        (
            "{principles: latin square, stimuli: shuffled}",
            "{principles: latin square, levels: balanced}",
            "one by one",
        ),
        ("order: williams", "order: {stimuli: shuffled, max_run: {modulation: 1}}", "goes by gestures"),
        (
            "test: binomial, compare: [lively, calm]",
            "test: paired t, compare: [lively, calm]",
            "no test of pairs",
        ),
        ("compare: [lively, calm]", "compare: [lively, lively]", "compares lively with itself"),
        ("test: binomial, compare: [high, low]", "test: binomial, of: target", "bear the names"),
        ("compare: [high, low]", "compare: [high, low], outcome: yes", "the first of `compare`"),
        (
            "planned: 12}",
            "planned: 12}\npractice: {stimulus: {gesture: nod}, ask: liked}",
            "add what stands beside",
        ),
    ],
)
def test_what_cannot_be_compared_is_refused(load, before, after, message):
    with pytest.raises(ProtocolError, match=message) as refused:
        load(STUDY.replace(before, after, 1))
    assert all(problem.line for problem in refused.value.problems)


def test_targets_are_not_tested_on_pairs(load):
    rated = "{rate: {text: It is, items: [calm, lively], ends: [not, very]}}"
    asked = STUDY.replace("better?}}]", f"better?}}}}, {rated}]", 1)
    with pytest.raises(ProtocolError, match=r"H1\.of: 'target' does not go with pairs; write compare"):
        load(asked.replace("test: binomial, compare: [lively, calm]", "test: one-sample t, of: target", 1))
