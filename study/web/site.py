"""What the application serves: one study with its clips and its store, and what its routes share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from fastapi import Request

from study.orders import Trial
from study.participants import Kind

if TYPE_CHECKING:
    from stimuli.manifest import Manifest
    from study.protocol import Protocol
    from study.sessions import Session
    from study.storage import Store
    from study.versions import Version
    from study.web.credentials import Credentials


Door = Literal["open", "link", "kiosk"]
"""Who may come in: anybody; whoever has a link, a code or was recruited; or, at a laboratory's computer that
is handed from one to the next, whoever sits there after the experimenter's key was typed."""


@dataclass(frozen=True)
class Clip:
    """One rendered stimulus, as it is served."""

    path: Path
    sha256: str
    size: int  # bytes
    duration_s: float

    @property
    def name(self) -> str:
        """Name in addresses: by content, so that it can be cached for ever and tells nobody the condition."""
        return f"{self.sha256[:32]}.mp4"


def clips_of(manifest: Manifest, folder: Path) -> dict[str, Clip]:
    """The clips of a manifest by stimulus id; `folder` is where their files are."""
    return {
        stimulus: Clip(folder / clip.file, clip.file_sha256, clip.size_bytes, clip.duration_s)
        for stimulus, clip in manifest.clips.items()
    }


def hashes(clips: Mapping[str, Clip]) -> dict[str, str]:
    """The hash of each clip's file, by stimulus id."""
    return {stimulus: clip.sha256 for stimulus, clip in clips.items()}


def utc_now() -> datetime:
    """The present moment."""
    return datetime.now(UTC)


@dataclass(frozen=True)
class Site:
    """One study, being served."""

    protocol: Protocol
    store: Store
    clips: Mapping[str, Clip]  # by stimulus id
    credentials: Credentials
    software: str
    kind: Kind = "participant"  # of whoever enters without a link
    door: Door = "open"
    analyse: Callable[[Path, Path], object] | None = None  # responses.csv and a folder → report.html in it
    backup_fault: Callable[[], str | None] = field(default=lambda: None)  # why the latest backup failed
    clock: Callable[[], datetime] = field(default=utc_now)
    earlier: Mapping[str, Site] = field(default_factory=dict)  # as it was before amendments, by protocol hash

    def as_begun(self, session: Session) -> Site | None:
        """The site as it was when the session began; None where that version is not kept."""
        begun_with = session.protocol_sha256
        return self if begun_with == self.protocol.sha256 else self.earlier.get(begun_with)

    def with_earlier(self, versions: Iterable[Version], folder: Path) -> Site:
        """The same, knowing its earlier versions, whose clips are in the folder too."""
        return replace(
            self,
            earlier={
                version.sha256: replace(
                    self, protocol=version.protocol, clips=clips_of(version.manifest, folder)
                )
                for version in versions
            },
        )

    @property
    def clip_hashes(self) -> Mapping[str, Mapping[str, str]]:
        """The hashes of the clips' files, by hash of the protocol."""
        return {self.protocol.sha256: hashes(self.clips)} | {
            sha256: hashes(site.clips) for sha256, site in self.earlier.items()
        }

    def clips_on(self, trial: Trial) -> dict[str, Clip]:
        """The clips of a trial by role, in the order shown."""
        if trial.pair:
            return {side: self.clips[id_] for side, id_ in zip(("left", "right"), trial.pair, strict=True)}
        reference = {} if trial.reference is None else {"reference": self.clips[trial.reference]}
        return reference | {"clip": self.clips[trial.stimulus]}


def site_of(request: Request) -> Site:
    """The site a request is for."""
    site: Site = request.app.state.site
    return site
