"""The store: everything that is written down about participants, and the only place that writes it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any, Literal, cast, get_args
from uuid import UUID

from sqlalchemy import Connection, Engine, RowMapping, func, insert, or_, select, update

from study.orders import assign_slot
from study.participants import Contact, Kind, Participant
from study.responses import Response, Submission
from study.sessions import Session, Step, Verdict, judge, next_step, plan_json, read_plan
from study.storage.migrations import bring_up_to_date
from study.storage.tables import contacts, events, pages, participants, responses, sessions, withdrawals

Phase = Literal["open", "paused", "closed"]


@dataclass(frozen=True)
class Progress:
    """How far one participant has come."""

    participant: Participant
    contact: Contact
    session: Session | None
    answered: tuple[str, ...]  # keys of steps, in the order answered
    active_at: datetime | None


@dataclass(frozen=True)
class Visit:
    """All that is known of whoever asks for a page or sends one, read at one moment."""

    participant: Participant
    session: Session | None
    answered: dict[str, UUID]  # steps already answered, and the submissions that answered them
    phase: Phase


@dataclass(frozen=True)
class Withdrawal:
    """The dated note that stays when a participant's data are deleted."""

    participant: str
    at: datetime
    responses: int


@dataclass(frozen=True)
class Event:
    """Something that happened, such as a video that failed."""

    at: datetime
    participant: str | None
    name: str
    detail: str


