"""Copies of a study in SQLite, made while it runs, and the way back.

A backup is a whole database, made by SQLite's own backup, and is opened like any other. The oldest are
deleted, so that the answers of somebody who withdrew are gone from the backups too when these have expired.
"""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from pathlib import Path

from stimuli.errors import InputError

KEPT = 48
SUFFIX = ".db"


def back_up(database: Path, folder: Path, *, now: datetime, kept: int = KEPT) -> Path:
    """Copy the database into a folder, under a name that says when, and delete all but the newest copies."""
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / f"{database.stem}-{now:%Y%m%dT%H%M%S}Z{SUFFIX}"
    copy_database(database, copy)
    for expired in sorted(folder.glob(f"{database.stem}-*{SUFFIX}"))[:-kept]:
        expired.unlink()
    return copy


def restore(backup: Path, database: Path) -> None:
    """Put a backup in the place of a database; the server must not be running."""
    try:
        with closing(sqlite3.connect(f"{backup.absolute().as_uri()}?mode=ro", uri=True)) as db:
            [verdict] = db.execute("PRAGMA integrity_check").fetchone()
            db.execute("SELECT name FROM participants LIMIT 1")
    except sqlite3.DatabaseError as err:
        raise InputError(f"{backup}: is no backup of a study ({err}).") from err
    if verdict != "ok":
        raise InputError(f"{backup}: is damaged ({verdict}). Take an older one.")
    copy_database(backup, database)


def copy_database(source: Path, target: Path) -> None:
    """Copy a database page by page into a new file or over another; the source may be in use."""
    whole = target.with_suffix(f"{target.suffix}.part")
    whole.unlink(missing_ok=True)
    with closing(sqlite3.connect(source)) as live, closing(sqlite3.connect(whole)) as copy:
        live.backup(copy)
        copy.execute("PRAGMA journal_mode=DELETE")
    for leftover in ("-wal", "-shm"):
        target.with_name(target.name + leftover).unlink(missing_ok=True)
    whole.replace(target)


class BackupTimer:
    """Calls for a backup every so often, in a thread of its own, and once more when it is stopped."""

    def __init__(self, make: Callable[[], object], *, every_s: float) -> None:
        self._make = make
        self._every_s = every_s
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="backups", daemon=True)

    def __enter__(self) -> BackupTimer:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stopped.set()
        self._thread.join()
        self._make()

    def _run(self) -> None:
        while not self._stopped.wait(self._every_s):
            self._make()
