"""Pairs: two stimuli of one gesture shown side by side, of which one is preferred."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Any

from pydantic import BeforeValidator

from study.protocol.stimulus import Alike, Stimulus
from study.written import wrong

ALL = "all"


@dataclass(frozen=True)
class Pair:
    """Two stimuli that are compared, in the order written; which stands left is drawn per participant."""

    first: Stimulus
    second: Stimulus
    name: None = None  # it is of two modulations, and
    level: None = None  # of two levels

    @property
    def id(self) -> str:
        """Both ids, such as `calm_or_lively`."""
        return f"{self.first.id}_or_{self.second.id}"

    @property
    def ids(self) -> tuple[str, str]:
        """The ids of the two."""
        return self.first.id, self.second.id

    @property
    def gesture(self) -> str:
        """The gesture of both."""
        return self.first.gesture

    @property
    def principle(self) -> str | None:
        """The principle whose levels the two are."""
        return self.first.principle

    @property
    def part(self) -> str:
        """The part they are compared in."""
        return self.first.part

    def feature(self, alike: Alike) -> str | None:
        """What this pair has in common with others."""
        return {"gesture": self.gesture, "principle": self.principle}.get(alike)

    def of(self, conditions: tuple[str, str]) -> tuple[Stimulus, Stimulus] | None:
        """The stimuli of these two levels or modulations, in that order; None for a pair of others."""
        named = {stimulus.condition: stimulus for stimulus in (self.first, self.second)}
        first, second = map(named.get, conditions)
        return (first, second) if first and second and first is not second else None


def _pairs(value: Any) -> Any:
    """Read `all` as the empty list, which stands for every pair there is."""
    if value == ALL:
        return []
    if (
        not isinstance(value, list)
        or not value
        or not all(isinstance(v, list) and len(v) == 2 for v in value)
    ):
        raise wrong("must be all, or a list of pairs such as [[calm, lively], [calm, neutral]]")
    return value


Pairs = Annotated[
    tuple[tuple[str, str], ...], BeforeValidator(_pairs, json_schema_input_type=str | list[list[str]])
]
"""Levels or modulations that are compared; empty for each with each."""


def paired(stimuli: Iterable[Stimulus], wanted: Pairs) -> list[Pair]:
    """The pairs among these stimuli: of the same gesture and, where levels are compared, principle."""
    groups: dict[tuple[str, str | None], dict[str, Stimulus]] = {}
    for stimulus in stimuli:
        groups.setdefault((stimulus.gesture, stimulus.principle), {})[stimulus.condition or ""] = stimulus
    return [pair for group in groups.values() for pair in _within(group, wanted)]


def _within(group: Mapping[str, Stimulus], wanted: Pairs) -> list[Pair]:
    conditions = wanted or [*combinations(group, 2)]
    return [Pair(group[a], group[b]) for a, b in conditions if a in group and b in group]
