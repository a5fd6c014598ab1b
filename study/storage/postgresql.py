"""PostgreSQL, for studies with several servers or many participants at once.

Writing transactions are serialised by one advisory lock: places in the design are handed out one at a time,
as they are in SQLite. Durability is the server's default (`fsync` and `synchronous_commit` on).
"""

from __future__ import annotations

from sqlalchemy import URL, Connection, Engine, create_engine, event

from stimuli.errors import InputError

LOCK = 0x5354554459  # "STUDY"


def engine(url: URL) -> Engine:
    """An engine by psycopg 3."""
    try:
        made = create_engine(url.set(drivername="postgresql+psycopg"), pool_pre_ping=True)
    except ModuleNotFoundError as err:
        message = "PostgreSQL needs psycopg: pip install 'expressive-motion-study[postgresql]'"
        raise InputError(message) from err

    @event.listens_for(made, "begin")
    def begin(connection: Connection) -> None:
        if connection.get_execution_options().get("assigns", False):
            connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock({LOCK})")

    return made
