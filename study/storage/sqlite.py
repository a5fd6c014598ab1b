"""SQLite: one file, nothing to install, and safe against a power cut.

WAL lets readers and the one writer work side by side; `synchronous=FULL` makes every commit reach the disk
before it is acknowledged; writing transactions begin IMMEDIATE, so that they wait in line for the write lock
and never fail half-way when another wrote first; `secure_delete` overwrites what a withdrawal removes.
"""

from __future__ import annotations

from pathlib import Path
from sqlite3 import Connection as SQLiteConnection

from sqlalchemy import URL, Connection, Engine, create_engine, event

PRAGMAS = {
    "journal_mode": "WAL",
    "synchronous": "FULL",
    "foreign_keys": "ON",
    "busy_timeout": "20000",  # ms
    "secure_delete": "ON",
}


def engine(url: URL) -> Engine:
    """An engine whose connections all have the pragmas above."""
    if url.database:
        Path(url.database).parent.mkdir(parents=True, exist_ok=True)
    made = create_engine(url)

    @event.listens_for(made, "connect")
    def configure(connection: SQLiteConnection, _: object) -> None:
        connection.isolation_level = None  # the begin below is then the only one
        for name, value in PRAGMAS.items():
            connection.execute(f"PRAGMA {name}={value}")

    @event.listens_for(made, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get("writes", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return made
