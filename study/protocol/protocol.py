"""The protocol: a whole study as one value, read from one file."""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PrivateAttr, model_validator

from stimuli.dmp import Learning
from stimuli.principles import Modulation
from stimuli.robots.belongings import files_of_robot
from stimuli.robots.robot_file import ROBOT_FILES
from study.protocol.amendments import Amendment
from study.protocol.modulations import read_levels, read_modulations
from study.protocol.pairs import Pair, paired
from study.protocol.parts import (
    BESIDE,
    NEUTRAL,
    PRACTICE,
    Name,
    Part,
    Practice,
    PracticeStimulus,
    WrittenGesture,
    WrittenPart,
)
from study.protocol.plan import Analysis, Participants
from study.protocol.source import Source
from study.protocol.stimulus import Stimulus
from study.protocol.texts import (
    Texts,
    WrittenTexts,
    completed,
    files_named_in,
    shipped,
    shipped_demographics,
    without_gaps,
)
from study.protocol.video import Video
from study.questions import Asked
from study.text import Text
from study.written import A_LANGUAGE, Location, Written

Language = Annotated[str, Field(pattern=A_LANGUAGE)]


class WrittenLearning(Learning, Written):
    """How demonstrations are learned, as `learning:` has it; the defaults are meant to be left alone."""


