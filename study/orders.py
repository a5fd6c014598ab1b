"""Orders: who sees what when, as pure functions of (design, seed, slot).

A slot is a place in the design: 0, 1, 2, … Each balanced choice (a row of a square, the side of a button)
goes through its rows over successive slots, in blocks that are each shuffled anew: whole blocks are balanced
exactly, and any run of slots nearly. `ALGORITHM` names this drawing; whoever changes one changes the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from math import lcm
from typing import TypeVar

from stimuli.errors import InputError
from study.chance import Stream
from study.designs import latin_square, williams
from study.protocol import BESIDE, PRACTICE, Pair, Part, Protocol, Stimulus
from study.protocol.parts import BETWEEN, Method
from study.protocol.stimulus import Alike
from study.questions import Question

ALGORITHM = "orders/1"
MAX_TRIES = 20_000  # shuffles until one keeps to `max_run`
T = TypeVar("T")
Judged = Stimulus | Pair
Shown = tuple[Question, tuple[str, ...], tuple[str, ...]]
"""A question with its items and its options in the order shown; () as written."""


@dataclass(frozen=True)
class Trial:
    """One page of one participant: a clip (after its reference), or a pair, and the questions on it."""

    part: str
    number: int  # 1, 2, … within the part; 0 for practice
    stimulus: str  # or the id of a pair
    reference: str | None  # clip shown before it
    items: tuple[tuple[str, ...], ...]  # per question: item ids in the order shown
    options: tuple[tuple[str, ...], ...]  # per question: option ids in the order shown (sides balanced)
    practice: bool = False
    pair: tuple[str, str] | None = None  # the clips side by side, left and right

    def asked(self, part: Part) -> Iterator[Shown]:
        """The questions on this page."""
        for question, items, options in zip(part.questions, self.items, self.options, strict=True):
            if question.asked_at(self.number):
                yield question.among(self.pair) if self.pair else question, items, options


@dataclass(frozen=True)
class Plan:
    """Everything a participant will see, drawn once and stored as it is."""

    slot: int  # 0, 1, …: the place in the design this participant fills
    seed: str  # hex; derived from the study's seed and the slot
    algorithm: str  # name and version of the drawing; golden tests hold it still
    trials: tuple[Trial, ...]

    def __hash__(self) -> int:
        """By what the trials were drawn from: quicker than by all of them."""
        return hash((self.slot, self.seed, self.algorithm))


def draw_plan(protocol: Protocol, slot: int) -> Plan:
    """Draw what the participant in this slot sees."""
    trials: list[Trial] = []
    for part in protocol.parts.values():
        draw = _Draw(protocol.seed, slot, part.id)
        shown = [draw.shown(question, at) for at, question in enumerate(part.questions)]
        items = tuple(items for items, _ in shown)
        options = tuple(options for _, options in shown)
        if protocol.practice and protocol.practice.ask == part.id:
            pair = (PRACTICE, BESIDE) if part.pairs else None
            trials.append(Trial(part.id, 0, PRACTICE, None, items, options, practice=True, pair=pair))
        ordered = draw.ordered(part, [protocol.judged[id_] for id_ in part.stimuli])
        sides = draw.sides(part)
        trials += [
            Trial(part.id, number, id_, part.reference_of(id_), items, options, pair=sides.get(id_))
            for number, id_ in enumerate((judged.id for judged in ordered), start=1)
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


def cycle(protocol: Protocol) -> int:
    """The number of participants after which everything balanced is balanced exactly, as is each multiple."""
    lengths = [1]
    for part in protocol.parts.values():
        lengths += [len(question.option_orders) for question in part.questions]
        groups = _groups(part, [protocol.judged[id_] for id_ in part.stimuli])
        method = "williams" if part.order.levels else part.order.stimuli
        within = lcm(*(_rows(method, len(group)) for group in groups))
        outer = part.order.blocks[1] if part.order.blocks else "fixed"
        blocks = _rows(outer, len(groups))
        lengths.append(blocks * within if outer == BETWEEN else lcm(blocks, within))
        if part.pairs:
            lengths.append(2 * part.groups)
    return lcm(*lengths)


@dataclass(frozen=True)
class _Draw:
    """The draws of one part for one slot."""

    seed: int
    slot: int
    part: str

    def stream(self, purpose: str) -> Stream:
        """Chance for one purpose, this participant's own."""
        return Stream(self.seed, self.slot, self.part, purpose)

    def balanced(self, rows: Sequence[T], purpose: str) -> T:
        """This slot's row: each block of slots holds every row once, in an order of its own."""
        block, place = divmod(self.slot, len(rows))
        return Stream(self.seed, self.part, purpose, "block", block).shuffled(rows)[place]

    def shown(self, question: Question, at: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """The order of a question's items and of its options, the same on all pages of a participant."""
        items = tuple(question.items)
        if question.shuffles_items:
            items = self.stream(f"items {at}").shuffled(items)
        return items, self.balanced(question.option_orders, f"options {at}")

    def sides(self, part: Part) -> dict[str, tuple[str, str]]:
        """Each pair with its left clip first: half of the pairs turned round, each by every other slot."""
        own = replace(self, slot=self.slot // part.groups)
        turned = own.balanced_within(list(part.pairs.values()), "sides")
        return {pair: (left, right) for pair, (left, right) in zip(part.pairs, turned, strict=True)}

    def ordered(self, part: Part, stimuli: Sequence[Judged]) -> tuple[Judged, ...]:
        """The stimuli in the order of this slot."""
        order = part.order
        if order.max_run:
            return self.without_runs(stimuli, order.max_run)
        groups = _groups(part, stimuli)
        among = len(groups) if order.blocks and order.blocks[1] == BETWEEN else 1
        own = replace(self, slot=self.slot // among)  # those who see the same group share its rows out
        if order.levels:
            groups = own.balanced_within(groups, "levels")
        elif order.stimuli:
            groups = [own.arranged(order.stimuli, group, f"group {at}") for at, group in enumerate(groups)]
        if order.blocks:
            groups = list(self.arranged(order.blocks[1], groups, "blocks"))
        return tuple(stimulus for group in groups for stimulus in group)

    def arranged(self, method: Method, things: Sequence[T], purpose: str) -> tuple[T, ...]:
        """The things by that method."""
        if method == "williams":
            return tuple(things[at] for at in self.balanced(williams(len(things)), purpose))
        if method == "latin square":
            return tuple(things[at] for at in self.balanced(latin_square(len(things)), purpose))
        if method == BETWEEN:
            return (self.balanced(things, purpose),)
        return self.stream(purpose).shuffled(things) if method == "shuffled" else tuple(things)

    def balanced_within(self, groups: Sequence[tuple[T, ...]], purpose: str) -> list[tuple[T, ...]]:
        """Each group in an order of its own, the orders spread evenly over the groups.

        The orders are the rows of a Williams square. With two levels and six principles, three begin
        with the high level, and over successive slots each principle goes through all rows.
        """
        ordered = []
        for at, group in enumerate(groups):
            rows = williams(len(group))
            block, shift = divmod(self.slot, len(rows))
            stream = Stream(self.seed, self.part, purpose, len(rows), block)
            places = stream.shuffled(range(len(groups)))
            ordered.append(tuple(group[level] for level in rows[(places[at] + shift) % len(rows)]))
        return ordered

    def without_runs(self, stimuli: Sequence[Judged], max_run: Mapping[Alike, int]) -> tuple[Judged, ...]:
        """A shuffle in which no more than so many in a row are alike; all such orders are equally likely."""
        stream = self.stream("without runs")
        for _ in range(MAX_TRIES):
            order = stream.shuffled(stimuli)
            if all(_longest_run(order, alike) <= most for alike, most in max_run.items()):
                return order
        limits = ", ".join(f"{alike}: {most}" for alike, most in max_run.items())
        raise InputError(
            f"parts.{self.part}.order.max_run: none of {MAX_TRIES} shuffles keeps to {{{limits}}}; allow more"
        )


def _longest_run(stimuli: Sequence[Judged], alike: Alike) -> int:
    return max(len(list(run)) for _, run in groupby(stimuli, key=lambda stimulus: stimulus.feature(alike)))


def _groups(part: Part, stimuli: Sequence[Judged]) -> list[tuple[Judged, ...]]:
    """The blocks of a part, or all stimuli as one."""
    if not part.order.blocks:
        return [tuple(stimuli)]
    alike, _ = part.order.blocks
    groups: dict[str | None, list[Judged]] = {}
    for stimulus in stimuli:
        groups.setdefault(stimulus.feature(alike), []).append(stimulus)
    return [tuple(group) for group in groups.values()]


def _rows(method: Method | None, n: int) -> int:
    """After how many participants a method has balanced n things."""
    if method == "williams":
        return len(williams(n))
    return n if method in {"latin square", BETWEEN} else 1
