"""Every kind of question takes part in these laws by being in the folder."""

import json
import random
from pathlib import Path

import pytest
from pydantic import TypeAdapter, ValidationError

import study.questions
from study.questions import QUESTIONS, AnswerError, Asked
from study.questions.question import Question
from study.questions.sets import question_sets

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
    "attention": {"text": "Choose green.", "options": ["red", "green"], "expected": "green"},
    "rank": {"text": "Which fits best?", "items": ["joy", "fear", "anger"], "item_order": "shuffled"},
    "slider": {"text": "How?", "items": ["joy", "fear"], "ends": ["not at all", "fully"]},
    "differential": {"set": "godspeed", "points": 7},
    "number": {"item": "age", "text": "Age?", "least": 18, "most": 120, "whole": True},
    "select": {"item": "gender", "text": "Gender?", "options": ["female", "male", "other"]},
    "prefer": {"text": "Which looks happier?"},
    "text": {"item": "remarks", "text": "Remarks?", "longest": 500},
}


def made(kind: str, **changes) -> Question:
    return ASKED.validate_python({kind: EXAMPLES[kind] | changes}).among(["calm", "lively"])


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
     ("text", "x" * 501), ("slider", "101"), ("slider", "-1"), ("slider", "50.5"), ("rank", "0"),
     ("rank", "4"), ("attention", "blue"), ("prefer", "left"), ("prefer", "neutral")],
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


@pytest.mark.parametrize("name", question_sets())
def test_every_set_is_complete_in_english_and_german(name):
    question = ASKED.validate_python({question_sets()[name].kind: {"set": name}})
    texts = [question.text, *question.items.values(), *question.values.values()]
    assert all(not text.lacks(["en", "de"]) for text in texts)
    assert set(question.series) == set(question.items)


def test_only_translations_of_our_own_are_called_unpublished():
    unpublished = {name for name, one in question_sets().items() if one.unpublished}
    assert unpublished == {"rosas", "rosas warmth", "rosas competence", "rosas discomfort"}


def test_godspeed_five_asks_about_the_person_not_the_robot():
    safety = ASKED.validate_python({"differential": {"set": "godspeed safety"}})
    assert safety.text.in_("en") == "Please rate your emotional state on these scales:"
    # Bartneck et al. (2009): the safer end is the second of the first two pairs
    assert [safety.items[item].in_("en") for item in safety.items] == [
        "Anxious – Relaxed", "Agitated – Calm", "Quiescent – Surprised"
    ]  # fmt: skip
    assert [safety.items[item].in_("de") for item in safety.items] == [
        "Ängstlich – Entspannt", "Aufgewühlt – Ruhig", "Still – Überrascht"
    ]  # fmt: skip


def test_rosas_has_its_three_scales_of_six_on_nine_points():
    question = ASKED.validate_python({"rate": {"set": "rosas"}})
    names = list(question.series.values())
    assert {name: names.count(name) for name in names} == {"warmth": 6, "competence": 6, "discomfort": 6}
    assert list(question.values) == [str(point) for point in range(1, 10)]
    answers = dict.fromkeys(question.items, "9") | {"rosas_scary": "3"}
    assert question.scores(answers) == {"warmth": 9, "competence": 9, "discomfort": 8}


def test_a_set_is_for_the_kind_that_asks_it():
    with pytest.raises(ValidationError, match="is no set of questions here"):
        ASKED.validate_python({"rate": {"set": "godspeed"}})


def test_ranks_are_given_once_and_to_all():
    question = made("rank", optional=True)
    question.check({"joy": "2", "fear": "1", "anger": "3"})
    with pytest.raises(AnswerError, match="rank 1 is given 2 times"):
        question.check({"joy": "1", "fear": "1", "anger": "3"})
    with pytest.raises(AnswerError, match="2 of 3 are ranked"):
        question.check({"joy": "1", "fear": "2"})


def test_the_ranked_target_is_often_first():
    rng = random.Random(1)
    first = [made("rank").simulate(rng, "joy")["joy"] == "1" for _ in range(300)]
    assert sum(first) > 200


def test_attention_is_passed_by_the_expected_answer_alone():
    question = made("attention")
    assert question.passed("green") and not question.passed("red") and not question.passed("")
    assert question.codebook()[0]["expected"] == "green"
    rng = random.Random(1)
    assert all(question.simulate(rng)["attention"] == "green" for _ in range(50))
    with pytest.raises(ValidationError, match="is no option; did you mean green"):
        made("attention", expected="gren")


def test_a_preference_is_for_one_of_the_two_that_are_shown():
    question = made("prefer")
    assert list(question.values) == ["calm", "lively"]
    assert list(question.among(["b", "a"]).values) == ["b", "a"], "as they stand, left and right"
    assert list(question.values) == ["calm", "lively"], "the question itself stays as it is"
    rng = random.Random(1)
    assert sum(question.simulate(rng, "lively")["preferred"] == "lively" for _ in range(400)) > 300
    blind = sum(question.simulate(rng, "lively", 0.0)["preferred"] == "lively" for _ in range(400))
    assert abs(blind - 200) < 60


def test_sliders_can_be_scored_in_series():
    question = made("slider", series={"joy": "affect", "fear": "affect"})
    assert question.scores({"joy": "80", "fear": "21"}) == {"affect": 50.5}


def test_a_series_can_be_asked_alone():
    question = ASKED.validate_python({"differential": {"set": "godspeed animacy"}})
    assert list(question.items) == ["alive", "lively", "organic", "lifelike_2", "interactive", "responsive"]
    assert question.items["alive"].in_("en") == "Dead – Alive"


def test_an_unknown_set_is_refused_with_the_nearest():
    with pytest.raises(ValidationError, match="did you mean godspeed animacy"):
        ASKED.validate_python({"differential": {"set": "godspeed animacyy"}})
