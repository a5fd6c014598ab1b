"""The design of a study on one screen: what is varied, who sees what, in which order, and how evenly."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

from study.balance import DRAWN, balance
from study.orders import cycle, draw_plan
from study.protocol import Part, Protocol
from study.words import count, ordered


@dataclass(frozen=True)
class PartDesign:
    """One part: its factors with their levels, its order and how that balances."""

    part: str
    factors: dict[str, list[str]]
    between: bool  # whether a participant sees but some of the stimuli
    pages: int  # that one participant answers
    pairs: list[str]
    items: list[str]
    order: str
    only_if: dict[str, list[str]]
    balance: str


@dataclass(frozen=True)
class Design:
    """All parts, and the numbers of participants that fill them evenly."""

    study: str
    planned: int
    cycle: int
    videos: int
    minutes: int
    parts: list[PartDesign]

    def as_json(self) -> dict[str, Any]:
        """The same for programs."""
        return asdict(self)

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        each = f"each {count(self.videos, 'video')}, about {count(self.minutes, 'minute')}"
        yield f"{self.study}: {count(self.planned, 'participant')}, {each}"
        if self.cycle > 1:
            even = "even" if self.planned % self.cycle == 0 else "uneven"
            yield f"orders are even after every {self.cycle} participants, and {even} with {self.planned}"
        for part in self.parts:
            yield ""
            subjects = "between participants" if part.between else "within participants"
            yield f"{part.part} ({subjects}, {part.pages} {'page' if part.pages == 1 else 'pages'})"
            for factor, levels in part.factors.items():
                yield f"  {factor:<10} {', '.join(levels)}"
            if part.pairs:
                yield f"  {'pairs':<10} {', '.join(part.pairs)}"
            yield f"  {'items':<10} {', '.join(part.items)}"
            yield f"  {'order':<10} {part.order}"
            if part.only_if:
                conditions = (f"{item} is {' or '.join(answers)}" for item, answers in part.only_if.items())
                yield f"  {'shown if':<10} {' and '.join(conditions)}"
            yield f"  {'balance':<10} {part.balance}"


def design(protocol: Protocol) -> Design:
    """Read the design off a protocol; the balance is that of the planned participants."""
    drawn = min(protocol.participants.planned, DRAWN)
    plans = [draw_plan(protocol, slot) for slot in range(drawn)]
    among = f"of the first {drawn}, " if drawn < protocol.participants.planned else ""
    balances = {found.part: f"{among}{found}" for found in balance(protocol, plans)}
    videos, minutes = protocol.length
    return Design(
        study=protocol.study,
        planned=protocol.participants.planned,
        cycle=cycle(protocol),
        videos=videos,
        minutes=minutes,
        parts=[_part(protocol, part, balances[part.id]) for part in protocol.parts.values()],
    )


def _part(protocol: Protocol, part: Part, evenness: str) -> PartDesign:
    stimuli = [protocol.stimuli[id_] for id_ in dict.fromkeys(_seen(part))]
    named = {
        "gesture": [stimulus.gesture for stimulus in stimuli],
        "modulation": [stimulus.name for stimulus in stimuli if stimulus.name],
        "principle": [stimulus.principle for stimulus in stimuli if stimulus.principle],
        "level": [stimulus.level for stimulus in stimuli if stimulus.level],
    }
    return PartDesign(
        part=part.id,
        factors={factor: list(dict.fromkeys(levels)) for factor, levels in named.items() if levels},
        between=part.shown is not None,
        pages=len(part.stimuli) if part.shown is None else part.shown,
        pairs=[" or ".join(pair) for pair in part.pairs.values()],
        items=[item for question in part.questions for item in question.items],
        order=ordered(part.order),
        only_if={item: list(answers) for item, answers in part.only_if.items()},
        balance=evenness,
    )


def _seen(part: Part) -> Iterable[str]:
    """The ids of what is judged; of pairs, those of both."""
    return [id_ for pair in part.pairs.values() for id_ in pair] or part.stimuli
