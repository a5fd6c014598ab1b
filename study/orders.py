"""Orders: who sees what when, as pure functions of (design, seed, slot)."""

from __future__ import annotations

from dataclasses import dataclass


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
