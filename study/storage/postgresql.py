"""PostgreSQL, where answers are to be kept on another machine than the server's.

Durability is PostgreSQL's default (`fsync` and `synchronous_commit` on). Deleted rows are overwritten when it
vacuums, by itself or as its administrator orders.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress

from sqlalchemy import URL, Connection, Engine, create_engine, event, text
from sqlalchemy.exc import OperationalError, SQLAlchemyError

from stimuli.errors import InputError
from study.storage.database import Database, ServedByAnotherError, as_json, holder

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
            json_serializer=as_json,
        )
    except ModuleNotFoundError as err:
        message = "PostgreSQL needs psycopg: pip install 'expressive-motion-study[postgresql]'"
        raise InputError(message) from err
    lock = Lock(engine)

    @event.listens_for(engine, "begin")
    def keep(connection: Connection) -> None:
        if connection.get_execution_options().get("writes", False):
            lock.keep()

    return Database(engine, held=lock.held, purge=lambda: None)


class Lock:
    """An advisory lock, which lasts as long as its connection: lost when PostgreSQL restarts.

    It is looked after before every transaction that writes, and taken again where it was lost.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._wanted = False
        self._connection: Connection | None = None  # by which it is held

    @contextmanager
    def held(self) -> Iterator[None]:
        """Hold the database for as long as the block lasts."""
        self._take()
        self._wanted = True
        try:
            yield
        finally:
            self._wanted = False
            if self._connection is not None:
                with suppress(SQLAlchemyError):  # where the database is away, so is the lock
                    self._connection.execute(text("SELECT pg_advisory_unlock(:lock)"), {"lock": LOCK})
            self._let_go()

    def keep(self) -> None:
        """See to it that what is to be held is; ServedByAnotherError says who has taken it meanwhile."""
        if not self._wanted:
            return
        try:
            if self._connection is not None:
                self._connection.execute(text("SELECT 1"))
                return
        except OperationalError:
            self._let_go()
        self._take()

    def _take(self) -> None:
        connection = self._engine.connect().execution_options(isolation_level="AUTOCOMMIT")
        name = {"name": f"study: {holder()}", "lock": LOCK}
        connection.execute(text("SELECT set_config('application_name', :name, false)"), name)
        if not connection.execute(text("SELECT pg_try_advisory_lock(:lock)"), name).scalar():
            by = connection.execute(HOLDER).scalar()
            connection.close()
            raise ServedByAnotherError(f"{self._engine.url}: is being served by {by}. Stop that one first.")
        self._connection = connection

    def _let_go(self) -> None:
        connection, self._connection = self._connection, None
        if connection is not None:
            connection.invalidate()  # with the connection the lock is gone
            connection.close()
