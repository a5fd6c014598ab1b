from __future__ import annotations

import os
import resource
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from stimuli.errors import InputError
from study.participants import Contact, new_participant, new_token
from study.storage import Store, open_store
from study.storage.backups import BackupTimer, back_up, copy_database, restore

NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)


def invite(store: Store, count: int) -> None:
    for _ in range(count):
        store.add_participant(new_participant(new_token(), kind="participant", created_at=NOON))


def names(file: Path) -> set[str]:
    store = open_store(f"sqlite:///{file}")
    found = {row.participant.name for row in store.progress()}
    store.close()
    return found


def test_what_is_restored_is_what_was_backed_up(tmp_path: Path) -> None:
    file = tmp_path / "study.db"
    store = open_store(f"sqlite:///{file}")
    invite(store, 3)
    copy = back_up(file, tmp_path / "backups", now=NOON)  # while the store is open
    then = names(copy)
    invite(store, 2)
    store.close()
    assert len(names(file)) == 5
    restore(copy, file)
    assert names(file) == then
    assert len(then) == 3


def test_a_backup_is_restored_where_there_was_nothing_yet(tmp_path: Path) -> None:
    open_store(f"sqlite:///{tmp_path}/study.db").close()
    restore(tmp_path / "study.db", tmp_path / "new machine" / "data" / "study.db")
    open_store(f"sqlite:///{tmp_path}/new machine/data/study.db").close()


def test_a_backup_made_while_others_write_is_whole(tmp_path: Path) -> None:
    file = tmp_path / "study.db"
    store = open_store(f"sqlite:///{file}")
    writer = threading.Thread(target=invite, args=(store, 200))
    writer.start()
    copies = [back_up(file, tmp_path / "backups", now=NOON + timedelta(seconds=n)) for n in range(5)]
    writer.join()
    store.close()
    known = names(file)
    for copy in copies:
        restore(copy, tmp_path / "restored.db")
        assert names(tmp_path / "restored.db") <= known


def test_only_the_newest_are_kept(tmp_path: Path) -> None:
    file = tmp_path / "study.db"
    open_store(f"sqlite:///{file}").close()
    made = [back_up(file, tmp_path / "b", now=NOON + timedelta(hours=n), kept=3) for n in range(5)]
    assert sorted((tmp_path / "b").iterdir()) == made[2:]


@pytest.mark.parametrize("content", [b"", b"SQLite format 3\0 and then nothing", b"participants,responses"])
def test_what_is_no_backup_is_not_restored(tmp_path: Path, content: bytes) -> None:
    broken, file = tmp_path / "broken.db", tmp_path / "study.db"
    broken.write_bytes(content)
    open_store(f"sqlite:///{file}").close()
    before = file.read_bytes()
    with pytest.raises(InputError, match=r"broken\.db: is no backup"):
        restore(broken, file)
    assert file.read_bytes() == before


def test_who_withdrew_is_in_no_backup_and_does_not_come_back(tmp_path: Path) -> None:
    file, folder = tmp_path / "study.db", tmp_path / "backups"
    store = open_store(f"sqlite:///{file}")
    invite(store, 2)
    stays, leaves = (row.participant.name for row in store.progress())
    older = back_up(file, folder, now=NOON)
    elsewhere = tmp_path / "elsewhere.db"
    copy_database(older, elsewhere)
    store.withdraw(leaves, now=NOON + timedelta(hours=1))
    back_up(file, folder, now=NOON + timedelta(hours=2))
    store.close()
    assert names(older) == {stays}
    restore(elsewhere, file)
    restored = open_store(f"sqlite:///{file}")
    assert [note.participant for note in restored.withdrawals()] == [leaves]
    assert [row.participant.name for row in restored.progress()] == [stays]
    restored.close()


def test_nothing_of_who_withdrew_is_left_in_the_files(tmp_path: Path) -> None:
    file, folder = tmp_path / "study.db", tmp_path / "backups"
    store = open_store(f"sqlite:///{file}")
    for note in ("Rosalind-Secret", "Ada-Stays"):
        participant = new_participant(new_token(), kind="participant", created_at=NOON)
        store.add_participant(participant, Contact(note=note))
        store.log("video_failed", f"{note}: clip 3", participant=participant.name, now=NOON).result()
    older = back_up(file, folder, now=NOON)
    everything = [file, tmp_path / "study.db-wal", older]
    assert [b"Rosalind-Secret" in path.read_bytes() for path in everything] == [False, True, True]
    leaves = next(row.participant.name for row in store.progress() if row.contact.note == "Rosalind-Secret")
    store.withdraw(leaves, now=NOON)
    back_up(file, folder, now=NOON + timedelta(hours=1))
    for path in (path for path in tmp_path.rglob("*") if path.is_file()):
        assert b"Rosalind-Secret" not in path.read_bytes(), path
    assert b"Ada-Stays" in file.read_bytes()
    store.close()


def test_a_database_that_is_being_served_is_not_replaced(tmp_path: Path) -> None:
    file = tmp_path / "study.db"
    store = open_store(f"sqlite:///{file}")
    copy = back_up(file, tmp_path / "backups", now=NOON)
    with (
        store.held(),
        pytest.raises(InputError, match=rf"study.db: is being served by process {os.getpid()}"),
    ):
        restore(copy, file)
    store.close()
    restore(copy, file)


@contextmanager
def full_disk() -> Iterator[None]:
    """As if there were hardly any room: no file may have more than a page for as long as the block lasts."""
    most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, most[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, most)


def test_where_there_is_no_room_nothing_is_restored_and_nothing_is_left_half_done(tmp_path: Path) -> None:
    file = tmp_path / "study.db"
    store = open_store(f"sqlite:///{file}")
    invite(store, 2)
    copy = back_up(file, tmp_path / "backups", now=NOON)
    invite(store, 1)
    store.close()
    with full_disk():
        with pytest.raises(InputError, match=r"study\.db: could not be replaced \(.*\) and is as it was"):
            restore(copy, file)
        with pytest.raises(sqlite3.Error):
            back_up(file, tmp_path / "backups", now=NOON + timedelta(hours=1))
    assert len(names(file)) == 3
    assert not list(tmp_path.rglob("*.part"))
    assert list((tmp_path / "backups").glob("*.db")) == [copy]


def test_a_timer_backs_up_and_once_more_at_the_end() -> None:
    twice, calls = threading.Event(), []

    def make() -> None:
        calls.append(len(calls))
        if len(calls) == 2:
            twice.set()

    with BackupTimer(make, every_s=0.01):
        assert twice.wait(timeout=10)
    assert len(calls) >= 3


def test_a_backup_that_fails_is_said_and_tried_again_soon(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    store = open_store(f"sqlite:///{tmp_path}/study.db")
    folder, made, failed = tmp_path / "backups", threading.Event(), threading.Event()
    folder.write_text("in the way")

    def make() -> None:
        try:
            back_up(tmp_path / "study.db", folder, now=NOON)
            made.set()
        finally:
            failed.set()

    with BackupTimer(make, every_s=0.01, again_s=0.2) as timer:
        assert failed.wait(timeout=10)
        while timer.fault is None:
            time.sleep(0.01)
        assert "File exists" in timer.fault
        folder.unlink()
        assert made.wait(timeout=10)
    assert timer.fault is None
    assert "No backup could be made: " in caplog.text
    store.close()
