"""The store: everything that is written down about participants, and the only place that writes it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Literal, cast, get_args
from uuid import UUID

from sqlalchemy import Connection, bindparam, exists, func, insert, or_, select, update

from study.orders import assign_slot
from study.participants import Contact, Participant
from study.responses import Submission
from study.sessions import Session, Step, Verdict, judge, next_step, plan_json
from study.storage.archive import Archive, given_in, read_session, values_in
from study.storage.database import Database
from study.storage.migrations import bring_up_to_date
from study.storage.tables import contacts, events, pages, participants, responses, sessions, withdrawals
from study.storage.writer import Transaction, Writer

Phase = Literal["open", "paused", "closed"]


@dataclass
class Visit:
    """All that is known of somebody under way. The store keeps it up to date with what it writes."""

    participant: Participant
    session: Session | None = None
    answered: dict[str, UUID] = field(default_factory=dict)  # steps, and the submissions that answered them
    given: dict[str, set[str]] = field(default_factory=dict)  # answers by item; practice does not count
    shown: dict[str, datetime] = field(default_factory=dict)  # when the server first handed out a page
    answered_at: datetime | None = None  # the latest

    def shown_at(self, step: str) -> datetime | None:
        """When a page was first handed out; if that was not kept, it was after all earlier pages."""
        begun_at = self.session.begun_at if self.session else None
        return self.shown.get(step, self.answered_at or begun_at)


class Store(Archive):
    """Adds to what is written down. Whatever a method says is done is on disk.

    Those under way are remembered, so that showing a page reads nothing from the disk. This holds as long as
    nobody else writes to the database, which `held` sees to.
    """

    def __init__(self, database: Database) -> None:
        super().__init__(database.engine)
        self._database = database
        writing = database.engine.execution_options(writes=True)
        with writing.begin() as db:
            bring_up_to_date(db)
            self._phase = _phase(db)
        self._writer = Writer(writing)
        self._visits: dict[str, Visit] = {}  # by the hash of the token

    def held(self) -> AbstractContextManager[object]:
        """Let nobody else serve this database for as long as the block lasts."""
        return self._database.held()

    def close(self) -> None:
        """Write what is under way, and close all connections."""
        self._writer.close()
        self._engine.dispose()

    # Participants

    def add_participant(self, participant: Participant, contact: Contact | None = None) -> None:
        """Write down somebody invited, and apart from that what may say who they are."""
        self._writer.now(lambda transaction: _add_participant(transaction.db, participant, contact))

    def recruit(self, participant: Participant, contact: Contact) -> None:
        """Write down somebody whom a recruitment service sent; if it sent them before, they are the same."""

        def job(transaction: Transaction) -> None:
            db = transaction.db
            known = select(contacts.c.participant).where(
                contacts.c.source == contact.source, contacts.c.external_id == contact.external_id
            )
            if name := db.execute(known).scalar():
                token = {"token_sha256": participant.token_sha256}
                db.execute(update(participants).where(participants.c.name == name).values(token))
            else:
                _add_participant(db, participant, contact)

        self._writer.now(job, then=lambda _: self.forget())

    # Sessions

    def begin_session(
        self,
        participant: Participant,
        draw: Callable[[int], Session],
        *,
        now: datetime,
        stale_after: timedelta,
    ) -> Session:
        """Give the participant a place in the design and keep all that was drawn for it, once.

        Places of sessions that are neither completed nor active within `stale_after` are free again; whoever
        comes back to such a session keeps it all the same.
        """

        def job(transaction: Transaction) -> tuple[Session, bool]:
            db = transaction.db
            if (known := read_session(db, participant.name)) is not None:
                return known, False
            taken = db.execute(HOLDERS, {"kind": participant.kind, "since": now - stale_after}).scalars()
            session = draw(assign_slot(Counter(taken)))
            values = vars(session) | {
                "plan": plan_json(session.plan),
                "slot": session.plan.slot,
                "seed": session.plan.seed,
                "algorithm": session.plan.algorithm,
            }
            db.execute(BEGIN, values)
            return session, True

        def remember(begun: tuple[Session, bool]) -> None:
            session, is_new = begun
            if is_new:
                self._visits[participant.token_sha256] = Visit(participant, session)

        return self._writer.now(job, then=remember)[0]

    def remembered(self, token_sha256: str) -> Visit | None:
        """Whoever has the link of that token, if they are under way."""
        return self._visits.get(token_sha256)

    def _latest(self, visit: Visit) -> Visit:
        """What is remembered of somebody now: two who asked at once were told the same twice."""
        return self._visits.get(visit.participant.token_sha256, visit)

    def forget(self) -> None:
        """Read everybody anew when they come again."""
        self._visits.clear()

    def visit(self, token_sha256: str) -> Future[Visit | None]:
        """Whoever has the link of that token, read and from now on remembered."""

        def remember(visit: Visit | None) -> None:
            if visit is not None and visit.session and not visit.session.completed_at:
                self._visits[token_sha256] = visit

        return self._writer.soon(lambda transaction: _read_visit(transaction.db, token_sha256), then=remember)

    def show_page(self, visit: Visit, step: str, *, now: datetime) -> None:
        """Note that a page is handed out for the first time. Nobody waits for this to be on disk."""
        visit.shown[step] = now
        row = {"participant": visit.participant.name, "step": step, "shown_at": now}
        self._writer.soon(lambda transaction: transaction.add(SHOW, row))

    # Responses

    def add_response(
        self, visit: Visit, submission: Submission, *, steps: Sequence[Step], now: datetime
    ) -> Future[Verdict]:
        """Store an answered page, if it is due. With STORE or KNOWN the answer is on disk."""
        name = visit.participant.name

        def job(transaction: Transaction) -> Verdict:
            answered = self._latest(visit).answered
            verdict = judge(submission.id, submission.step, pages=steps, answered=answered)
            if verdict is Verdict.STORE:
                row = vars(submission) | {"id": str(submission.id), "participant": name, "answered_at": now}
                transaction.add(ANSWER, row)
                if next_step(steps, {*answered, submission.step}) is None:
                    transaction.add(COMPLETED, {"name": name, "now": now})
            return verdict

        def update_visit(verdict: Verdict) -> None:
            if verdict is Verdict.STORE:
                latest = self._latest(visit)
                latest.answered[submission.step] = submission.id
                latest.answered_at = now
                for item, values in given_in([(submission.step, submission.values)]).items():
                    latest.given.setdefault(item, set()).update(values)
                if next_step(steps, latest.answered) is None:
                    self._visits.pop(visit.participant.token_sha256, None)

        return self._writer.soon(job, then=update_visit)

    def log(self, name: str, detail: str, *, participant: str | None, now: datetime) -> Future[None]:
        """Write down something that happened, such as a video that failed."""
        row = {"participant": participant, "at": now, "name": name, "detail": detail}
        return self._writer.soon(lambda transaction: transaction.add(HAPPEN, row))

    @property
    def is_preparing(self) -> bool:
        """Whether answers are being made ready for the disk."""
        return self._writer.is_preparing

    # Whether the study runs

    @property
    def phase(self) -> Phase:
        """Open unless the experimenter paused or closed the study."""
        return self._phase

    def enter_phase(self, phase: Phase, *, now: datetime) -> None:
        """Pause, resume or close the study; it stays so when the server starts again."""
        self.log(phase, "", participant=None, now=now).result()
        self._phase = phase

    def close_when(self, completed: int, *, now: datetime) -> Future[bool]:
        """Close the study once so many participants have completed it; opened again by hand it stays open."""

        def job(transaction: Transaction) -> bool:
            db = transaction.db
            if db.execute(select(events.c.number).where(events.c.detail == COMPLETE)).first():
                return False
            done = (
                select(func.count())
                .select_from(sessions)
                .join(participants, participants.c.name == sessions.c.participant)
                .where(participants.c.kind == "participant", sessions.c.completed_at.is_not(None))
            )
            if db.execute(done).scalar_one() < completed:
                return False
            db.execute(HAPPEN, {"participant": None, "at": now, "name": "closed", "detail": COMPLETE})
            return True

        def close(complete: bool) -> None:
            if complete:
                self._phase = "closed"

        return self._writer.soon(job, then=close)

    # Withdrawal

    def withdraw(self, participant: str, *, now: datetime) -> None:
        """Delete everything about a participant but their name, from the disk too, and leave a dated note."""

        def job(transaction: Transaction) -> None:
            db = transaction.db
            count = select(func.count()).where(responses.c.participant == participant)
            deleted = db.execute(count).scalar_one()
            gone = db.execute(  # and all that refers to it
                participants.delete().where(participants.c.name == participant)
            )
            if gone.rowcount:  # else they were deleted before: a double click
                db.execute(insert(withdrawals), {"participant": participant, "at": now, "responses": deleted})

        self._writer.now(job, then=lambda _: self.forget())
        self._database.purge()


COMPLETE = "as many as planned have completed"  # beside "closed", where the protocol closed the study

# What every page reads or writes, made once: making a statement takes longer than executing it.
SHOW = insert(pages)
ANSWER = insert(responses)
HAPPEN = insert(events)
COMPLETED = (
    update(sessions).where(sessions.c.participant == bindparam("name")).values(completed_at=bindparam("now"))
)
BEGIN = insert(sessions)
HOLDERS = (  # the places of sessions that are completed or active
    select(sessions.c.slot)
    .join(participants, participants.c.name == sessions.c.participant)
    .where(participants.c.kind == bindparam("kind"))
    .where(
        or_(
            sessions.c.completed_at.is_not(None),
            sessions.c.begun_at > bindparam("since"),
            exists().where(
                responses.c.participant == sessions.c.participant,
                responses.c.answered_at > bindparam("since"),
            ),
        )
    )
)
WITH_TOKEN = select(participants).where(participants.c.token_sha256 == bindparam("token"))
ANSWERED = select(responses.c.step, responses.c.id, responses.c.answers, responses.c.answered_at).where(
    responses.c.participant == bindparam("name")
)
SHOWN = select(pages.c.step, pages.c.shown_at).where(pages.c.participant == bindparam("name"))


def _add_participant(db: Connection, participant: Participant, contact: Contact | None) -> None:
    db.execute(insert(participants), vars(participant))
    if contact is not None:
        db.execute(insert(contacts), vars(contact) | {"participant": participant.name})


def _read_visit(db: Connection, token_sha256: str) -> Visit | None:
    row = db.execute(WITH_TOKEN, {"token": token_sha256}).mappings().first()
    if row is None:
        return None
    participant = Participant(**row)
    session = read_session(db, participant.name)
    if session is None:
        return Visit(participant)
    answered = db.execute(ANSWERED, {"name": participant.name}).all()
    return Visit(
        participant,
        session,
        answered={row.step: UUID(row.id) for row in answered},
        given=given_in((row.step, values_in(row.answers)) for row in answered),
        shown={row.step: row.shown_at for row in db.execute(SHOWN, {"name": participant.name})},
        answered_at=max((row.answered_at for row in answered), default=None),
    )


def _phase(db: Connection) -> Phase:
    entered = select(events.c.name).where(events.c.participant.is_(None), events.c.name.in_(get_args(Phase)))
    last = db.execute(entered.order_by(events.c.number.desc()).limit(1)).scalar()
    return cast("Phase", last or "open")
