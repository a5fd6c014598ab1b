from __future__ import annotations

from uuid import UUID, uuid4

from hypothesis import given
from hypothesis import strategies as st

from study.orders import Plan, Trial
from study.responses import View, playback_fault
from study.sessions import Verdict, judge, next_step, plan_json, plan_sha256, read_plan, steps

words = st.text(st.characters(codec="utf-8"), min_size=1, max_size=8)
trials = st.builds(
    Trial,
    part=st.sampled_from(["recognition", "intensity"]),
    number=st.integers(1, 20),
    stimulus=words,
    reference=st.none() | words,
    items=st.lists(st.lists(words, max_size=3).map(tuple), max_size=2).map(tuple),
    options=st.lists(st.lists(words, max_size=3).map(tuple), max_size=2).map(tuple),
    practice=st.booleans(),
)
plans = st.builds(
    Plan,
    slot=st.integers(0, 99),
    seed=words,
    algorithm=words,
    trials=st.lists(trials, max_size=6).map(
        lambda drawn: tuple(sorted(drawn, key=lambda t: (not t.practice, t.part)))
    ),
)


@given(plans)
def test_a_plan_reads_back_as_it_was_stored(plan: Plan) -> None:
    assert read_plan(plan_json(plan)) == plan
    assert plan_sha256(read_plan(plan_json(plan))) == plan_sha256(plan)


@given(plans)
def test_every_trial_has_one_step_and_all_keys_differ(plan: Plan) -> None:
    pages = steps(plan)
    assert [page.trial for page in pages if page.trial] == list(plan.trials)
    assert len({page.key for page in pages}) == len(pages)


@given(plans)
def test_only_the_page_that_is_due_is_stored_and_the_way_ends(plan: Plan) -> None:
    pages, answered = steps(plan), {}
    for page in pages:
        for other in pages:
            verdict = judge(uuid4(), other.key, pages=pages, answered=answered)
            if other == page:
                assert verdict is Verdict.STORE
            else:
                assert verdict is (Verdict.ELSEWHERE if other.key in answered else Verdict.NOT_YET)
        answered[page.key] = uuid4()
        assert judge(answered[page.key], page.key, pages=pages, answered=answered) is Verdict.KNOWN
    assert next_step(pages, answered) is None


def test_what_is_stored_while_an_answer_is_judged_does_not_disturb() -> None:
    class Compared(UUID):
        def __eq__(self, other: object) -> bool:
            answered[str(uuid4())] = uuid4()
            return self is other

        __hash__ = UUID.__hash__

    pages = steps(Plan(0, "", "", ()))
    answered: dict[str, UUID] = {step: Compared(int=1) for step in ("first", "second")}
    assert judge(uuid4(), pages[0].key, pages=pages, answered=answered) is Verdict.STORE


def seen(role: str, played_s: float, plays: int = 1) -> View:
    return View(role=role, plays=plays, played_s=played_s, duration_s=4.0, frames=0, dropped=0)


def test_a_clip_counts_as_watched_from_98_percent() -> None:
    assert playback_fault([seen("clip", 3.93)], {"clip": 4.0}, elapsed_s=10.0) is None
    assert "only 3.91" in str(playback_fault([seen("clip", 3.91)], {"clip": 4.0}, elapsed_s=10.0))
    assert "not played to its end" in str(
        playback_fault([seen("clip", 4.0, plays=0)], {"clip": 4.0}, elapsed_s=10.0)
    )


def test_the_reference_must_be_watched_too() -> None:
    durations_s = {"reference": 4.0, "clip": 4.0}
    assert "the reference was not played" in str(
        playback_fault([seen("clip", 4.0)], durations_s, elapsed_s=10.0)
    )


def test_nobody_answers_sooner_than_the_clips_take() -> None:
    views = [seen("reference", 4.0), seen("clip", 4.0)]
    durations_s = {"reference": 4.0, "clip": 4.0}
    assert playback_fault(views, durations_s, elapsed_s=7.9) is None
    assert "7.84 s" in str(playback_fault(views, durations_s, elapsed_s=7.8))
    assert playback_fault(views, durations_s, elapsed_s=None) is None


def test_a_clip_is_not_played_more_often_than_is_allowed() -> None:
    def fault(plays: int, replays: int | None) -> str | None:
        views = [seen("clip", 4.0, plays=plays)]
        return playback_fault(views, {"clip": 4.0}, elapsed_s=60.0, replays=replays)

    assert fault(9, None) is None
    assert fault(1, 0) is None
    assert fault(3, 2) is None
    assert "played 4 times; 3 are allowed" in str(fault(4, 2))
