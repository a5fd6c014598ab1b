"""The tables. Rows of answers are only ever added; a withdrawal deletes them and leaves a dated note.

A change here needs a step in `migrations/versions`.
"""

from __future__ import annotations

from datetime import UTC, datetime

from sqlalchemy import (
    JSON,
    Column,
    DateTime,
    Dialect,
    Float,
    ForeignKey,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
    TypeDecorator,
    UniqueConstraint,
)


class Utc(TypeDecorator[datetime]):
    """A moment in UTC, with its zone in Python whatever the database keeps."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """Refuse times without a zone; store UTC."""
        if value is not None and value.tzinfo is None:
            raise ValueError(f"{value} has no time zone")
        return value and value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """Put the zone back where the database dropped it."""
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


metadata = MetaData()

participants = Table(
    "participants",
    metadata,
    Column("name", String(40), primary_key=True),
    Column("kind", String(20), nullable=False),
    Column("token_sha256", String(64), nullable=False, unique=True),
    Column("created_at", Utc, nullable=False),
)

contacts = Table(  # all that may say who somebody is; never exported
    "contacts",
    metadata,
    Column("participant", ForeignKey("participants.name", ondelete="CASCADE"), primary_key=True),
    Column("note", Text, nullable=False),  # the experimenter's own word for them
    Column("source", String(20)),  # who sent them: prolific, sona, mturk
    Column("external_id", String(200)),  # what they are called there
    Index("ix_contacts_external", "source", "external_id", unique=True),
)

sessions = Table(
    "sessions",
    metadata,
    Column("participant", ForeignKey("participants.name", ondelete="CASCADE"), primary_key=True),
    Column("slot", Integer, nullable=False),
    Column("plan", Text, nullable=False),  # canonical JSON, as hashed
    Column("plan_sha256", String(64), nullable=False),
    Column("seed", String(128), nullable=False),
    Column("algorithm", String(80), nullable=False),
    Column("protocol_sha256", String(64), nullable=False),
    Column("software", String(80), nullable=False),
    Column("language", String(20), nullable=False),
    Column("consent_sha256", String(64), nullable=False),
    Column("completion_code", String(40), nullable=False, unique=True),
    Column("begun_at", Utc, nullable=False),
    Column("completed_at", Utc),
)

pages = Table(
    "pages",
    metadata,
    Column("participant", ForeignKey("sessions.participant", ondelete="CASCADE"), primary_key=True),
    Column("step", String(200), primary_key=True),
    Column("shown_at", Utc, nullable=False),  # the first time
)

responses = Table(
    "responses",
    metadata,
    Column("id", String(36), primary_key=True),
    Column("participant", ForeignKey("sessions.participant", ondelete="CASCADE"), nullable=False),
    Column("step", String(200), nullable=False),
    Column("answered_at", Utc, nullable=False),
    Column("on_page_ms", Float, nullable=False),
    Column("answers", JSON, nullable=False),
    Column("views", JSON, nullable=False),
    UniqueConstraint("participant", "step"),
)

events = Table(
    "events",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("participant", ForeignKey("participants.name", ondelete="CASCADE"), index=True),
    Column("at", Utc, nullable=False),
    Column("name", String(40), nullable=False),  # a video that failed, a second device, a session paused …
    Column("detail", Text, nullable=False),
)

withdrawals = Table(
    "withdrawals",
    metadata,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("participant", String(40), nullable=False),  # the name only: everything else is gone
    Column("at", Utc, nullable=False),
    Column("responses", Integer, nullable=False),  # how many were deleted
)
