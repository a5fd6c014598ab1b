"""Parts that only some participants see."""

import pytest

from study.orders import draw_plan
from study.protocol import ProtocolError
from study.sessions import steps

EXPERIENCE = {
    "select": {
        "item": "experience",
        "text": {"en": "Robots?", "de": "Roboter?"},
        "options": ["none", "some", "much"],
    }
}


@pytest.fixture
def conditional(written):
    written["demographics"] = [EXPERIENCE]
    written["parts"]["intensity"]["if"] = {"experience": ["some", "much"]}
    return written


def test_a_part_is_due_after_one_of_the_answers_it_waits_for(load, conditional):
    part = load(conditional).parts["intensity"]
    assert part.due({"experience": {"much"}})
    assert not part.due({"experience": {"none"}})
    assert not part.due({})


def test_every_condition_must_hold(load, conditional):
    conditional["parts"]["intensity"]["if"]["joy"] = 5
    part = load(conditional).parts["intensity"]
    assert part.due({"experience": {"some"}, "joy": {"1", "5"}})
    assert not part.due({"experience": {"some"}, "joy": {"1", "2"}})


def test_a_part_left_out_has_no_pages(load, conditional):
    plan = draw_plan(load(conditional), 0)
    whole, spared = steps(plan), steps(plan, left_out=frozenset({"intensity"}))
    assert [page for page in whole if page.part != "intensity"] == list(spared)
    assert len(spared) < len(whole)


@pytest.mark.parametrize(
    ("condition", "message"),
    [
        ({"experince": "some"}, "is no item asked before this part; did you mean experience?"),
        ({"experience": "sme"}, "is no answer to experience; did you mean some?"),
        ({"intensity": "higher"}, "is no item asked before this part"),
        ({"experience": []}, "must be an answer, or a list of answers"),
        ({}, "must be answers by item"),
        ("some", "must be answers by item"),
    ],
)
def test_conditions_speak_of_what_was_asked_before(load, conditional, condition, message):
    conditional["parts"]["intensity"]["if"] = condition
    with pytest.raises(ProtocolError) as refused:
        load(conditional)
    assert message in refused.value.problems[0].message
    assert refused.value.problems[0].field.startswith("parts.intensity.if")
