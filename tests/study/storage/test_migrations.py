"""Databases are brought up to date when they are opened, from nothing and from every earlier state."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import pytest
import sqlalchemy as sa
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory

import study.storage.migrations
from study.storage import open_store
from study.storage.tables import metadata

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)


def steps() -> Config:
    config = Config()
    config.set_main_option("script_location", str(Path(study.storage.migrations.__file__).parent))
    config.set_main_option("path_separator", "os")
    return config


def engine(url: str) -> sa.Engine:
    return sa.create_engine(url.replace("postgresql:", "postgresql+psycopg:"))


REVISIONS = [step.revision for step in ScriptDirectory.from_config(steps()).walk_revisions()]


@pytest.mark.parametrize("start", [None, *REVISIONS])
def test_every_earlier_database_ends_with_the_tables_of_today(url: str, start: str | None) -> None:
    made = engine(url)
    if start:
        config = steps()
        with made.begin() as connection:
            config.attributes["connection"] = connection
            command.upgrade(config, start)
    for _ in range(2):  # and opening it again changes nothing
        open_store(url).close()
        with made.connect() as connection:
            context = MigrationContext.configure(connection)
            assert compare_metadata(context, metadata) == []
            assert context.get_current_revision() == REVISIONS[0]
    made.dispose()


def test_a_database_from_before_migrations_keeps_what_is_in_it(url: str) -> None:
    made, config = engine(url), steps()
    with made.begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "0001")
        connection.execute(sa.text("DROP TABLE alembic_version"))
        old = "INSERT INTO participants (name, kind, token_sha256, created_at, note) VALUES "
        for name, note in (("p-1", "Ada"), ("p-2", "")):
            row = f"('{name}', 'participant', '{name}', '2026-11-22 12:00:00', '{note}')"
            connection.execute(sa.text(old + row))
    made.dispose()
    store = open_store(url)
    assert {row.participant.name: row.contact.note for row in store.progress()} == {"p-1": "Ada", "p-2": ""}
    store.close()
