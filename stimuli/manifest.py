"""The list beside the clips: for each stimulus its file, its whole specification, and what made it."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from stimuli.errors import InputError
from stimuli.whole_files import whole_or_nothing

FILE = "manifest.json"


class Clip(BaseModel):
    """One rendered stimulus."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    file: str = Field(
        pattern=r"^\w[\w.-]*\.mp4$"
    )  # in the manifest's folder and nowhere else: it will be served
    file_sha256: str
    spec: Mapping[str, Any]  # the stimulus' specification, no parameter left to a default
    spec_sha256: str
    frames: int
    fps: int
    duration_s: float  # frames / fps
    width: int
    height: int
    size_bytes: int
    descriptors: Mapping[str, float] = Field(default_factory=dict)
    margins: Mapping[str, Any] = Field(
        default_factory=dict
    )  # how far the motion stays from the robot's limits
    robot_sources: tuple[str, ...] = ()  # where the robot's model comes from, with its version
    software: Mapping[str, str]
    gl_renderer: str

    def is_whole(self, folder: Path) -> bool:
        """Whether its file is there, as it was rendered."""
        path = folder / self.file
        return (
            path.is_file() and path.stat().st_size == self.size_bytes and sha256_of(path) == self.file_sha256
        )


class Framing(BaseModel):
    """The camera chosen for those stimuli of a robot that left it to us."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    stimuli_sha256: str
    camera: str


class Manifest(BaseModel):
    """All clips of a folder, by stimulus."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    stimuli: Mapping[str, Clip] = Field(default_factory=dict)
    framing: Mapping[str, Framing] = Field(default_factory=dict)  # by robot
    unused: tuple[Clip, ...] = ()  # that no stimulus has now; shown again if one is changed back

    @property
    def clips(self) -> Mapping[str, Clip]:
        """The clips by stimulus id."""
        return self.stimuli

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read a folder's manifest; a folder without one has no clips yet."""
        path = folder / FILE
        try:
            return cls.model_validate_json(path.read_bytes())
        except FileNotFoundError:
            return cls()
        except ValidationError as error:
            raise InputError(
                f"{path}: this is not a manifest of clips ({error.errors()[0]['msg']}). "
                "Delete it and render again: `study render` then draws all of them anew."
            ) from error

    def save(self, folder: Path) -> None:
        """Write the manifest in one step."""
        with whole_or_nothing(folder / FILE) as partial:
            partial.write_text(self.model_dump_json(indent=1) + "\n", encoding="utf-8")


def sha256_of(path: Path) -> str:
    """Hash of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
