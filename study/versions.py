"""A study as it was when its participants began: a copy for each version, kept beside the answers.

`DATA/versions/HASH/` holds the protocol, the files it names and the manifest of its clips. Whoever began
before an amendment goes on with the version they consented to.
"""

from __future__ import annotations

import shutil
from collections.abc import Collection, Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from stimuli.manifest import Manifest
from study.protocol import Problem, Protocol, ProtocolError, load_protocol
from study.protocol.amendments import SHORT, as_replaced
from study.protocol.references import leaves_the_folder
from study.storage import open_store

FOLDER = "versions"


@dataclass(frozen=True)
class Version:
    """One version of a study."""

    sha256: str
    protocol: Protocol
    manifest: Manifest


def refuse_undeclared(protocol: Protocol, known_hashes: Collection[str]) -> None:
    """Refuse to go on with participants of another protocol, unless an amendment says why it was changed.

    `known_hashes` are those of the protocols that the participants so far took part in.
    """
    problems = [
        Problem(
            protocol.path,
            None,
            None,
            "",
            f"has changed since participants took part in {known[:SHORT]}. Take the change back, gather the "
            "new data elsewhere (--data), or declare it:\n"
            f"amendments:\n  - {{date: <today>, reason: <why>, replaces: {as_replaced(known)}}}",
        )
        for known in sorted(known_hashes)
        if not protocol.continues(known)
    ]
    if problems:
        raise ProtocolError(problems)


def refuse_if_begun_otherwise(protocol: Protocol, data: Path) -> None:
    """The same, of the participants whose answers are in a folder; refused too while it is being served."""
    file = data / "study.db"
    if file.exists():
        with closing(open_store(f"sqlite:///{file}")) as store, store.held():
            refuse_undeclared(protocol, store.protocol_hashes())


def keep_version(protocol: Protocol, manifest: Manifest, data: Path) -> None:
    """Copy what participants are about to begin with, once."""
    folder = data / FOLDER / protocol.sha256
    if folder.exists():
        return
    unfinished = folder.with_name(f"{folder.name}.part")
    shutil.rmtree(unfinished, ignore_errors=True)
    copy_protocol(protocol, unfinished)
    manifest.save(unfinished)
    unfinished.rename(folder)


def copy_protocol(protocol: Protocol, folder: Path) -> None:
    """Copy a protocol and the files it is made of into a folder, as far as they are there."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in protocol.files:
        if (protocol.folder / name).is_file() and not leaves_the_folder(name):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(protocol.folder / name, folder / name)
    shutil.copyfile(protocol.path, folder / "protocol.yaml")


def earlier_versions(protocol: Protocol, data: Path) -> Iterator[Version]:
    """The versions before this one that are kept. Raises ProtocolError where one can no longer be read."""
    for folder in sorted((data / FOLDER).glob("*/protocol.yaml")):
        if folder.parent.name not in {protocol.sha256} and not folder.parent.name.endswith(".part"):
            yield Version(folder.parent.name, load_protocol(folder, kept=True), Manifest.load(folder.parent))
