"""Orders: who sees what when, as pure functions of (design, seed, slot).

A slot is a place in the design: 0, 1, 2, … Each balanced choice (a row of a square, the side of a button) cycles
through its rows over successive slots, in blocks that are each shuffled anew, so that any run of slots is close
to balanced and whole blocks are balanced exactly. `algorithm` names this drawing; change it, and the name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TypeVar

from study.chance import Stream
from study.designs import latin_square, williams
from study.protocol import Order, Part, Protocol, Stimulus
from study.questions import Question

ALGORITHM = "orders/1"
T = TypeVar("T")


@dataclass(frozen=True)
class Trial:
    """One page of one participant: a clip (after its reference, where there is one) and the questions on it."""

    part: str
    number: int  # 1, 2, … within the part; 0 for practice
    stimulus: str
    reference: str | None  # clip shown before it
    items: tuple[tuple[str, ...], ...]  # per question: item ids in the order shown
    options: tuple[tuple[str, ...], ...]  # per question: option ids in the order shown (sides balanced)
    practice: bool = False


@dataclass(frozen=True)
class Plan:
    """Everything a participant will see, drawn once and stored as it is."""

    slot: int  # 0, 1, …: the place in the design this participant fills
    seed: str  # hex; derived from the study's seed and the slot
    algorithm: str  # name and version of the drawing; golden tests hold it still
    trials: tuple[Trial, ...]


def draw_plan(protocol: Protocol, slot: int) -> Plan:
    """Draw what the participant in this slot sees."""
    trials: list[Trial] = []
    for part in protocol.parts.values():
        shown = [
            _shown(protocol.seed, slot, part, question, at) for at, question in enumerate(part.questions)
        ]
        items = tuple(items for items, _ in shown)
        options = tuple(options for _, options in shown)
        if protocol.practice and protocol.practice.ask == part.id:
            trials.append(Trial(part.id, 0, "practice", None, items, options, practice=True))
        stimuli = [protocol.stimuli[stimulus] for stimulus in part.stimuli]
        order = _order(part.order, stimuli, seed=protocol.seed, slot=slot, part=part.id)
        trials += [
            Trial(part.id, number, stimulus.id, part.reference_of(stimulus.id), items, options)
            for number, stimulus in enumerate(order, start=1)
        ]
    return Plan(slot, Stream(protocol.seed, slot).key, ALGORITHM, tuple(trials))


def assign_slot(counts: Mapping[int, int]) -> int:
    """The slot for the next participant: the lowest that nobody has completed or is in.

    `counts` holds per slot how many sessions completed it or are active in it; leave out abandoned and test
    sessions. As rows of the design cycle over slots, this fills the least-filled row.
    """
    slot = 0
    while counts.get(slot, 0) > 0:
        slot += 1
    return slot


def _shown(
    seed: int, slot: int, part: Part, question: Question, at: int
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The order of a question's items and of its options, the same on all pages of a participant."""
    items = question.shown_items(Stream(seed, slot, part.id, "items", at))
    options = _balanced(question.option_orders, seed, slot, f"{part.id}/options/{at}")
    return items, options


def _balanced(rows: Sequence[T], seed: int, slot: int, purpose: str) -> T:
    """This slot's row: every block of as many slots as rows holds each row once, in an order of its own."""
    block, place = divmod(slot, len(rows))
    return Stream(seed, purpose, "block", block).shuffled(rows)[place]


def _order(
    order: Order, stimuli: Sequence[Stimulus], *, seed: int, slot: int, part: str
) -> tuple[Stimulus, ...]:
    if order.principles is None:
        return _arranged(str(order.stimuli), stimuli, order.max_run, seed=seed, slot=slot, part=part)
    groups = {
        principle: tuple(group)
        for principle, group in groupby(stimuli, key=lambda s: (s.gesture, s.principle))
    }
    arranged = _arranged(order.principles, tuple(groups), {}, seed=seed, slot=slot, part=part)
    within = _level_orders(order.levels, list(groups.values()), seed=seed, slot=slot, part=part)
    by_group = dict(zip(groups, within, strict=True))
    return tuple(stimulus for group in arranged for stimulus in by_group[group])


def _level_orders(
    method: str, groups: Sequence[Sequence[Stimulus]], *, seed: int, slot: int, part: str
) -> list[tuple[Stimulus, ...]]:
    """Per principle, the order of its levels.

    Balanced: within a participant the rows of a Williams square are spread evenly over the principles (with two
    levels and six principles, three begin with the high one), and over successive slots each principle goes
    through all rows.
    """
    if method == "fixed":
        return [tuple(group) for group in groups]
    if method == "shuffled":
        return [Stream(seed, slot, part, "levels", at).shuffled(group) for at, group in enumerate(groups)]
    rows = williams(len(groups[0]))
    block, shift = divmod(slot, len(rows))
    places = Stream(seed, part, "levels", block).shuffled(range(len(groups)))
    return [
        tuple(group[level] for level in rows[(place + shift) % len(rows)])
        for group, place in zip(groups, places, strict=True)
    ]


def _arranged(
    method: str, things: Sequence[T], max_run: Mapping[str, int], *, seed: int, slot: int, part: str
) -> tuple[T, ...]:
    """The things in the order of this slot."""
    n = len(things)
    stream = Stream(seed, slot, part)
    if method == "fixed":
        return tuple(things)
    if method == "between participants":
        return (_balanced(things, seed, slot, f"{part}/between"),)
    if method == "williams":
        return tuple(things[at] for at in _balanced(williams(n), seed, slot, f"{part}/rows"))
    if method == "latin square":
        return tuple(things[at] for at in _balanced(latin_square(n), seed, slot, f"{part}/rows"))
    return stream.shuffled(things)