class Store:
    """Participants, sessions and responses in a database. Every method is one transaction."""

    def __init__(self, engine: Engine) -> None:
        self._read = engine
        self._write = engine.execution_options(writes=True)
        self._assign = engine.execution_options(writes=True, assigns=True)
        with self._assign.begin() as db:
            bring_up_to_date(db)

    @property
    def kind(self) -> str:
        """The kind of database: sqlite, postgresql."""
        return self._read.dialect.name

    @property
    def file(self) -> Path | None:
        """Where the database is one file: which."""
        name = self._read.url.database
        return Path(name) if self.kind == "sqlite" and name else None

    def close(self) -> None:
        """Close all connections."""
        self._read.dispose()

    # Participants

    def add_participant(self, participant: Participant, contact: Contact | None = None) -> None:
        """Write down somebody invited, and apart from that what may say who they are."""
        with self._write.begin() as db:
            db.execute(insert(participants).values(vars(participant)))
            if contact is not None:
                db.execute(insert(contacts).values(**vars(contact), participant=participant.name))

    def recruit(self, participant: Participant, contact: Contact) -> None:
        """Write down somebody whom a recruitment service sent; if it sent them before, they are the same."""
        with self._assign.begin() as db:
            known = select(contacts.c.participant).where(
                contacts.c.source == contact.source, contacts.c.external_id == contact.external_id
            )
            if name := db.execute(known).scalar():
                token = {"token_sha256": participant.token_sha256}
                db.execute(update(participants).where(participants.c.name == name).values(token))
            else:
                db.execute(insert(participants).values(vars(participant)))
                db.execute(insert(contacts).values(**vars(contact), participant=participant.name))

    def participant(self, token_sha256: str) -> Participant | None:
        """The participant with the link of that token."""
        with self._read.begin() as db:
            query = select(participants).where(participants.c.token_sha256 == token_sha256)
            row = db.execute(query).mappings().first()
        return None if row is None else Participant(**row)

    def contact(self, participant: str) -> Contact:
        """What may say who they are."""
        with self._read.begin() as db:
            query = select(contacts).where(contacts.c.participant == participant)
            row = db.execute(query).mappings().first()
        return _read_contact(row)

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
        with self._assign.begin() as db:
            if (known := _session(db, participant.name)) is not None:
                return known
            holders = (
                select(sessions.c.slot)
                .join(participants, participants.c.name == sessions.c.participant)
                .where(participants.c.kind == participant.kind)
                .where(or_(sessions.c.completed_at.is_not(None), sessions.c.active_at > now - stale_after))
            )
            session = draw(assign_slot(Counter(db.execute(holders).scalars())))
            values = vars(session) | {
                "plan": plan_json(session.plan),
                "slot": session.plan.slot,
                "seed": session.plan.seed,
                "algorithm": session.plan.algorithm,
                "active_at": now,
            }
            db.execute(insert(sessions).values(values))
            return session

    def visit(self, token_sha256: str) -> Visit | None:
        """Whoever has the link of that token, how far they have come, and whether the study is open."""
        with self._read.begin() as db:
            known = select(participants).where(participants.c.token_sha256 == token_sha256)
            row = db.execute(known).mappings().first()
            if row is None:
                return None
            session = _session(db, row["name"])
            answered = _answered(db, row["name"]) if session else {}
            return Visit(Participant(**row), session, answered, _phase(db))

    def session(self, participant: str) -> Session | None:
        """The participant's session, if they have consented."""
        with self._read.begin() as db:
            return _session(db, participant)

    def show_page(self, participant: str, step: str, *, now: datetime) -> datetime:
        """Note that a page is handed out; return when it first was."""
        shown = select(pages.c.shown_at).where(pages.c.participant == participant, pages.c.step == step)
        with self._read.begin() as db:
            first: datetime | None = db.execute(shown).scalar()
        if first is not None:
            return first
        with self._write.begin() as db:
            first = db.execute(shown).scalar()  # another tab may have been quicker
            if first is None:
                db.execute(insert(pages).values(participant=participant, step=step, shown_at=now))
            return first or now

    # Responses

    def add_response(
        self, participant: str, submission: Submission, *, steps: Sequence[Step], now: datetime
    ) -> Verdict:
        """Store an answered page, if it is due. When this returns STORE or KNOWN the answer is on disk."""
        with self._write.begin() as db:
            lock = select(sessions.c.participant).where(sessions.c.participant == participant)
            db.execute(lock.with_for_update())  # of no effect in SQLite, which has one writer
            answered = _answered(db, participant)
            verdict = judge(submission.id, submission.step, pages=steps, answered=answered)
            if verdict is not Verdict.STORE:
                return verdict
            content = submission.model_dump(mode="json")
            row = {name: content[name] for name in ("id", "step", "on_page_ms", "answers", "views")}
            db.execute(insert(responses).values(**row, participant=participant, answered_at=now))
            done = next_step(steps, {*answered, submission.step}) is None
            db.execute(
                update(sessions)
                .where(sessions.c.participant == participant)
                .values(active_at=now, **({"completed_at": now} if done else {}))
            )
            return verdict

    def given(self, participant: str) -> dict[str, set[str]]:
        """What a participant answered so far, by item; practice does not count."""
        with self._read.begin() as db:
            query = select(responses.c.step, responses.c.answers).where(
                responses.c.participant == participant
            )
            given: dict[str, set[str]] = {}
            for step, answers in db.execute(query):
                for answer in answers if not step.startswith("practice:") else ():
                    given.setdefault(answer["item"], set()).add(answer["value"])
            return given

    def protocol_hashes(self, kind: Kind = "participant") -> set[str]:
        """The protocols that sessions of a kind were begun with."""
        with self._read.begin() as db:
            query = select(sessions.c.protocol_sha256).distinct()
            query = query.join(participants, participants.c.name == sessions.c.participant)
            return set(db.execute(query.where(participants.c.kind == kind)).scalars())

    def responses(self, kind: Kind) -> Iterator[tuple[Session, list[Response]]]:
        """All sessions of a kind with their responses in the order given; one session at a time."""
        with self._read.begin() as db:
            rows = (
                db.execute(
                    select(sessions)
                    .join(participants, participants.c.name == sessions.c.participant)
                    .where(participants.c.kind == kind)
                    .order_by(sessions.c.begun_at, sessions.c.participant)
                )
                .mappings()
                .all()
            )
            for row in rows:
                yield _read_session(row), _responses(db, row["participant"])

    # What the experimenter sees

    def progress(self) -> list[Progress]:
        """How far everybody has come, the newest first."""
        with self._read.begin() as db:
            people = (
                db.execute(select(participants).order_by(participants.c.created_at.desc())).mappings().all()
            )
            begun = {row["participant"]: row for row in db.execute(select(sessions)).mappings()}
            known = {row["participant"]: row for row in db.execute(select(contacts)).mappings()}
            steps: dict[str, list[str]] = {}
            order = select(responses.c.participant, responses.c.step).order_by(responses.c.answered_at)
            for name, step in db.execute(order):
                steps.setdefault(name, []).append(step)
        return [
            Progress(
                participant=Participant(**person),
                contact=_read_contact(known.get(person["name"])),
                session=_read_session(row) if (row := begun.get(person["name"])) else None,
                answered=tuple(steps.get(person["name"], ())),
                active_at=None if row is None else row["active_at"],
            )
            for person in people
        ]

    def log(self, name: str, detail: str, *, participant: str | None, now: datetime) -> None:
        """Write down something that happened, such as a video that failed."""
        with self._write.begin() as db:
            db.execute(insert(events).values(participant=participant, at=now, name=name, detail=detail))

    def event_counts(self, name: str) -> dict[str, int]:
        """How often something happened to each participant."""
        with self._read.begin() as db:
            query = select(events.c.participant, func.count()).where(events.c.name == name)
            return {who: count for who, count in db.execute(query.group_by(events.c.participant)) if who}

    def events(self, names: Collection[str], *, most: int) -> list[Event]:
        """The latest events of these names, the newest first."""
        with self._read.begin() as db:
            columns = (events.c.at, events.c.participant, events.c.name, events.c.detail)
            query = select(*columns).where(events.c.name.in_(names)).order_by(events.c.number.desc())
            return [Event(*row) for row in db.execute(query.limit(most))]

    def answered_since(self, moment: datetime, kind: Kind) -> list[datetime]:
        """When pages were answered since a moment, the oldest first."""
        with self._read.begin() as db:
            query = (
                select(responses.c.answered_at)
                .join(participants, participants.c.name == responses.c.participant)
                .where(responses.c.answered_at >= moment, participants.c.kind == kind)
                .order_by(responses.c.answered_at)
            )
            return list(db.execute(query).scalars())

    # Whether the study runs

    @property
    def phase(self) -> Phase:
        """Open unless the experimenter paused or closed the study."""
        with self._read.begin() as db:
            return _phase(db)

    def enter_phase(self, phase: Phase, *, now: datetime) -> None:
        """Pause, resume or close the study; it stays so when the server starts again."""
        self.log(phase, "", participant=None, now=now)

    # Withdrawal

    def withdraw(self, participant: str, *, now: datetime) -> None:
        """Delete everything about a participant but their name, and leave a dated note."""
        with self._write.begin() as db:
            count = select(func.count()).where(responses.c.participant == participant)
            deleted = db.execute(count).scalar_one()
            db.execute(
                participants.delete().where(participants.c.name == participant)
            )  # and all that refers to it
            db.execute(insert(withdrawals).values(participant=participant, at=now, responses=deleted))

    def participant_with_code(self, completion_code: str) -> str | None:
        """Whose completion code this is."""
        with self._read.begin() as db:
            query = select(sessions.c.participant).where(sessions.c.completion_code == completion_code)
            return db.execute(query).scalar()

    def withdrawals(self) -> list[Withdrawal]:
        """Notes of all withdrawals, the oldest first."""
        with self._read.begin() as db:
            columns = (withdrawals.c.participant, withdrawals.c.at, withdrawals.c.responses)
            return [Withdrawal(*row) for row in db.execute(select(*columns).order_by(withdrawals.c.number))]


