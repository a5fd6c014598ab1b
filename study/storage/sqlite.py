"""SQLite: one file, nothing to install, and safe against a power cut.

WAL lets readers and the one writer work side by side; `synchronous=FULL` makes every commit reach the disk
before it is acknowledged; writing transactions begin IMMEDIATE, so that they wait in line for the write lock
and never fail half-way when another wrote first; `secure_delete` overwrites what a withdrawal removes.
"""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from sqlite3 import Connection as SQLiteConnection

from sqlalchemy import URL, Connection, Engine, create_engine, event

from study.storage.database import Database, ServedByAnotherError, as_json, holder

PRAGMAS = {
    "journal_mode": "WAL",
    "synchronous": "FULL",
    "foreign_keys": "ON",
    "busy_timeout": "20000",  # ms
    "secure_delete": "ON",
}


def open_database(url: URL) -> Database:
    """A database whose connections all have the pragmas above."""
    file = Path(url.database or "")
    file.parent.mkdir(parents=True, exist_ok=True)
    engine = create_engine(
        url,
        hide_parameters=True,  # errors are logged, answers are not
        json_serializer=as_json,
    )

    @event.listens_for(engine, "connect")
    def configure(connection: SQLiteConnection, _: object) -> None:
        connection.isolation_level = None  # the begin below is then the only one
        for name, value in PRAGMAS.items():
            connection.execute(f"PRAGMA {name}={value}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        writes = connection.get_execution_options().get("writes", False)
        connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")

    return Database(engine, held=partial(held, file), purge=partial(_purge, engine))


@contextmanager
def held(file: Path) -> Iterator[None]:
    """Hold a database file for as long as the block lasts; the system lets go of it if the process dies."""
    with file.with_name(f"{file.name}.lock").open("a+", encoding="utf-8") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as err:
            lock.seek(0)
            message = f"{file}: is being served by {lock.read()}. Stop that one first, or use other --data."
            raise ServedByAnotherError(message) from err
        lock.truncate(0)
        lock.write(holder())
        lock.flush()
        yield


def _purge(engine: Engine) -> None:
    """Empty the write-ahead log into the file, where `secure_delete` has zeroed what was deleted."""
    connection = engine.raw_connection()
    try:
        connection.cursor().execute("PRAGMA wal_checkpoint(TRUNCATE)").close()
    finally:
        connection.close()
