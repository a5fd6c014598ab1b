"""Whatever may say who a participant is goes into a table of its own."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Move the notes out of the participants' table."""
    op.create_table(
        "contacts",
        sa.Column(
            "participant",
            sa.String(40),
            sa.ForeignKey("participants.name", ondelete="CASCADE"),
            primary_key=True,
        ),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("source", sa.String(20)),
        sa.Column("external_id", sa.String(200)),
    )
    op.create_index("ix_contacts_external", "contacts", ["source", "external_id"], unique=True)
    op.execute(
        "INSERT INTO contacts (participant, note) SELECT name, note FROM participants WHERE note <> ''"
    )
    op.drop_column("participants", "note")
