"""Files that appear whole or not at all, whatever ends the run: Ctrl-C, kill -9, a full disk."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from stimuli.errors import InputError


@contextmanager
def whole_or_nothing(path: Path) -> Iterator[Path]:
    """A name to write under; the file gets its own name when the block has ended well, else it is removed.

    Raises InputError where the system refuses to write.
    """
    partial = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield partial
        partial.replace(path)
    except OSError as error:
        raise InputError(
            f"{path}: could not be written: {error.strerror or error}. Nothing half written is left. "
            "Make room or name another folder, then run it again: it goes on where it stopped."
        ) from error
    finally:
        partial.unlink(missing_ok=True)


@contextmanager
def all_or_none(folder: Path) -> Iterator[Path]:
    """A folder to write into; its files move to `folder` when the block has ended well, else none of them.

    Raises InputError where the system refuses to write.
    """
    partial = folder / f".files.{os.getpid()}.part"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        sweep(folder)
        partial.mkdir()
        yield partial
        for path in sorted(path for path in partial.rglob("*") if path.is_file()):
            place = folder / path.relative_to(partial)
            place.parent.mkdir(parents=True, exist_ok=True)
            path.replace(place)
    except OSError as error:
        raise InputError(
            f"{folder}: could not be written: {error.strerror or error}. Nothing half written is left, and "
            "files that were there are as they were. Make room or name another folder."
        ) from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def sweep(folder: Path) -> None:
    """Remove what killed processes of this machine left half written."""
    for path in folder.glob(".*.part*"):
        pid = path.name.partition(".part")[0].rpartition(".")[2]
        if pid.isdigit() and not Path(f"/proc/{pid}").exists():
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink(missing_ok=True)
