"""What tests of the store and of the server share: a PostgreSQL of our own."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import uuid4

import pytest
import sqlalchemy as sa


class PostgreSQL:
    """A server of our own, which can be stopped and started again."""

    def __init__(self, folder: Path) -> None:
        found = [shutil.which("initdb"), *sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"))]
        programs = Path(next(path for path in found if path)).resolve().parent  # Debian: not in the path
        as_user = []
        if os.geteuid() == 0:  # it refuses to run as root
            shutil.chown(folder, "postgres")
            as_user = ["setpriv", "--reuid=postgres", "--regid=postgres", "--clear-groups"]
        data = folder / "data"
        self._folder = folder
        self._control = [*as_user, str(programs / "pg_ctl"), "-D", str(data), "-w"]
        initdb = [*as_user, str(programs / "initdb"), "-D", str(data), "-U", "study", "-A", "trust", "-N"]
        subprocess.run(initdb, check=True, capture_output=True, cwd=folder)

    def start(self) -> None:
        """Start it, and wait until it answers."""
        options = f"-k {self._folder} -c listen_addresses=''"
        self._run("-l", str(self._folder / "log"), "-o", options, "start")

    def stop(self) -> None:
        """Stop it as a crash would."""
        self._run("-m", "immediate", "stop")

    def new_database(self) -> str:
        """The address of a database with nothing in it."""
        name = f"d{uuid4().hex}"
        engine = sa.create_engine(
            f"postgresql+psycopg://study@/postgres?host={self._folder}", isolation_level="AUTOCOMMIT"
        )
        with engine.connect() as db:
            db.execute(sa.text(f"CREATE DATABASE {name}"))
        engine.dispose()
        return f"postgresql://study@/{name}?host={self._folder}"

    def _run(self, *arguments: str) -> None:
        subprocess.run([*self._control, *arguments], check=True, cwd=self._folder, stdout=subprocess.DEVNULL)


@pytest.fixture(scope="session")
def postgresql() -> Iterator[PostgreSQL]:
    """A PostgreSQL that runs."""
    with TemporaryDirectory() as made:  # not below pytest's folder, which is for our user's eyes alone
        server = PostgreSQL(Path(made))
        server.start()
        yield server
        server.stop()
