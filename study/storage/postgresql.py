"""PostgreSQL, where answers are to be kept on another machine than the server's.

Durability is PostgreSQL's default (`fsync` and `synchronous_commit` on). Deleted rows are overwritten when it
vacuums, by itself or as its administrator orders.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial

from sqlalchemy import URL, Engine, create_engine, text
from sqlalchemy.exc import OperationalError

from stimuli.errors import InputError
from study.storage.database import Database, holder

LOCK = 0x5354554459  # "STUDY"
HOLDER = text(
    "SELECT application_name FROM pg_stat_activity JOIN pg_locks USING (pid)"
    " WHERE locktype = 'advisory' AND granted AND datname = current_database()"
)


def open_database(url: URL) -> Database:
    """A database reached by psycopg 3."""
    try:
        engine = create_engine(
            url.set(drivername="postgresql+psycopg"),
            pool_pre_ping=True,  # so that a server that was restarted is found again
            hide_parameters=True,  # errors are logged, answers are not
        )
    except ModuleNotFoundError as err:
        message = "PostgreSQL needs psycopg: pip install 'expressive-motion-study[postgresql]'"
        raise InputError(message) from err
    return Database(engine, held=partial(_held, engine), purge=lambda: None)


@contextmanager
def _held(engine: Engine) -> Iterator[None]:
    """Hold the database for as long as the block lasts, and the connection does."""
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as db:
        name = {"name": f"study: {holder()}", "lock": LOCK}
        db.execute(text("SELECT set_config('application_name', :name, false)"), name)
        if not db.execute(text("SELECT pg_try_advisory_lock(:lock)"), name).scalar():
            by = db.execute(HOLDER).scalar()
            raise InputError(f"{engine.url}: is being served by {by}. Stop that one first.")
        try:
            yield
        finally:
            with suppress(OperationalError):  # with the connection the lock is gone
                db.execute(text("SELECT pg_advisory_unlock(:lock)"), name)
