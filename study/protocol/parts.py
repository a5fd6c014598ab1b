"""Parts: which stimuli are shown, in which order, with which questions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from study.protocol.pairs import Pair, Pairs
from study.protocol.stimulus import Alike, Stimulus
from study.questions import Asked, Question
from study.questions.scale import Scale
from study.text import Text
from study.written import A_NAME, Written, wrong, wrong_at

Name = Annotated[str, Field(pattern=A_NAME, max_length=60)]
Method = Literal["williams", "latin square", "shuffled", "fixed", "between participants"]

BETWEEN: Literal["between participants"] = "between participants"  # each participant sees but one
NEUTRAL = "neutral"  # the modulation that changes nothing, always there
PRACTICE = "practice"  # id of the stimulus one practises on
BESIDE = "practice_beside"  # id of the one beside it, where pairs are compared


def _one_or_more(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


class Selection(Written):
    """Which stimuli a part has: gestures under named modulations, or at the levels of principles."""

    gesture: Annotated[
        list[Name],
        BeforeValidator(_one_or_more, json_schema_input_type=Name | list[Name]),
        Field(min_length=1),
    ]
    modulations: list[Name] | None = Field(None, min_length=1)
    levels: list[Name] | None = Field(None, min_length=1)
    prefix: str = ""  # put before the ids, where two parts would otherwise give a stimulus the same one

    @model_validator(mode="after")
    def _either(self) -> Self:
        if (self.modulations is None) == (self.levels is None):
            raise wrong("needs either modulations or levels")
        return self

    @property
    def gestures(self) -> tuple[str, ...]:
        """The demonstrations, one or more."""
        return tuple(self.gesture)


class Gesture(Written):
    """A demonstration: its file, and the robot that shows it where that is not the study's."""

    file: Path
    robot: str | None = None


def _file(value: Any) -> Any:
    if value is None or isinstance(value, (list, int, float)):
        raise wrong("must be a file, such as gestures/wave.yaml")
    return {"file": value} if isinstance(value, (str, Path)) else value


WrittenGesture = Annotated[Gesture, BeforeValidator(_file, json_schema_input_type=Path | Gesture)]


class Order(Written):
    """How a part's trials are ordered.

    Either all `stimuli` by one method; or in blocks of the same gesture, principle or modulation: the blocks
    by the method named there, and within each block its `levels` or `stimuli` by another.
    """

    stimuli: Method | None = None
    gestures: Method | None = None
    principles: Method | None = None
    modulations: Method | None = None
    levels: Literal["balanced"] | None = None  # within principles; evenly spread within each participant
    max_run: dict[Alike, Annotated[int, Field(ge=1)]] = Field(default_factory=dict)
    """With `stimuli: shuffled`: no more than so many in a row that are alike, such as {gesture: 2}."""

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        blocks = [name for name in ("gestures", "principles", "modulations") if getattr(self, name)]
        if len(blocks) > 1:
            raise wrong(f"has blocks of {' and of '.join(blocks)}; choose one")
        if not blocks and self.stimuli is None:
            raise wrong("needs a method, such as williams or {principles: williams, levels: balanced}")
        if self.levels and (blocks != ["principles"] or self.stimuli):
            raise wrong("has levels; they go with principles alone: {principles: williams, levels: balanced}")
        if blocks and not self.levels and self.stimuli is None:
            raise wrong(
                f"leaves the order within its blocks open; add stimuli, as in {{{blocks[0]}: "
                "williams, stimuli: shuffled}"
            )
        if self.max_run and (blocks or self.stimuli != "shuffled"):
            raise wrong("has max_run, which goes with {stimuli: shuffled} alone")
        return self

    @property
    def blocks(self) -> tuple[Alike, Method] | None:
        """What the blocks have in common and how they are ordered."""
        named: dict[Alike, Method | None] = {
            "gesture": self.gestures,
            "principle": self.principles,
            "modulation": self.modulations,
        }
        return next(((alike, method) for alike, method in named.items() if method), None)

    def shown(self, stimuli: Sequence[Stimulus | Pair]) -> int:
        """How many of the stimuli one participant sees."""
        groups = Counter(stimulus.feature(self.blocks[0]) if self.blocks else None for stimulus in stimuli)
        each = [1 if self.stimuli == BETWEEN else size for size in groups.values()]
        return max(each) if self.blocks and self.blocks[1] == BETWEEN else sum(each)


