"""Copies of a study in SQLite, made while it runs, and the way back.

A backup is a whole database, made by SQLite's own backup, and is opened like any other. Whoever withdrew is
deleted from the older backups too when the next one is made, and does not come back when one is restored.
"""

from __future__ import annotations

import logging
import sqlite3
import threading
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from stimuli.errors import InputError
from study.storage.sqlite import held

KEPT = 48
AGAIN_S = 60.0
SUFFIX = ".db"
logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class Withdrawal:
    """A row of the table of withdrawals."""

    participant: str
    at: str
    responses: int


def back_up(database: Path, folder: Path, *, now: datetime, kept: int = KEPT) -> Path:
    """Copy the database into a folder, under a name that says when, and delete all but the newest copies."""
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / f"{database.stem}-{now:%Y%m%dT%H%M%S}Z{SUFFIX}"
    copy_database(database, copy)
    copies = sorted(folder.glob(f"{database.stem}-*{SUFFIX}"))
    for expired in copies[:-kept]:
        expired.unlink()
    gone = withdrawals(copy)
    for older in copies[-kept:]:
        delete(older, gone)
    return copy


def restore(backup: Path, database: Path) -> None:
    """Put a backup in the place of a database that is not being served; who withdrew since stays deleted."""
    try:
        with closing(sqlite3.connect(f"{backup.absolute().as_uri()}?mode=ro", uri=True)) as db:
            [verdict] = db.execute("PRAGMA integrity_check").fetchone()
            db.execute("SELECT name FROM participants LIMIT 1")
    except sqlite3.DatabaseError as err:
        raise InputError(f"{backup}: is no backup of a study ({err}).") from err
    if verdict != "ok":
        raise InputError(f"{backup}: is damaged ({verdict}). Take an older one.")
    database.parent.mkdir(parents=True, exist_ok=True)  # on a new machine there is none yet
    with held(database):
        try:
            copy_database(backup, database, without=withdrawals(database))
        except (OSError, sqlite3.Error) as err:
            message = f"{database}: could not be replaced ({err}) and is as it was. Is the disk full?"
            raise InputError(message) from err


def withdrawals(database: Path) -> list[Withdrawal]:
    """Who withdrew, as far as can be read."""
    try:
        with closing(sqlite3.connect(f"{database.absolute().as_uri()}?mode=ro", uri=True)) as db:
            return [
                Withdrawal(*row) for row in db.execute("SELECT participant, at, responses FROM withdrawals")
            ]
    except sqlite3.DatabaseError:  # damaged, or not there: this is what backups are for
        return []


def delete(database: Path, gone: Sequence[Withdrawal]) -> None:
    """Delete participants from a database that is not in use, leaving the notes of their withdrawal."""
    with closing(sqlite3.connect(database)) as db, db:
        db.execute("PRAGMA foreign_keys=ON")
        db.execute("PRAGMA secure_delete=ON")
        for note in gone:
            if db.execute("DELETE FROM participants WHERE name = ?", (note.participant,)).rowcount:
                values = (note.participant, note.at, note.responses)
                db.execute("INSERT INTO withdrawals (participant, at, responses) VALUES (?, ?, ?)", values)


def copy_database(source: Path, target: Path, *, without: Sequence[Withdrawal] = ()) -> None:
    """Copy a database page by page into a new file or over another; the source may be in use.

    Who is `without` is not in the copy. It is made beside the target and takes its place when it is whole.
    """
    whole = target.with_suffix(f"{target.suffix}.part")
    whole.unlink(missing_ok=True)
    try:
        with closing(sqlite3.connect(source)) as live, closing(sqlite3.connect(whole)) as copy:
            live.backup(copy)
            copy.execute("PRAGMA journal_mode=DELETE")
        delete(whole, without)
    except (OSError, sqlite3.Error):
        whole.unlink(missing_ok=True)  # it would take what room there is
        raise
    for leftover in ("-wal", "-shm"):
        target.with_name(target.name + leftover).unlink(missing_ok=True)
    whole.replace(target)


class BackupTimer:
    """Calls for a backup every so often, in a thread of its own, and once more when it is stopped.

    One that fails is logged, kept as `fault` until the next that succeeds, and tried again soon: there may be
    room again by then.
    """

    def __init__(self, make: Callable[[], object], *, every_s: float, again_s: float = AGAIN_S) -> None:
        self._make = make
        self._every_s, self._again_s = every_s, again_s
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="backups", daemon=True)
        self.fault: str | None = None  # why the latest failed

    def __enter__(self) -> BackupTimer:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stopped.set()
        self._thread.join()
        self._try()

    def _run(self) -> None:
        while not self._stopped.wait(self._again_s if self.fault else self._every_s):
            self._try()

    def _try(self) -> None:
        try:
            self._make()
        except (OSError, sqlite3.Error) as err:
            logger.error("No backup could be made: %s", err)
            self.fault = str(err) or type(err).__name__
        else:
            self.fault = None
