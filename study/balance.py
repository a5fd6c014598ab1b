"""How evenly orders are spread: who stands where how often, and who follows whom."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import TextIO

from study.orders import Plan
from study.protocol import Part, Protocol

DRAWN = 2000  # orders at most that are drawn to see how those of the planned participants are balanced


@dataclass(frozen=True)
class Balance:
    """Counts over the plans for one part; of whole blocks where the part is ordered in blocks."""

    part: str
    things: tuple[str, ...]  # what is ordered: stimuli, or the principles, gestures or modulations of blocks
    positions: dict[str, tuple[int, ...]]  # thing → how often it stood first, second, …
    follows: dict[tuple[str, str], int]  # (a, b) → how often b came straight after a
    first: dict[str, int]  # stimulus → how often it came first within its block
    left: dict[str, int]  # stimulus of a pair → how often it stood on the left

    @property
    def position_range(self) -> tuple[int, int]:
        """Least and largest count of a thing in a position."""
        counts = [count for row in self.positions.values() for count in row]
        return min(counts), max(counts)

    def __str__(self) -> str:
        if len(next(iter(self.positions.values()))) == 1:
            return f"each seen {_range(*self.position_range)}"
        positions, follows = _range(*self.position_range), _range(*self.follows_range)
        follow = f", after each other {follows}" if any(self.follows.values()) else ""
        left = f", each side {_range(*self.left_range)}" if self.left else ""
        return f"in each position {positions}{follow}{left}"

    @property
    def left_range(self) -> tuple[int, int]:
        """Least and largest count of a stimulus of a pair on one side."""
        return min(self.left.values()), max(self.left.values())

    @property
    def follows_range(self) -> tuple[int, int]:
        """Least and largest count of one thing straight after another."""
        counts = self.follows.values() or [0]
        return min(counts), max(counts)


def balance(protocol: Protocol, plans: Sequence[Plan]) -> list[Balance]:
    """Count positions and carry-over in each part."""
    return [_balance(protocol, part, plans) for part in protocol.parts.values()]


def _balance(protocol: Protocol, part: Part, plans: Iterable[Plan]) -> Balance:
    alike = part.order.blocks[0] if part.order.blocks else None

    def thing(stimulus: str) -> str:
        return (protocol.judged[stimulus].feature(alike) if alike else stimulus) or stimulus

    things = tuple(dict.fromkeys(map(thing, part.stimuli)))
    standing: Counter[tuple[str, int]] = Counter()
    follows = Counter({(a, b): 0 for a in things for b in things if a != b})
    first: Counter[str] = Counter()
    left = Counter({f"{stimulus} in {pair}": 0 for pair, two in part.pairs.items() for stimulus in two})
    places = 0
    for plan in plans:
        trials = [trial for trial in plan.trials if trial.part == part.id and trial.stimulus in part.stimuli]
        shown = [trial.stimulus for trial in trials]
        blocks = [list(block) for _, block in groupby(shown, key=thing)]
        sequence = [thing(block[0]) for block in blocks]
        places = max(places, len(sequence))
        standing.update((name, place) for place, name in enumerate(sequence))
        follows.update(pairwise(sequence))
        first.update(block[0] for block in blocks if len(block) > 1)
        left.update(f"{trial.pair[0]} in {trial.stimulus}" for trial in trials if trial.pair)
    return Balance(
        part=part.id,
        things=things,
        positions={name: tuple(standing[name, place] for place in range(places)) for name in things},
        follows=dict(follows),
        first=dict(first),
        left=dict(left),
    )


def write_orders(protocol: Protocol, plans: Iterable[Plan], table: TextIO) -> None:
    """Write every trial of every plan, one row each, as a table for a spreadsheet; plan by plan."""
    rows = csv.writer(table)
    rows.writerow(["slot", "part", "trial", "stimulus", "reference", "left", "items", "options"])
    for plan in plans:
        for trial in plan.trials:
            asked = [*trial.asked(protocol.parts[trial.part])]
            items = " | ".join(" ".join(items) for _, items, _ in asked)
            options = " | ".join(" ".join(options) for _, _, options in asked)
            clips = (trial.stimulus, trial.reference or "", trial.pair[0] if trial.pair else "")
            rows.writerow([plan.slot, trial.part, trial.number, *clips, items, options])


def balance_table(parts: Sequence[Balance]) -> str:
    """The counts as a table to read."""
    lines = []
    for part in parts:
        width = max(map(len, part.things))
        carried = any(part.follows.values())
        after_each = " | and straight after each other" if carried else ""
        lines.append(f"{part.part}: how often in each position{after_each}")
        for name, row in part.positions.items():
            after = _columns(part.follows.get((other, name), "–") for other in part.things)
            lines.append(f"  {name:<{width}}{_columns(row)}" + (f" |{after}" if carried else ""))
    return "\n".join(lines)


def _columns(counts: Iterable[object]) -> str:
    return "".join(f"{count:>4}" for count in counts)


def _range(low: int, high: int) -> str:
    return f"{low} times" if low == high else f"{low} to {high} times"
