"""The first tables."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None

MOMENT = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Make the tables of the first version."""
    op.create_table(
        "participants",
        sa.Column("name", sa.String(40), primary_key=True),
        sa.Column("kind", sa.String(20), nullable=False),
        sa.Column("token_sha256", sa.String(64), nullable=False, unique=True),
        sa.Column("created_at", MOMENT, nullable=False),
        sa.Column("note", sa.Text, nullable=False),
    )
    op.create_table(
        "sessions",
        sa.Column("participant", sa.String(40), _owner("participants.name"), primary_key=True),
        sa.Column("slot", sa.Integer, nullable=False),
        sa.Column("plan", sa.Text, nullable=False),
        sa.Column("plan_sha256", sa.String(64), nullable=False),
        sa.Column("seed", sa.String(128), nullable=False),
        sa.Column("algorithm", sa.String(80), nullable=False),
        sa.Column("protocol_sha256", sa.String(64), nullable=False),
        sa.Column("software", sa.String(80), nullable=False),
        sa.Column("language", sa.String(20), nullable=False),
        sa.Column("consent_sha256", sa.String(64), nullable=False),
        sa.Column("completion_code", sa.String(40), nullable=False, unique=True),
        sa.Column("begun_at", MOMENT, nullable=False),
        sa.Column("active_at", MOMENT, nullable=False, index=True),
        sa.Column("completed_at", MOMENT),
    )
    op.create_table(
        "pages",
        sa.Column("participant", sa.String(40), _owner("sessions.participant"), primary_key=True),
        sa.Column("step", sa.String(200), primary_key=True),
        sa.Column("shown_at", MOMENT, nullable=False),
    )
    op.create_table(
        "responses",
        sa.Column("id", sa.String(36), primary_key=True),
        sa.Column("participant", sa.String(40), _owner("sessions.participant"), nullable=False, index=True),
        sa.Column("step", sa.String(200), nullable=False),
        sa.Column("answered_at", MOMENT, nullable=False),
        sa.Column("on_page_ms", sa.Float, nullable=False),
        sa.Column("answers", sa.JSON, nullable=False),
        sa.Column("views", sa.JSON, nullable=False),
        sa.UniqueConstraint("participant", "step"),
    )
    op.create_table(
        "events",
        sa.Column("number", sa.Integer, primary_key=True, autoincrement=True),
        sa.Column("participant", sa.String(40), _owner("participants.name"), index=True),
        sa.Column("at", MOMENT, nullable=False),
        sa.Column("name", sa.String(40), nullable=False),
        sa.Column("detail", sa.Text, nullable=False),
    )
    op.create_table(
        "withdrawals",
        sa.Column("number", sa.Integer, primary_key=True, autoincrement=True),
        sa.Column("participant", sa.String(40), nullable=False),
        sa.Column("at", MOMENT, nullable=False),
        sa.Column("responses", sa.Integer, nullable=False),
    )


def _owner(column: str) -> sa.ForeignKey:
    return sa.ForeignKey(column, ondelete="CASCADE")