def _order(value: Any) -> Any:
    return {"stimuli": value} if isinstance(value, str) else value


def _answers(value: Any) -> Any:
    """Read one answer as a list of one, and numbers as the texts that answers are."""
    if not isinstance(value, Mapping) or not value:
        raise wrong("must be answers by item, such as {experience: [some, much]}")
    listed = {item: answers if isinstance(answers, list) else [answers] for item, answers in value.items()}
    plain = (str, int, float)
    for item, answers in listed.items():
        if not answers or not all(isinstance(answer, plain) for answer in answers):
            raise wrong_at((item,), "must be an answer, or a list of answers", answers)
    return {item: [str(answer) for answer in answers] for item, answers in listed.items()}


Condition = Annotated[
    dict[str, tuple[str, ...]],
    BeforeValidator(_answers, json_schema_input_type=dict[str, str | list[str]]),
]
"""Items asked earlier, each with the answers of which one was given."""


class WrittenPart(Written):
    """A part as the protocol has it; `Protocol.parts` has it resolved."""

    title: Text
    intro: Text | None = None
    stimuli: Selection
    reference: Name | None = None  # the level shown before each judged one
    pairs: Pairs | None = None  # shown side by side
    order: Annotated[Order, BeforeValidator(_order, json_schema_input_type=Method | Order)] = Order(
        stimuli="williams"
    )
    only_if: Condition = Field(default_factory=dict, alias="if")
    ask: tuple[Asked, ...] = Field(min_length=1)


class PracticeStimulus(Written):
    """A stimulus of no part, to get to know the page by."""

    gesture: Name
    modulation: Name | None = None  # neutral


class Practice(Written):
    """One page before the first part: a stimulus and a part's questions, left out of all results."""

    stimulus: PracticeStimulus
    beside: PracticeStimulus | None = None  # where the part compares pairs: the other one
    ask: Name  # the part whose questions are asked


def series_of(questions: Sequence[Question]) -> dict[str, tuple[str, ...]]:
    """Series by name, each with its items, over these questions."""
    scored = [
        pair for question in questions if isinstance(question, Scale) for pair in question.series.items()
    ]
    return {name: tuple(item for item, of in scored if of == name) for _, name in scored}


def could_be_meant(questions: Sequence[Question]) -> list[str]:
    """The items that a hypothesis which names none may be about: all but checks and free words."""
    return [item for q in questions if q.kind not in {"attention", "text"} for item in q.items]


@dataclass(frozen=True)
class Part:
    """A part with everything looked up."""

    id: str
    title: Text
    intro: Text
    stimuli: tuple[str, ...]  # ids of what is judged, stimuli or pairs, as written; without references
    questions: tuple[Question, ...]
    order: Order
    references: Mapping[str, str] = field(default_factory=dict)
    pairs: Mapping[str, tuple[str, str]] = field(
        default_factory=dict
    )  # id of a pair → ids of its two stimuli
    only_if: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    shown: int | None = None  # how many of the stimuli one participant sees, where those are not all

    def reference_of(self, stimulus: str) -> str | None:
        """The clip shown before this one."""
        return self.references.get(stimulus)

    @property
    def groups(self) -> int:
        """Among how many groups of participants the stimuli are shared out."""
        return len(self.stimuli) // (self.shown or len(self.stimuli))

    def due(self, given: Mapping[str, Collection[str]]) -> bool:
        """Whether this part is shown to somebody who gave these answers earlier, by item."""
        return all(set(answers) & set(given.get(item, ())) for item, answers in self.only_if.items())
