"""How the tables came to be, step by step: one file per change, in `versions/`.

A database is brought up to date when it is opened. To change a table, change `tables.py` and add a file whose
`down_revision` is the last one; a test compares what the steps make with what `tables.py` says. Steps only
lead forwards: to go back, restore a backup.
"""

from __future__ import annotations

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, inspect

BEFORE_MIGRATIONS = "0001"  # what databases are that were made before they bore a revision


def bring_up_to_date(connection: Connection) -> None:
    """Make the tables, or change them to what this software needs; all in the connection's transaction."""
    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    config.attributes["connection"] = connection
    revision = MigrationContext.configure(connection).get_current_revision()
    if revision == ScriptDirectory.from_config(config).get_current_head():
        return
    if revision is None and inspect(connection).has_table("participants"):
        command.stamp(config, BEFORE_MIGRATIONS)
    command.upgrade(config, "head")
