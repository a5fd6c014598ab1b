"""Everything there is to check before the first participant comes, as one screen."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from datetime import date
from functools import partial
from typing import Any, Literal

from stimuli.ends import EASE_S, rests_at_ends
from stimuli.errors import InputError
from stimuli.motion import Lesson, generate, learn
from stimuli.relations import in_short, relations_of
from stimuli.robots import load_robot
from stimuli.robots.model import Robot
from study.balance import DRAWN, balance
from study.orders import cycle, draw_plan
from study.power import power
from study.protocol import Protocol
from study.questions.scale import Scale
from study.specs import ABSENT, specs
from study.untranslated import unseen_languages, untranslated
from study.web.language import interface_languages
from study.words import count, in_brief, listed, tested

Verdict = Literal["good", "mind", "wrong"]
Progress = Callable[[int, int], object]  # how many of how many
WIDTH = 110  # of the screen


@dataclass(frozen=True)
class Finding:
    """One thing looked at: whether it is good, should be borne in mind, or must be mended."""

    verdict: Verdict
    about: str
    message: str
    within: str | None = None  # what it is a part of

    @property
    def title(self) -> str:
        """What it is about, as it stands on the screen."""
        return f"  {self.about}" if self.within else self.about


@dataclass(frozen=True)
class Report:
    """What `study check` found."""

    study: str
    sha256: str
    findings: tuple[Finding, ...]

    @property
    def good(self) -> bool:
        """Whether data may be gathered."""
        return all(finding.verdict != "wrong" for finding in self.findings)

    def as_json(self) -> dict[str, Any]:
        """The same for programs."""
        return {**asdict(self), "good": self.good}

    def __str__(self) -> str:
        signs = {"good": "✓", "mind": "!", "wrong": "✗"}
        width = max(len(finding.title) for finding in self.findings)
        lines = []
        for finding in self.findings:
            first, *rest = _wrapped(finding.message, WIDTH - width - 4)
            lines.append(f"{signs[finding.verdict]} {finding.title:<{width}}  {first}")
            lines += [f"  {'':<{width}}  {line}" for line in rest]
        end = "Ready for participants." if self.good else "Not ready: mend what is marked ✗."
        return "\n".join([f"{self.study} ({self.sha256[:12]})", *lines, end])


def _wrapped(message: str, width: int) -> list[str]:
    """The message's lines, long ones broken; places in files and what is to be copied stay whole."""
    return [
        part
        for line in message.split("\n")
        for part in textwrap.wrap(line, width, break_long_words=False, break_on_hyphens=False) or [""]
    ]


def check(protocol: Protocol, progress: Progress | None = None, *, today: date | None = None) -> Report:
    """Look at everything that can be known before data are gathered.

    `progress` hears of each motion; dates are looked at where it is told what day it is.
    """
    motions = partial(_motions, progress=progress or (lambda *_: None))
    amendments = partial(_amendments, today=today)
    looked_at = (_structure, _unseen, _alike, motions, _texts, _orders, _stop, _hypotheses, amendments)
    findings = tuple(finding for look in looked_at for finding in look(protocol))
    return Report(protocol.study, protocol.sha256, findings)


def _structure(protocol: Protocol) -> Iterator[Finding]:
    judged = sum(len(part.stimuli) for part in protocol.parts.values())
    videos, minutes = protocol.length
    yield Finding(
        "good",
        "study",
        f"{count(len(protocol.stimuli), 'stimulus', 'stimuli')}; {judged} to judge in "
        f"{count(len(protocol.parts), 'part')}; a participant sees {count(videos, 'video')} in about "
        f"{count(minutes, 'minute')}",
    )


