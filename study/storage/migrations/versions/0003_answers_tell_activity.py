"""Answers tell when somebody was last active: each is one new row and changes no other."""

from __future__ import annotations

from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    """Drop what repeats the answers, and an index that a unique one makes needless."""
    op.drop_index("ix_sessions_active_at", "sessions")
    op.drop_column("sessions", "active_at")
    op.drop_index("ix_responses_participant", "responses")
