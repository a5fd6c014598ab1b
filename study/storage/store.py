"""The store: everything that is written down about participants, and the only place that writes it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, cast
from uuid import UUID

from sqlalchemy import Connection, Engine, RowMapping, func, insert, or_, select, update

from study.orders import assign_slot
from study.participants import Kind, Participant
from study.responses import Response, Submission
from study.sessions import Session, Step, Verdict, judge, next_step, plan_json, read_plan
from study.storage.tables import events, metadata, pages, participants, responses, sessions, withdrawals


@dataclass(frozen=True)
class Progress:
    """How far one participant has come."""

    participant: Participant
    session: Session | None
    answered: tuple[str, ...]  # keys of steps, in the order answered
    active_at: datetime | None


@dataclass(frozen=True)
class Withdrawal:
    """The dated note that stays when a participant's data are deleted."""

    participant: str
    at: datetime
    responses: int


class Store:
    """Participants, sessions and responses in a database. Every method is one transaction."""

    def __init__(self, engine: Engine) -> None:
        self._read = engine
        self._write = engine.execution_options(writes=True)
        self._assign = engine.execution_options(writes=True, assigns=True)
        metadata.create_all(self._assign)

    def close(self) -> None:
        """Close all connections."""
        self._read.dispose()

    # Participants

    def add_participant(self, participant: Participant) -> None:
        """Write down somebody invited."""
        with self._write.begin() as db:
            db.execute(insert(participants).values(vars(participant)))

    def participant(self, token_sha256: str) -> Participant | None:
        """The participant with the link of that token."""
        with self._read.begin() as db:
            row = (
                db.execute(select(participants).where(participants.c.token_sha256 == token_sha256))
                .mappings()
                .first()
            )
        return None if row is None else Participant(**row)

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

    def session(self, participant: str) -> Session | None:
        """The participant's session, if they have consented."""
        with self._read.begin() as db:
            return _session(db, participant)

    def answered(self, participant: str) -> dict[str, UUID]:
        """Steps already answered, and the submissions that answered them."""
        with self._read.begin() as db:
            return _answered(db, participant)

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
            steps: dict[str, list[str]] = {}
            order = select(responses.c.participant, responses.c.step).order_by(responses.c.answered_at)
            for name, step in db.execute(order):
                steps.setdefault(name, []).append(step)
        return [
            Progress(
                participant=Participant(**person),
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
