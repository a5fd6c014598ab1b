"""Place something between pairs of opposites: Fake 1 2 3 4 5 Natural.

`set: godspeed` and the names of its parts (`godspeed animacy`, …) bring the items of Bartneck et al. (2009),
in English; the codebook names the series each belongs to, over which scores are means.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, ClassVar, Literal

import yaml
from pydantic import Field, model_validator

from study.questions.question import Question
from study.text import Ends, Text
from study.written import nearest, wrong, wrong_at

GODSPEED = "godspeed"


class Differential(Question):
    """Rows of opposites; the left one is 1."""

    kind: ClassVar[str] = "differential"
    text: Text = Text("How did the robot appear to you?")
    set: str | None = None  # a ready set of pairs
    pairs: dict[str, Ends] = Field(default_factory=dict)
    points: int = Field(5, ge=2, le=11)
    series: dict[str, str] = Field(default_factory=dict)  # item → the scale it is scored in
    item_order: Literal["fixed", "shuffled"] = "fixed"  # shuffled: once per participant, then the same

    @model_validator(mode="before")
    @classmethod
    def _from_a_set(cls, value: Any) -> Any:
        if not isinstance(value, Mapping) or not (value.get("set") or value.get("pairs")):
            raise wrong("needs pairs of opposites, or a set such as godspeed")
        if not value.get("set"):
            return value
        sets = question_sets()
        if value["set"] not in sets:
            raise wrong_at(("set",), f"is no set of questions; {nearest(value['set'], sets)}", value["set"])
        return sets[value["set"]] | dict(value)

    @property
    def items(self) -> Mapping[str, Text]:
        """The pairs, written Left – Right."""
        return {item: _joined(left, right) for item, (left, right) in self.pairs.items()}

    @property
    def scale(self) -> tuple[int, int]:
        """Lowest and highest point."""
        return 1, self.points

    @property
    def values(self) -> Mapping[str, Text]:
        """The points, "1" at the left."""
        return {str(point): Text(str(point)) for point in range(1, self.points + 1)}

    @property
    def shuffles_items(self) -> bool:
        """Whether the rows are shuffled for each participant."""
        return self.item_order == "shuffled"

    def guess(self, rng: random.Random) -> str:
        """Somewhere around the middle."""
        middle, width = (1 + self.points) / 2, (self.points - 1) / 4
        return str(min(max(round(rng.gauss(middle, width)), 1), self.points))

    def codebook(self, language: str = "en") -> list[dict[str, Any]]:
        """As for every question, and the series each item is scored in."""
        return [entry | {"series": self.series.get(entry["item"])} for entry in super().codebook(language)]

    def scores(self, answers: Mapping[str, str]) -> dict[str, float]:
        """The mean of each series over its answered items; series without an answer are left out."""
        given: dict[str, list[int]] = {}
        for item, series in self.series.items():
            if answers.get(item):
                given.setdefault(series, []).append(int(answers[item]))
        return {series: sum(points) / len(points) for series, points in given.items()}


def _joined(left: Text, right: Text) -> Text:
    languages = dict.fromkeys([*left.root, *right.root])
    return Text({language: f"{left.in_(language)} – {right.in_(language)}" for language in languages})


@cache
def question_sets() -> dict[str, dict[str, Any]]:
    """The ready sets by name: all of Godspeed, and each of its series alone."""
    file = Path(__file__).parent.parent / "defaults" / "godspeed.yaml"
    written: dict[str, dict[str, list[str]]] = yaml.safe_load(file.read_text(encoding="utf-8"))
    series = {
        name: {item.replace(" ", "_"): ends for item, ends in pairs.items()}
        for name, pairs in written.items()
    }
    sets = {
        f"{GODSPEED} {name}": {"pairs": pairs, "series": dict.fromkeys(pairs, name)}
        for name, pairs in series.items()
    }
    whole = {
        "pairs": {item: ends for pairs in series.values() for item, ends in pairs.items()},
        "series": {item: name for name, pairs in series.items() for item in pairs},
    }
    return {GODSPEED: whole, **sets}
