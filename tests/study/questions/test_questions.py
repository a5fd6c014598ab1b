"""Every kind of question takes part in these laws by being in the folder."""

import json
import random
from pathlib import Path

import pytest
from pydantic import TypeAdapter, ValidationError

import study.questions
from study.questions import QUESTIONS, AnswerError, Asked
from study.questions.question import Question

ASKED = TypeAdapter(Asked)
EXAMPLES: dict[str, dict[str, object]] = {
    "rate": {
        "text": "How?",
        "items": ["joy", "fear"],
        "points": 5,
        "ends": {"en": ["no", "yes"], "de": ["nein", "ja"]},
    },
    "choose": {
        "text": "Which?",
        "options": {"lower": {"en": "lower"}, "higher": {"en": "higher"}},
        "sides": "balanced",
    },
    "differential": {"set": "godspeed", "points": 7},
    "number": {"item": "age", "text": "Age?", "least": 18, "most": 120, "whole": True},
    "select": {"item": "gender", "text": "Gender?", "options": ["female", "male", "other"]},
    "text": {"item": "remarks", "text": "Remarks?", "longest": 500},
}


def made(kind: str, **changes) -> Question:
    return ASKED.validate_python({kind: EXAMPLES[kind] | changes})


def test_every_kind_has_an_example_here():
    assert set(EXAMPLES) == set(QUESTIONS)


@pytest.mark.parametrize("kind", QUESTIONS)
def test_simulated_answers_are_possible_ones(kind):
    question = made(kind)
    rng = random.Random(1)
    for target in [None, *question.items, *(question.values or ()), "nonsense"]:
        for _ in range(50):
            question.check(question.simulate(rng, target))


@pytest.mark.parametrize("kind", QUESTIONS)
def test_simulated_answers_repeat_with_the_seed(kind):
    question = made(kind)
    assert question.simulate(random.Random(3)) == question.simulate(random.Random(3))


@pytest.mark.parametrize("kind", QUESTIONS)
def test_missing_and_unasked_answers_are_refused(kind):
    question = made(kind)
    answers = question.simulate(random.Random(1))
    item = next(iter(question.items))
    with pytest.raises(AnswerError, match="is missing"):
        question.check(answers | {item: ""})
    with pytest.raises(AnswerError, match="is missing"):
        question.check({key: value for key, value in answers.items() if key != item})
    with pytest.raises(AnswerError, match="is not asked here"):
        question.check(answers | {"unasked": "1"})


@pytest.mark.parametrize("kind", QUESTIONS)
def test_optional_questions_may_be_left_out(kind):
    question = made(kind, optional=True)
    question.check({})
    question.check(dict.fromkeys(question.items, ""))


@pytest.mark.parametrize("kind", QUESTIONS)
def test_the_codebook_tells_every_item_and_is_json(kind):
    question = made(kind)
    entries = json.loads(json.dumps(question.codebook("de")))
    assert [entry["item"] for entry in entries] == list(question.items)
    assert all(entry["kind"] == kind and entry["question"] for entry in entries)


@pytest.mark.parametrize("kind", QUESTIONS)
def test_each_kind_has_its_page_beside_it(kind):
    assert (Path(study.questions.__file__).parent / made(kind).template).is_file()


@pytest.mark.parametrize("kind", QUESTIONS)
def test_option_orders_all_hold_the_same_options(kind):
    orders = made(kind).option_orders
    assert len({tuple(sorted(order)) for order in orders}) == 1


@pytest.mark.parametrize(
    ("kind", "answer"),
    [("rate", "0"), ("rate", "6"), ("rate", "3.0"), ("rate", " 3"), ("choose", "Lower"), ("number", "17"),
     ("number", "121"), ("number", "18.5"), ("number", "1e2"), ("number", "٣٣"), ("select", "nobody"),
     ("text", "x" * 501)],
)  # fmt: skip
def test_impossible_answers_are_refused(kind, answer):
    question = made(kind)
    answers = question.simulate(random.Random(1))
    with pytest.raises(AnswerError):
        question.check(answers | {next(iter(question.items)): answer})


def test_the_target_is_rated_above_the_rest_and_chance_is_not():
    rate, rng = made("rate"), random.Random(1)
    seen = [rate.simulate(rng, "joy") for _ in range(400)]
    blind = [rate.simulate(rng, "joy", 0.0) for _ in range(400)]

    def mean(answers, item):
        return sum(int(a[item]) for a in answers) / len(answers)

    assert mean(seen, "joy") > mean(seen, "fear") + 1
    assert abs(mean(blind, "joy") - 3) < 0.2


def test_labels_need_as_many_texts_in_each_language():
    with pytest.raises(ValidationError, match="2 in en, 1 in de"):
        made("rate", ends={"en": ["no", "yes"], "de": ["nein"]})


def test_godspeed_has_its_24_items_in_five_series_and_scores_their_means():
    question = made("differential")
    sizes = [list(question.series.values()).count(name) for name in dict.fromkeys(question.series.values())]
    assert sizes == [5, 6, 5, 5, 3]
    answers = dict.fromkeys(question.items, "4") | {"relaxed": "1", "calm": "", "surprised": "2"}
    assert question.scores(answers)["safety"] == 1.5
    assert question.scores(answers)["animacy"] == 4
    assert question.scores({}) == {}


def test_a_series_can_be_asked_alone():
    question = ASKED.validate_python({"differential": {"set": "godspeed animacy"}})
    assert list(question.items) == ["alive", "lively", "organic", "lifelike_2", "interactive", "responsive"]
    assert question.items["alive"].in_("en") == "Dead – Alive"


def test_an_unknown_set_is_refused_with_the_nearest():
    with pytest.raises(ValidationError, match="did you mean godspeed animacy"):
        ASKED.validate_python({"differential": {"set": "godspeed animacyy"}})
