"""What was written down about participants, read back. Nothing here changes anything."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, cast

from sqlalchemy import Connection, Engine, RowMapping, bindparam, func, select

from study.participants import Contact, Kind, Participant
from study.responses import Response, Submission
from study.sessions import PRACTICE, Session, read_plan
from study.storage.tables import contacts, events, pages, participants, responses, sessions, withdrawals


@dataclass(frozen=True)
class Progress:
    """How far one participant has come."""

    participant: Participant
    contact: Contact
    session: Session | None
    answered: tuple[str, ...]  # keys of steps, in the order answered
    active_at: datetime | None


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


class Archive:
    """Participants, sessions and responses in a database. Every method reads one moment."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @property
    def kind(self) -> str:
        """The kind of database: sqlite, postgresql."""
        return self._engine.dialect.name

    @property
    def file(self) -> Path | None:
        """Where the database is one file: which."""
        name = self._engine.url.database
        return Path(name) if self.kind == "sqlite" and name else None

    # Participants

    def participant(self, token_sha256: str) -> Participant | None:
        """The participant with the link of that token."""
        with self._engine.begin() as db:
            query = select(participants).where(participants.c.token_sha256 == token_sha256)
            row = db.execute(query).mappings().first()
        return None if row is None else Participant(**row)

    def contact(self, participant: str) -> Contact:
        """What may say who they are."""
        with self._engine.begin() as db:
            query = select(contacts).where(contacts.c.participant == participant)
            row = db.execute(query).mappings().first()
        return _read_contact(row)

    def participant_with_code(self, completion_code: str) -> str | None:
        """Whose completion code this is."""
        with self._engine.begin() as db:
            query = select(sessions.c.participant).where(sessions.c.completion_code == completion_code)
            return db.execute(query).scalar()

    def withdrawals(self) -> list[Withdrawal]:
        """Notes of all withdrawals, the oldest first."""
        with self._engine.begin() as db:
            columns = (withdrawals.c.participant, withdrawals.c.at, withdrawals.c.responses)
            return [Withdrawal(*row) for row in db.execute(select(*columns).order_by(withdrawals.c.number))]

    # Sessions and responses

    def session(self, participant: str) -> Session | None:
        """The participant's session, if they have consented."""
        with self._engine.begin() as db:
            return read_session(db, participant)

    def given(self, participant: str) -> dict[str, set[str]]:
        """What a participant answered so far, by item; practice does not count."""
        with self._engine.begin() as db:
            query = select(responses.c.step, responses.c.answers).where(
                responses.c.participant == participant
            )
            return given_in((step, values_in(answers)) for step, answers in db.execute(query))

    def protocol_hashes(self, kind: Kind = "participant") -> set[str]:
        """The protocols that sessions of a kind were begun with."""
        with self._engine.begin() as db:
            query = select(sessions.c.protocol_sha256).distinct()
            query = query.join(participants, participants.c.name == sessions.c.participant)
            return set(db.execute(query.where(participants.c.kind == kind)).scalars())

    def responses(self, kind: Kind) -> Iterator[tuple[Session, list[Response]]]:
        """All sessions of a kind with their responses in the order given; one session at a time."""
        with self._engine.begin() as db:
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
        with self._engine.begin() as db:
            people = (
                db.execute(select(participants).order_by(participants.c.created_at.desc())).mappings().all()
            )
            begun = {row["participant"]: row for row in db.execute(select(sessions)).mappings()}
            known = {row["participant"]: row for row in db.execute(select(contacts)).mappings()}
            steps: dict[str, list[str]] = {}
            active = {name: row["begun_at"] for name, row in begun.items()}
            columns = (responses.c.participant, responses.c.step, responses.c.answered_at)
            for name, step, active[name] in db.execute(select(*columns).order_by(responses.c.answered_at)):
                steps.setdefault(name, []).append(step)
        return [
            Progress(
                participant=Participant(**person),
                contact=_read_contact(known.get(person["name"])),
                session=_read_session(row) if (row := begun.get(person["name"])) else None,
                answered=tuple(steps.get(person["name"], ())),
                active_at=active.get(person["name"]),
            )
            for person in people
        ]

    def event_counts(self, name: str) -> dict[str, int]:
        """How often something happened to each participant."""
        with self._engine.begin() as db:
            query = select(events.c.participant, func.count()).where(events.c.name == name)
            return {who: count for who, count in db.execute(query.group_by(events.c.participant)) if who}

    def events(self, names: Collection[str], *, most: int) -> list[Event]:
        """The latest events of these names, the newest first."""
        with self._engine.begin() as db:
            columns = (events.c.at, events.c.participant, events.c.name, events.c.detail)
            query = select(*columns).where(events.c.name.in_(names)).order_by(events.c.number.desc())
            return [Event(*row) for row in db.execute(query.limit(most))]

    def answered_since(self, moment: datetime, kind: Kind) -> list[datetime]:
        """When pages were answered since a moment, the oldest first."""
        with self._engine.begin() as db:
            query = (
                select(responses.c.answered_at)
                .join(participants, participants.c.name == responses.c.participant)
                .where(responses.c.answered_at >= moment, participants.c.kind == kind)
                .order_by(responses.c.answered_at)
            )
            return list(db.execute(query).scalars())


def _read_contact(row: RowMapping | None) -> Contact:
    return Contact() if row is None else Contact(row["note"], row["source"], row["external_id"])


SESSION_OF = select(sessions).where(sessions.c.participant == bindparam("name"))


def read_session(db: Connection, participant: str) -> Session | None:
    """The participant's session, if they have consented."""
    row = db.execute(SESSION_OF, {"name": participant}).mappings().first()
    return None if row is None else _read_session(row)


def given_in(pages: Iterable[tuple[str, Mapping[str, str]]]) -> dict[str, set[str]]:
    """All answers by item, from each answered step with its answers; practice does not count."""
    given: dict[str, set[str]] = {}
    for step, answers in pages:
        for item, answer in answers.items() if not step.startswith(f"{PRACTICE}:") else ():
            given.setdefault(item, set()).add(answer)
    return given


def values_in(answers: Iterable[Mapping[str, str]]) -> dict[str, str]:
    """Answers by item, as stored."""
    return {answer["item"]: answer["value"] for answer in answers}


def _read_session(row: RowMapping) -> Session:
    kept = set(Session.__dataclass_fields__) & set(row)
    fields = {name: row[name] for name in kept}
    return Session(**fields | {"plan": read_plan(row["plan"])})


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