class Protocol(Written):
    """A study. Fields are as written in the file; properties are what follows from them."""

    study: Name
    title: Text
    authors: tuple[str, ...] = ()
    contact: str
    ethics: str | None = None  # the approval's number
    languages: tuple[Language, ...] = Field(min_length=1)  # those of the title, unless told
    minutes: int | None = Field(None, ge=1, le=600)  # how long it takes; estimated, unless told
    robot: str
    seed: int = Field(ge=0)
    video: Video = Video()
    learning: WrittenLearning = WrittenLearning()
    gestures: dict[Name, WrittenGesture] = Field(min_length=1)
    modulations: Annotated[dict[Name, Modulation], BeforeValidator(read_modulations)] = Field(
        default_factory=dict
    )
    levels: Annotated[dict[Name, dict[Name, Modulation]], BeforeValidator(read_levels)] = Field(
        default_factory=dict
    )
    practice: Practice | None = None
    written_parts: dict[Name, WrittenPart] = Field(alias="parts", min_length=1)
    participants: Participants
    analysis: Analysis = Analysis()
    amendments: tuple[Amendment, ...] = ()
    demographics: tuple[Asked, ...] = Field(default_factory=shipped_demographics, validate_default=True)
    written_texts: WrittenTexts = Field(WrittenTexts(), alias="texts")

    _source: Source = PrivateAttr()

    @model_validator(mode="before")
    @classmethod
    def _languages_of_the_title(cls, data: Any) -> Any:
        if isinstance(data, dict) and "languages" not in data:
            title = data.get("title")
            return data | {"languages": list(title) if isinstance(title, dict) else ["en"]}
        return data

    @property
    def source(self) -> Source:
        """The file this was read from, with the place of every value."""
        return self._source

    @property
    def path(self) -> Path:
        """The file this was read from."""
        return self._source.path

    @property
    def folder(self) -> Path:
        """The folder that paths in the protocol start from."""
        return self.path.parent

    @property
    def robots(self) -> tuple[str, ...]:
        """The robots that are seen, the study's own first."""
        return tuple(dict.fromkeys(sorted(map(self.robot_of, self.gestures), key=self.robot.__ne__)))

    def robot_of(self, gesture: str) -> str:
        """The robot that shows a gesture."""
        return self.gestures[gesture].robot or self.robot

    def place_of_robot(self, robot: str) -> Location:
        """Where in the file a robot is named."""
        asking = (name for name, gesture in self.gestures.items() if gesture.robot == robot)
        return ("robot",) if robot == self.robot else ("gestures", next(asking), "robot")

    @cached_property
    def stimuli(self) -> Mapping[str, Stimulus]:
        """Every motion of the study by id: the parts' in the order written, then the practice's."""
        found: dict[str, Stimulus] = {}
        for part_id in self.written_parts:
            found |= {stimulus.id: stimulus for stimulus in self.stimuli_of(part_id)}
        for name, chosen in self._practised().items():
            modulation = self.modulations.get(chosen.modulation or NEUTRAL, Modulation())
            part = self.practice.ask if self.practice else ""
            found[name] = Stimulus(name, chosen.gesture, modulation, part, chosen.modulation)
        return found

    def _practised(self) -> dict[str, PracticeStimulus]:
        """What one practises on, by id."""
        if self.practice is None:
            return {}
        beside = {BESIDE: self.practice.beside} if self.practice.beside else {}
        return {PRACTICE: self.practice.stimulus} | beside

    @cached_property
    def judged(self) -> Mapping[str, Stimulus | Pair]:
        """Every stimulus by id, and every pair."""
        pairs = {pair.id: pair for part_id in self.written_parts for pair in self.pairs_of(part_id)}
        return {**self.stimuli, **pairs}

    def pairs_of(self, part_id: str) -> list[Pair]:
        """What a part shows side by side."""
        wanted = self.written_parts[part_id].pairs
        return [] if wanted is None else paired(self.stimuli_of(part_id), wanted)

    def judged_in(self, part_id: str) -> list[Stimulus] | list[Pair]:
        """What is judged in a part, in the order written: pairs, or stimuli that are no reference."""
        written = self.written_parts[part_id]
        if written.pairs is not None:
            return self.pairs_of(part_id)
        return [s for s in self.stimuli_of(part_id) if s.level is None or s.level != written.reference]

    def stimuli_of(self, part_id: str) -> list[Stimulus]:
        """The stimuli of a part, references too, in the order written."""
        chosen = self.written_parts[part_id].stimuli
        stimuli = []
        for gesture in chosen.gestures:
            prefix = chosen.prefix + (f"{gesture}_" if len(chosen.gestures) > 1 else "")
            for written_name in chosen.modulations or ():
                for name in self.members(written_name):
                    modulation = self.modulations.get(name, Modulation())
                    stimuli.append(Stimulus(prefix + name, gesture, modulation, part_id, name))
            for kind in chosen.levels or ():
                for level, modulation in self.levels[kind].items():
                    name = f"{prefix}{kind}_{level}"
                    stimuli.append(Stimulus(name, gesture, modulation, part_id, None, kind, level))
        return stimuli

    def members(self, name: str) -> tuple[str, ...]:
        """The modulations a name stands for: itself, or the members of its grid; none if it is unknown."""
        if name in self.modulations or name == NEUTRAL:
            return (name,)
        return tuple(member for member in self.modulations if re.fullmatch(rf"{re.escape(name)}_\d+", member))

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        """The parts by id, with everything looked up."""
        return {part_id: self._part(part_id) for part_id in self.written_parts}

    def _part(self, part_id: str) -> Part:
        written = self.written_parts[part_id]
        stimuli = self.stimuli_of(part_id)
        ids = {(s.gesture, s.principle, s.level): s.id for s in stimuli}
        judged, pairs = self.judged_in(part_id), self.pairs_of(part_id)
        references = {
            s.id: ids[s.gesture, s.principle, written.reference] for s in judged if written.reference
        }
        compared = [stimulus.id for stimulus in stimuli] if pairs else []
        intro = self.texts.introducing(comparison=bool(references), pairs=bool(pairs))
        return Part(
            id=part_id,
            title=written.title,
            intro=self._completed(written.intro) if written.intro else intro,
            stimuli=tuple(s.id for s in judged),
            questions=tuple(question.among(compared) for question in written.ask),
            order=written.order,
            references=references,
            pairs={pair.id: pair.ids for pair in pairs},
            only_if=written.only_if,
            shown=shown if (shown := written.order.shown(judged)) < len(judged) else None,
        )

    @cached_property
    def texts(self) -> Texts:
        """The texts around the questions, the protocol's own or else the shipped ones, ready to be shown."""
        unknown = [name for name in ("authors", "ethics") if not getattr(self, name)]
        if self.participants.recruitment.service is None:
            unknown.append("service")
        return Texts(
            **{
                name: self._completed(
                    getattr(self.written_texts, name) or without_gaps(shipped(name), unknown)
                )
                for name in Texts.model_fields
            }
        )

    @cached_property
    def length(self) -> tuple[int, int]:
        """How many videos a participant sees, and how many minutes it takes, estimated or as told."""
        videos, seconds = (len(self._practised()), 90.0) if self.practice else (0, 60.0)
        for part in self.written_parts:
            judged, items, clips = self._pages(part)
            videos += judged * clips
            seconds += judged * (10 + 10 * clips + 4 * items)
        return videos, self.minutes or math.ceil(seconds / 60)

    def _pages(self, part_id: str) -> tuple[int, int, int]:
        """Of one part: pages that a participant sees, items to answer on each, clips on each."""
        part = self.written_parts[part_id]
        items = sum(len(question.items) for question in part.ask)
        two = part.reference is not None or part.pairs is not None
        return part.order.shown(self.judged_in(part_id)), items, 2 if two else 1

    def _completed(self, text: Text) -> Text:
        videos, minutes = self.length
        values = {
            "title": self.title,
            "contact": Text(self.contact),
            "authors": Text(", ".join(self.authors)),
            "ethics": Text(self.ethics or ""),
            "service": Text(self.participants.recruitment.called or ""),
            "videos": Text(str(videos)),
            "minutes": Text(str(minutes)),
        }
        return completed(text, self.languages, folder=self.folder, values=values)

    def continues(self, sha256: str) -> bool:
        """Whether the protocol of this hash is this one, or one that a declared amendment replaces."""
        return sha256 == self.sha256 or sha256.startswith(tuple(a.replaces for a in self.amendments))

    @cached_property
    def files(self) -> tuple[str, ...]:
        """The files the study is made of beside its YAML: gestures, texts in files, and robots of its own."""
        texts = [text for _, text in self.written_texts if text]
        texts += [part.intro for part in self.written_parts.values() if part.intro]
        named = [text.root[language] for text in texts for language in files_named_in(text, self.folder)]
        robots = [file for robot in self.robots for file in self.files_of_robot(robot)]
        return (*(str(gesture.file) for gesture in self.gestures.values()), *named, *dict.fromkeys(robots))

    def files_of_robot(self, robot: str) -> tuple[str, ...]:
        """The files of a robot that the study brings: its YAML, its model and what that names."""
        if not robot.endswith(ROBOT_FILES):
            return ()
        found = files_of_robot(self.folder / robot)
        return tuple(Path(os.path.relpath(file, self.folder)).as_posix() for file in found)

    @cached_property
    def sha256(self) -> str:
        """Hash of the study's content: what the YAML says, and the bytes of the files it names.

        The YAML counts as the values read, in the order written: comments and layout do not change the hash,
        nor do new fields of later versions of this software.
        """
        files = {
            path: hashlib.sha256((self.folder / path).read_bytes()).hexdigest()
            if (self.folder / path).is_file()
            else None
            for path in self.files
        }
        content = json.dumps([self.source.value, files], ensure_ascii=False, separators=(",", ":"))
        return hashlib.sha256(content.encode()).hexdigest()
