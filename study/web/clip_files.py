"""Whether the clips are there as rendered, before anybody comes to see them."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from stimuli.errors import InputError
from stimuli.manifest import sha256_of

if TYPE_CHECKING:
    from stimuli.manifest import Clip, Manifest
    from study.protocol import Protocol
    from study.storage import Store
    from study.versions import Version


def require_clips(protocol: Protocol, manifest: Manifest, folder: Path) -> None:
    """Refuse to show a study some of whose clips are not there."""
    if faults := _faults(protocol, manifest, folder):
        raise InputError(f"{faults} Run {_render(protocol)} first.")


def require_earlier_clips(versions: Iterable[Version], store: Store, folder: Path) -> None:
    """Refuse also where clips of a version are not there that somebody has begun and not finished."""
    sessions = [person.session for person in store.progress() if person.session]
    begun = {session.protocol_sha256 for session in sessions if not session.completed_at}
    for kept in versions:
        if kept.sha256 in begun and (faults := _faults(kept.protocol, kept.manifest, folder)):
            raise InputError(
                f"{faults} Participants who began before an amendment have yet to see them. "
                f"{_render(kept.protocol)} makes them, to be copied from its folder `stimuli`."
            )


def _faults(protocol: Protocol, manifest: Manifest, folder: Path) -> str | None:
    faults = [
        f"{stimulus}: {fault}"
        for stimulus in protocol.stimuli
        if (fault := _fault(manifest.clips.get(stimulus), folder))
    ]
    if not faults:
        return None
    some = f"{', '.join(faults[:5])}{' …' if len(faults) > 5 else ''}"
    return f"{folder}: {len(faults)} of {len(protocol.stimuli)} clips are not there as rendered ({some})."


def _fault(clip: Clip | None, folder: Path) -> str | None:
    """Why a clip must not be served: they would see nothing, another one, or a file from elsewhere."""
    if clip is None or not (file := folder / clip.file).is_file():
        return "missing"
    if file.resolve().parent != folder.resolve():
        return "a link to another folder"
    return None if sha256_of(file) == clip.file_sha256 else "changed"


def _render(protocol: Protocol) -> str:
    return f"`study render {shlex.quote(str(protocol.path))}`"
