"""The same laws for every kind of database that can be started here."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from uuid import uuid4

import pytest
from sqlalchemy.exc import IntegrityError

from stimuli.errors import InputError
from study.orders import Plan, Trial
from study.participants import (
    Contact,
    Kind,
    Participant,
    new_completion_code,
    new_participant,
    new_token,
    token_sha256,
)
from study.responses import Answer, Submission
from study.sessions import Session, Verdict, plan_sha256, steps
from study.storage import Store, open_store
from study.storage.store import Phase, Visit

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
HOUR = timedelta(hours=1)


def invite(store: Store, kind: Kind = "participant") -> Participant:
    participant = new_participant(new_token(), kind=kind, created_at=NOON)
    store.add_participant(participant)
    return participant


def begin(store: Store, participant: Participant, now: datetime = NOON) -> Session:
    def draw(slot: int) -> Session:
        trials = tuple(Trial("part", n, f"clip{n}", None, (("joy",),), ((),)) for n in (1, 2))
        plan = Plan(slot, "5eed", "orders/1", trials)
        code = new_completion_code()
        return Session(participant.name, plan, plan_sha256(plan), "a", "software", "en", "b", code, now)

    return store.begin_session(participant, draw, now=now, stale_after=HOUR)


def answer(store: Store, session: Session, step: str, now: datetime = NOON) -> Verdict:
    submission = Submission(id=uuid4(), step=step, answers=(Answer(item="joy", value="5"),), on_page_ms=1)
    return send(store, session, submission, now=now)


def send(store: Store, session: Session, submission: Submission, now: datetime = NOON) -> Verdict:
    visit = visit_of(store, session)
    return store.add_response(visit, submission, steps=steps(session.plan), now=now).result()


def visit_of(store: Store, session: Session) -> Visit:
    [token] = [
        row.participant.token_sha256
        for row in store.progress()
        if row.participant.name == session.participant
    ]
    visit = store.remembered(token) or store.visit(token).result()
    assert visit is not None
    return visit


def test_a_token_opens_its_session_and_is_not_stored(store: Store) -> None:
    token = new_token()
    participant = new_participant(token, kind="participant", created_at=NOON)
    store.add_participant(participant)
    assert store.participant(token_sha256(token)) == participant
    assert store.participant(token_sha256(new_token())) is None
    assert token not in repr(participant)


def test_a_session_is_drawn_once_and_read_back_the_same(store: Store) -> None:
    participant = invite(store)
    session = begin(store, participant)
    assert begin(store, participant, NOON + HOUR) == session
    assert store.session(participant.name) == session


def test_many_at_once_get_different_places(store: Store) -> None:
    people = [invite(store) for _ in range(12)]
    with ThreadPoolExecutor(6) as crowd:
        sessions = list(crowd.map(lambda person: begin(store, person), people))
    assert sorted(session.plan.slot for session in sessions) == list(range(12))


def test_abandoned_and_test_sessions_free_their_places(store: Store) -> None:
    begin(store, invite(store, "test"))
    gone = begin(store, invite(store))
    assert gone.plan.slot == 0
    assert begin(store, invite(store)).plan.slot == 1
    assert begin(store, invite(store), NOON + 2 * HOUR).plan.slot == 0
    assert store.session(gone.participant) == gone, "whoever comes back keeps what was drawn"


def test_an_answer_sent_again_is_stored_once(store: Store) -> None:
    session = begin(store, invite(store))
    pages = steps(session.plan)
    submission = Submission(id=uuid4(), step=pages[0].key, on_page_ms=1)
    verdicts = [send(store, session, submission) for _ in range(3)]
    assert verdicts == [Verdict.STORE, Verdict.KNOWN, Verdict.KNOWN]
    assert answer(store, session, pages[0].key) is Verdict.ELSEWHERE
    assert answer(store, session, pages[2].key) is Verdict.NOT_YET
    [(_, responses)] = store.responses("participant")
    assert [response.submission for response in responses] == [submission]


def test_two_tabs_at_once_leave_one_answer(store: Store) -> None:
    session = begin(store, invite(store))
    with ThreadPoolExecutor(4) as crowd:
        verdicts = list(crowd.map(lambda _: answer(store, session, "demographics"), range(4)))
    assert sorted(verdict.value for verdict in verdicts) == ["elsewhere"] * 3 + ["store"]


def test_the_last_answer_completes_the_session(store: Store) -> None:
    session = begin(store, invite(store))
    for page in steps(session.plan):
        kept = store.session(session.participant)
        assert kept is not None
        assert kept.completed_at is None
        assert answer(store, session, page.key, NOON + HOUR) is Verdict.STORE
    kept = store.session(session.participant)
    assert kept is not None
    assert kept.completed_at == NOON + HOUR


def test_a_withdrawal_leaves_nothing_but_a_dated_note(store: Store) -> None:
    session = begin(store, invite(store))
    stays = begin(store, invite(store))
    store.show_page(visit_of(store, session), "demographics", now=NOON)
    answer(store, session, "demographics")
    answer(store, stays, "demographics")
    store.log("video_failed", "clip", participant=session.participant, now=NOON)
    assert store.participant_with_code(session.completion_code) == session.participant
    store.withdraw(session.participant, now=NOON)
    assert [kept.participant for kept, _ in store.responses("participant")] == [stays.participant]
    assert store.event_counts("video_failed") == {}
    assert store.participant_with_code(session.completion_code) is None
    [note] = store.withdrawals()
    assert (note.participant, note.at, note.responses) == (session.participant, NOON, 1)


def test_who_was_sent_twice_is_one_participant_and_keeps_their_session(store: Store) -> None:
    contact = Contact(source="prolific", external_id="5f0c")
    first = new_participant("token", kind="participant", created_at=NOON)
    store.recruit(first, contact)
    session = begin(store, first)
    again = new_participant("another token", kind="participant", created_at=NOON)
    store.recruit(again, contact)
    returned = store.participant(token_sha256("another token"))
    assert returned is not None
    assert store.session(returned.name) == session
    assert store.contact(returned.name) == contact
    assert [row.contact for row in store.progress()] == [contact]


def test_a_contact_is_deleted_with_the_answers(store: Store) -> None:
    participant = new_participant(new_token(), kind="participant", created_at=NOON)
    store.add_participant(participant, Contact(note="Ada"))
    assert store.contact(participant.name).note == "Ada"
    store.withdraw(participant.name, now=NOON)
    assert store.contact(participant.name) == Contact()


def test_a_study_stays_paused_until_it_is_resumed(store: Store) -> None:
    seen = [store.phase]
    phases: list[Phase] = ["paused", "open", "closed"]
    for phase in phases:
        store.enter_phase(phase, now=NOON)
        seen.append(store.phase)
    assert seen == ["open", "paused", "open", "closed"]


def test_answers_are_counted_from_a_moment_on_and_tests_are_not(store: Store) -> None:
    session, other = begin(store, invite(store)), begin(store, invite(store, "test"))
    answer(store, other, "demographics", NOON)
    for number, page in enumerate(steps(session.plan)):
        answer(store, session, page.key, NOON + number * HOUR)
    assert store.answered_since(NOON + HOUR, "participant") == [NOON + HOUR, NOON + 2 * HOUR, NOON + 3 * HOUR]


def test_a_page_is_first_shown_once(store: Store) -> None:
    session = begin(store, invite(store))
    store.show_page(visit_of(store, session), "demographics", now=NOON)
    answer(store, session, "demographics", NOON + HOUR)
    for _ in range(2):  # as remembered, then as read
        visit = visit_of(store, session)
        assert visit.shown_at("demographics") == NOON
        assert visit.shown_at("part:1") == NOON + HOUR, "not before the page before it was answered"
        store.recruit(new_participant(new_token(), kind="test", created_at=NOON), Contact())


def test_sqlite_is_set_to_lose_nothing(tmp_path: Path) -> None:
    store = open_store(f"sqlite:///{tmp_path}/study.db")
    with store._engine.begin() as db:
        for name, value in {
            "journal_mode": "wal",
            "synchronous": 2,
            "foreign_keys": 1,
            "secure_delete": 1,
        }.items():
            assert db.exec_driver_sql(f"PRAGMA {name}").scalar() == value
    store.close()


def test_a_database_is_served_by_one_at_a_time(url: str, store: Store) -> None:
    other = open_store(url)
    with (
        store.held(),
        pytest.raises(InputError, match=rf"is being served by .*process {os.getpid()} on"),
        other.held(),
    ):
        pass
    with other.held():
        pass
    other.close()


def test_an_id_is_taken_once(store: Store) -> None:
    first, second = begin(store, invite(store)), begin(store, invite(store))
    submission = Submission(id=uuid4(), step="demographics", on_page_ms=1)
    assert send(store, first, submission) is Verdict.STORE
    again = submission.model_copy(update={"step": "instructions:part"})
    assert send(store, first, again) is Verdict.NOT_YET
    with pytest.raises(IntegrityError):
        send(store, second, submission)
    assert answer(store, second, "demographics") is Verdict.STORE, "a neighbour's fault loses nothing"


@pytest.mark.parametrize("url", ["study.db", "mysql://localhost/study"])
def test_an_unknown_database_is_refused_by_name(url: str) -> None:
    with pytest.raises(InputError, match=r"sqlite"):
        open_store(url)
