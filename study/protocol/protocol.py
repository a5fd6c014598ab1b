"""The protocol: a whole study as one value, read from one file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from study.protocol.errors import ProtocolError
from study.protocol.modulations import Modulation
from study.protocol.parts import Name, Part, Practice, Stimulus, WrittenPart
from study.protocol.plan import Analysis, Participants
from study.protocol.source import Source, read_source
from study.questions import Asked, Question
from study.text import Text
from study.written import Seconds, Written

Language = Annotated[str, Field(pattern=r"^[a-z]{2,3}(-[A-Z]{2})?$")]


class Video(Written):
    """Size, timing and framing, the same for every clip of a study."""

    size: str = Field("1280x720", pattern=r"^[1-9]\d{1,3}x[1-9]\d{1,3}$")
    fps: int = Field(30, ge=1, le=120)
    camera: str = "auto"
    lead_in: Seconds = 0.5
    hold: Seconds = 0.5


class Protocol(Written):
    """A study. Fields are as written in the file; properties are what follows from them."""

    study: Name
    title: Text
    authors: list[str] = []
    contact: str
    ethics: str | None = None
    languages: tuple[Language, ...] = Field(min_length=1)
    robot: str
    seed: int = Field(ge=0)
    video: Video = Video()
    gestures: dict[Name, Path] = Field(min_length=1)
    modulations: dict[Name, Modulation] = {}
    levels: dict[Name, Any] = {}
    practice: Practice | None = None
    written_parts: dict[Name, WrittenPart] = Field(alias="parts", min_length=1)
    participants: Participants
    analysis: Analysis = Analysis()
    demographics: list[Asked] = []
    texts: dict[str, Text] = {}

    _source: Source = PrivateAttr()

    @model_validator(mode="before")
    @classmethod
    def _languages_of_the_title(cls, data: Any) -> Any:
        if isinstance(data, dict) and "languages" not in data:
            title = data.get("title")
            return data | {"languages": list(title) if isinstance(title, dict) else ["en"]}
        return data

    @property
    def path(self) -> Path:
        """The file this was read from."""
        return self._source.path

    @property
    def folder(self) -> Path:
        """The folder that paths in the protocol start from."""
        return self.path.parent

    @cached_property
    def stimuli(self) -> Mapping[str, Stimulus]:
        """Every motion of the study by id: the parts' in the order written, then the practice's."""
        found: dict[str, Stimulus] = {}
        for part_id, part in self.written_parts.items():
            found |= {stimulus.id: stimulus for stimulus in self._stimuli_of(part_id, part)}
        if self.practice:
            chosen = self.practice.stimulus
            modulation = self.modulations[chosen.modulation] if chosen.modulation else Modulation()
            found["practice"] = Stimulus(
                "practice", chosen.gesture, modulation, self.practice.ask, chosen.modulation
            )
        return found

    def _stimuli_of(self, part_id: str, part: WrittenPart) -> list[Stimulus]:
        chosen = part.stimuli
        stimuli = []
        for gesture in chosen.gestures:
            prefix = chosen.prefix + (f"{gesture}_" if len(chosen.gestures) > 1 else "")
            for name in chosen.modulations or ():
                stimuli.append(Stimulus(prefix + name, gesture, self.modulations[name], part_id, name))
            for kind in chosen.levels or ():
                for level, value in zip(("low", "medium", "high"), self.levels[kind], strict=True):
                    modulation = Modulation({kind: value})
                    stimuli.append(
                        Stimulus(f"{prefix}{kind}_{level}", gesture, modulation, part_id, None, kind, level)
                    )
        return stimuli

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        """The parts by id, with everything looked up."""
        parts = {}
        for part_id, written in self.written_parts.items():
            stimuli = self._stimuli_of(part_id, written)
            by_key = {(s.gesture, s.principle, s.level): s.id for s in stimuli}
            judged = [s for s in stimuli if s.level is None or s.level != written.reference]
            references = {
                s.id: by_key[s.gesture, s.principle, written.reference] for s in judged if written.reference
            }
            parts[part_id] = Part(
                id=part_id,
                title=written.title,
                intro=written.intro or Text(""),
                stimuli=tuple(s.id for s in judged),
                questions=tuple(written.ask),
                order=written.order,
                references=references,
            )
        return parts

    @cached_property
    def sha256(self) -> str:
        """Hash of the study's content: what the YAML says, and the bytes of the files it names.

        The YAML counts as the values read, in the order written: comments and layout do not change the hash,
        nor do new fields of later versions of this software.
        """
        files = {
            str(path): hashlib.sha256((self.folder / path).read_bytes()).hexdigest()
            if (self.folder / path).is_file()
            else None
            for path in self.gestures.values()
        }
        content = json.dumps([self._source.value, files], ensure_ascii=False, separators=(",", ":"))
        return hashlib.sha256(content.encode()).hexdigest()


def load_protocol(path: Path) -> Protocol:
    """Read a protocol from its file, or from the `protocol.yaml` in a folder.

    Raises ProtocolError with everything that is wrong, each at its line.
    """
    file = path / "protocol.yaml" if path.is_dir() else path
    source = read_source(file)
    try:
        protocol = Protocol.model_validate(source.value)
    except ValidationError as error:
        raise ProtocolError(
            source.problem(
                detail["loc"], detail["msg"], name=detail["type"] in {"missing", "extra_forbidden"}
            )
            for detail in error.errors(include_url=False)
        ) from None
    protocol._source = source
    return protocol