def _unseen(protocol: Protocol) -> Iterator[Finding]:
    """What is declared but never shown: no stimulus has it, and no modulation extends it."""
    seen = protocol.stimuli.values()
    written = protocol.source.value.get("modulations", {})
    used = {stimulus.name for stimulus in seen} | {entry.get("extends") for entry in written.values()}
    unseen = {
        "gestures": set(protocol.gestures) - {stimulus.gesture for stimulus in seen},
        "modulations": {name for name in written if not used & {name, *protocol.members(name)}},
        "levels": set(protocol.levels) - {stimulus.principle for stimulus in seen},
    }
    for field, names in unseen.items():
        if names:
            yield Finding("mind", field, f"declared but shown in no part: {', '.join(sorted(names))}")


def _alike(protocol: Protocol) -> Iterator[Finding]:
    """Stimuli of a part that are one and the same motion."""
    for part_id, part in protocol.written_parts.items():
        known: dict[tuple[str, str], str] = {}
        for stimulus in protocol.stimuli_of(part_id):
            if part.reference and stimulus.level == part.reference:
                continue
            motion = (stimulus.gesture, stimulus.modulation.model_dump_json())
            same = known.setdefault(motion, stimulus.id)
            if same != stimulus.id:
                yield Finding("mind", "stimuli", f"{same} and {stimulus.id} are the same motion")


def _alone(error: InputError, value: str) -> str:
    """A message without the value it begins with, which stands before it already."""
    return str(error).removeprefix(value).lstrip()


def _motions(protocol: Protocol, progress: Progress) -> Iterator[Finding]:
    """Every gesture can be read, and the robots can do every stimulus."""
    robots, broken = {}, []
    for name in protocol.robots:
        try:
            robots[name] = load_robot(name, protocol.folder)
        except InputError as error:
            broken.append(
                str(protocol.source.problem(protocol.place_of_robot(name), _alone(error, f"robot: {name!r}")))
            )
    if broken:
        yield Finding("wrong", "robot", "\n".join(broken))
        return
    lessons = {}
    for name, gesture in protocol.gestures.items():
        try:
            lessons[name] = learn(
                protocol.folder / gesture.file, robots[protocol.robot_of(name)], protocol.learning
            )
        except InputError as error:
            there = (protocol.folder / gesture.file).is_file()
            broken.append(str(error if there else protocol.source.problem(("gestures", name), ABSENT)))
    if broken:
        yield Finding("wrong", "gestures", "\n".join(broken))
        return
    titles = ", ".join(robot.title for robot in robots.values())
    yield Finding("good", "gestures", f"{len(protocol.gestures)} read for {titles}")
    yield from _eased(lessons, protocol)
    if any({"sec", "follow"} & set(one.modulation.model_dump()) for one in protocol.stimuli.values()):
        for robot in robots.values():
            yield Finding("good", "relations", in_short(relations_of(robot, robot.joint_names)))
    beyond = []
    wanted = specs(protocol)
    for done, (id_, spec) in enumerate(wanted.items(), start=1):
        try:
            generate(spec, robots[spec.robot], lessons[protocol.stimuli[id_].gesture])
        except InputError as error:
            beyond.append(str(error))
        progress(done, len(wanted))
    if beyond:
        yield Finding("wrong", "motions", "\n".join(beyond))
    else:
        yield Finding("good", "motions", "the robot can do every stimulus within its limits")
    yield from _unchecked(robots)


def _unchecked(robots: Mapping[str, Robot]) -> Iterator[Finding]:
    """Joints whose velocity limit nobody gave."""
    for name, robot in robots.items():
        unknown = ", ".join(joint.name for joint in robot.joints if joint.max_velocity is None)
        if unknown:
            unchecked = f"{name}: how fast {unknown} may move is unknown, so it is not checked"
            yield Finding("mind", "motions", f"{unchecked}; give `velocities` in the robot's file")