def _phase(db: Connection) -> Phase:
    entered = select(events.c.name).where(events.c.participant.is_(None), events.c.name.in_(get_args(Phase)))
    last = db.execute(entered.order_by(events.c.number.desc()).limit(1)).scalar()
    return cast("Phase", last or "open")


def _read_contact(row: RowMapping | None) -> Contact:
    return Contact() if row is None else Contact(row["note"], row["source"], row["external_id"])


def _session(db: Connection, participant: str) -> Session | None:
    query = select(sessions).where(sessions.c.participant == participant)
    row = db.execute(query).mappings().first()
    return None if row is None else _read_session(row)


def _read_session(row: RowMapping) -> Session:
    kept = set(Session.__dataclass_fields__) & set(row)
    fields = {name: row[name] for name in kept}
    return Session(**fields | {"plan": read_plan(row["plan"])})


def _answered(db: Connection, participant: str) -> dict[str, UUID]:
    query = select(responses.c.step, responses.c.id).where(responses.c.participant == participant)
    return {step: UUID(id_) for step, id_ in db.execute(query)}


def _responses(db: Connection, participant: str) -> list[Response]:
    shown = (pages.c.participant == responses.c.participant) & (pages.c.step == responses.c.step)
    query = (
        select(responses, pages.c.shown_at)
        .outerjoin(pages, shown)
        .where(responses.c.participant == participant)
        .order_by(responses.c.answered_at)
    )
    return [_read_response(row) for row in db.execute(query).mappings()]


def _read_response(row: RowMapping) -> Response:
    content = cast(
        "dict[str, Any]", {name: row[name] for name in ("id", "step", "on_page_ms", "answers", "views")}
    )
    return Response(
        submission=Submission.model_validate(content),
        shown_at=row["shown_at"] or row["answered_at"],
        answered_at=row["answered_at"],
    )
