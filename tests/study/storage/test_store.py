"""The same laws for every kind of database that can be started here."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from uuid import uuid4

import pytest
import sqlalchemy as sa

from stimuli.errors import InputError
from study.orders import Plan, Trial
from study.participants import (
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

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
HOUR = timedelta(hours=1)


@pytest.fixture(scope="module")
def postgresql(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A PostgreSQL of our own; Debian keeps its programs out of the path."""
    found = [shutil.which("initdb"), *sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"))]
    programs = Path(next(path for path in found if path)).resolve().parent
    folder = tmp_path_factory.mktemp("postgresql")
    as_user = []
    if os.geteuid() == 0:  # it refuses to run as root
        for path in (folder, *folder.parents[:2]):
            path.chmod(0o755)
        shutil.chown(folder, "postgres")
        as_user = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"]
    data = folder / "data"
    run = [*as_user, str(programs / "initdb"), "-D", str(data), "-U", "study", "-A", "trust", "-N"]
    subprocess.run(run, check=True, capture_output=True, cwd=folder)
    options = f"-k {folder} -c listen_addresses=''"
    control = [*as_user, str(programs / "pg_ctl"), "-D", str(data), "-w"]
    subprocess.run(
        [*control, "-l", str(folder / "log"), "-o", options, "start"],
        check=True,
        cwd=folder,
        stdout=subprocess.DEVNULL,
    )
    yield f"postgresql://study@/postgres?host={folder}"
    subprocess.run([*control, "-m", "immediate", "stop"], check=True, cwd=folder, stdout=subprocess.DEVNULL)


@pytest.fixture(params=["sqlite", "postgresql"])
def store(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Store]:
    url = f"sqlite:///{tmp_path}/study.db"
    if request.param == "postgresql":
        server = request.getfixturevalue("postgresql")
        name = f"d{uuid4().hex}"
        engine = sa.create_engine(
            server.replace("postgresql:", "postgresql+psycopg:"), isolation_level="AUTOCOMMIT"
        )
        with engine.connect() as db:
            db.execute(sa.text(f"CREATE DATABASE {name}"))
        engine.dispose()
        url = server.replace("/postgres?", f"/{name}?")
    opened = open_store(url)
    yield opened
    opened.close()


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
    return store.add_response(session.participant, submission, steps=steps(session.plan), now=now)


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
    verdicts = [store.add_response(session.participant, submission, steps=pages, now=NOON) for _ in range(3)]
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
    store.show_page(session.participant, "demographics", now=NOON)
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


def test_a_page_is_first_shown_once(store: Store) -> None:
    session = begin(store, invite(store))
    assert store.show_page(session.participant, "demographics", now=NOON) == NOON
    assert store.show_page(session.participant, "demographics", now=NOON + HOUR) == NOON


def test_sqlite_is_set_to_lose_nothing(tmp_path: Path) -> None:
    store = open_store(f"sqlite:///{tmp_path}/study.db")
    with store._read.begin() as db:
        for name, value in {
            "journal_mode": "wal",
            "synchronous": 2,
            "foreign_keys": 1,
            "secure_delete": 1,
        }.items():
            assert db.exec_driver_sql(f"PRAGMA {name}").scalar() == value
    store.close()


@pytest.mark.parametrize("url", ["study.db", "mysql://localhost/study"])
def test_an_unknown_database_is_refused_by_name(url: str) -> None:
    with pytest.raises(InputError, match=r"sqlite"):
        open_store(url)