def _eased(lessons: Mapping[str, Lesson], protocol: Protocol) -> Iterator[Finding]:
    """Which gestures do not rest where they start or end, if they need not."""
    for name, lesson in lessons.items() if protocol.learning.moving_ends == "ease" else ():
        ends = zip(("start", "end"), rests_at_ends(lesson.demonstration), strict=True)
        moving = " and ".join(end for end, rests in ends if not rests)
        if moving:
            eased = f"eased over {EASE_S:g} s of it, which then take twice as long: docs/formats.md"
            yield Finding("mind", "gestures", f"{name} moves at its {moving}; {eased}")


def _texts(protocol: Protocol) -> Iterator[Finding]:
    """Every text is there in every language."""
    if problems := untranslated(protocol):
        yield Finding("wrong", "texts", "\n".join(map(str, problems)))
    else:
        yield Finding("good", "texts", f"complete in {listed(protocol.languages)}")
    if unseen := unseen_languages(protocol):
        seen = f"the study is in {listed(protocol.languages)}, as its title or `languages` says"
        yield Finding("mind", "texts", f"nobody sees those in {listed(unseen)}: {seen}")
    for language in protocol.languages:
        if language not in interface_languages():
            yield Finding(
                "mind", "texts", f"buttons and messages are not in {language}: docs/sessions.md, Languages"
            )
    for question in (question for part in protocol.parts.values() for question in part.questions):
        if isinstance(question, Scale):
            for language in sorted(set(question.unpublished) & set(protocol.languages)):
                unpublished = "is our own translation, unpublished and not validated"
                yield Finding("mind", "texts", f"{question.set} in {language} {unpublished}")


def _orders(protocol: Protocol) -> Iterator[Finding]:
    """The planned number of participants fills the design evenly."""
    planned = protocol.participants.planned
    drawn = min(planned, DRAWN)
    try:
        plans = [draw_plan(protocol, slot) for slot in range(drawn)]
    except InputError as error:
        yield Finding("wrong", "orders", str(error))
        return
    whole = cycle(protocol)
    if whole == 1:
        yield Finding(
            "good", "orders", "any number of participants will do: no order is shared out among them"
        )
    elif planned % whole:
        fewer, more = planned - planned % whole, planned - planned % whole + whole
        others = f"{fewer} or {more}" if fewer else str(more)
        yield Finding("mind", "orders", f"uneven with {count(planned, 'participant')}; even with {others}")
    else:
        yield Finding(
            "good", "orders", f"{planned} participants fill them evenly, as does every multiple of {whole}"
        )
    for part in balance(protocol, plans):
        order = in_brief(protocol.parts[part.part].order)
        among = f"of the first {drawn}, " if drawn < planned else ""
        yield Finding("good", part.part, f"{order}: {among}{part}", within="orders")


def _stop(protocol: Protocol) -> Iterator[Finding]:
    rules = protocol.participants
    who = "one has" if rules.planned == 1 else f"{rules.planned} have"
    closes = f"the study closes itself when {who} completed it"
    by_hand = "the experimenter closes the study"
    yield Finding("good", "stop", closes if rules.stop == "when complete" else by_hand)


def _amendments(protocol: Protocol, today: date | None) -> Iterator[Finding]:
    """Changes bear the day on which they were declared."""
    for amendment in protocol.amendments:
        if today and amendment.date > today:
            message = f"{amendment.date} lies ahead; give the day of the change: {amendment.reason}"
            yield Finding("mind", "amendments", message)


def _hypotheses(protocol: Protocol) -> Iterator[Finding]:
    hypotheses = protocol.analysis.hypotheses
    powers = {found.hypothesis: f"\n{found}" for found in power(protocol)}
    if not hypotheses:
        yield Finding("mind", "analysis", "no hypothesis is declared; tests chosen after the data prove less")
    for name, hypothesis in hypotheses.items():
        mirrored = f"; the mirror image of {hypothesis.mirrors}, counted once" if hypothesis.mirrors else ""
        found = f"{tested(protocol, hypothesis)}{mirrored}{powers.get(name, '')}".replace("*", "")
        yield Finding("good", name, f"{hypothesis.part}: {found}")
