"""Parts: which stimuli are shown, in which order, with which questions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator
from typing_extensions import Self

from study.protocol.modulations import Modulation
from study.questions import Asked, Question
from study.text import Text
from study.written import Written, wrong

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", max_length=60)]
Method = Literal["williams", "latin square", "blocked", "shuffled", "fixed", "between participants"]


class Selection(Written):
    """Which stimuli a part has: gestures under named modulations, or at the levels of principles."""

    gesture: Name | list[Name]
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
        return (self.gesture,) if isinstance(self.gesture, str) else tuple(self.gesture)


class Order(Written):
    """How a part's trials are ordered.

    Either all `stimuli` by one method, or the `principles` by a method and within each its `levels`.
    """

    stimuli: Method | None = None
    principles: Method | None = None
    levels: Literal["balanced", "shuffled", "fixed"] = "balanced"
    max_run: dict[Literal["gesture", "modulation", "principle", "level"], Annotated[int, Field(ge=1)]] = {}
    # no more than so many in a row with the same gesture, …

    @model_validator(mode="after")
    def _either(self) -> Self:
        if (self.stimuli is None) == (self.principles is None):
            raise wrong(
                "orders either stimuli or principles, such as {principles: williams, levels: balanced}"
            )
        return self


def _order(value: Any) -> Any:
    return {"stimuli": value} if isinstance(value, str) else value


class WrittenPart(Written):
    """A part as the protocol has it; `Protocol.parts` has it resolved."""

    title: Text
    intro: Text | None = None
    stimuli: Selection
    reference: Name | None = None  # the level shown before each judged one
    order: Annotated[Order, BeforeValidator(_order)] = Order(stimuli="williams")
    ask: list[Asked] = Field(min_length=1)


class PracticeStimulus(Written):
    """A stimulus of no part, to get to know the page by."""

    gesture: Name
    modulation: Name | None = None  # neutral


class Practice(Written):
    """One page before the first part: a stimulus and a part's questions, left out of all results."""

    stimulus: PracticeStimulus
    ask: Name  # the part whose questions are asked


@dataclass(frozen=True)
class Stimulus:
    """One motion to be seen: a gesture under a modulation."""

    id: str
    gesture: str
    modulation: Modulation
    part: str
    name: str | None = None  # of the modulation, where it has one
    principle: str | None = None
    level: str | None = None


@dataclass(frozen=True)
class Part:
    """A part with everything looked up."""

    id: str
    title: Text
    intro: Text
    stimuli: tuple[str, ...]  # ids of those judged, as written; references are not among them
    questions: tuple[Question, ...]
    order: Order
    references: Mapping[str, str] = field(default_factory=dict)

    def reference_of(self, stimulus: str) -> str | None:
        """The clip shown before this one."""
        return self.references.get(stimulus)
