"""Answers gathered with several versions of a protocol: together where that was declared, else refused."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from analysis.columns import read_columns
from analysis.fields import ResponsesError, read_header
from study.protocol.amendments import SHORT, as_replaced

if TYPE_CHECKING:
    from study.protocol import Protocol

COLUMN = "protocol_sha256"
PARTICIPANT = "participant"


@contextmanager
def of_one_study(path: Path, protocol: Protocol) -> Iterator[Mapping[str, str]]:
    """Read a file, all of whose rows belong to the protocol or to what its amendments replace.

    Gives the version of each participant who took part in an earlier one. A table of another program does not
    say which version its rows have, and is taken as it is.
    """
    if COLUMN not in read_header(path):
        yield {}
        return
    hashes = sorted({*read_columns(path, [COLUMN])[COLUMN].values} - {protocol.sha256, ""})
    strange = [sha256 for sha256 in hashes if not protocol.continues(sha256)]
    if strange:
        raise ResponsesError(
            f"{path}: was gathered with {_named(strange)}, but {protocol.path} is now "
            f"{protocol.sha256[:SHORT]}. {_apart(strange[0])} To analyse all together, declare the change "
            f"under `amendments` with `replaces: {as_replaced(strange[0])}`"
        )
    try:
        yield _earlier(path, hashes)
    except ResponsesError as error:
        if not hashes:
            raise
        raise ResponsesError(
            f"{error}\nSome rows were gathered before an amendment, with {_named(hashes)}. "
            f"Where they do not fit this version: {_apart(hashes[0])}"
        ) from error


def _earlier(path: Path, hashes: list[str]) -> dict[str, str]:
    """Each participant of an earlier version, with its hash."""
    if not hashes or PARTICIPANT not in read_header(path):
        return {}
    columns = read_columns(path, [PARTICIPANT, COLUMN])
    people, versions = columns[PARTICIPANT], columns[COLUMN]
    pairs = np.unique(np.stack([people.codes, versions.codes]), axis=1).T
    began = {people.values[person]: versions.values[version] for person, version in pairs}
    return {person: version for person, version in began.items() if version in hashes}


def _named(hashes: list[str]) -> str:
    return "protocol " + ", ".join(sha256[:SHORT] for sha256 in hashes)


def _apart(sha256: str) -> str:
    return (
        "To analyse such rows apart, put them into a file of their own and give "
        f"--protocol DATA/versions/{sha256}."
    )
