"""Published questionnaires as ready sets of questions, from `study/defaults/sets`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

_FOLDER = Path(__file__).parent.parent / "defaults" / "sets"


@dataclass(frozen=True)
class QuestionSet:
    """A questionnaire, or one of its series."""

    kind: str  # of question
    items: Mapping[str, Any]
    series: Mapping[str, str]  # item → series
    fields: Mapping[str, Any]  # what else the question has
    unpublished: tuple[str, ...]  # languages in which it is our own translation


@cache
def question_sets() -> Mapping[str, QuestionSet]:
    """The sets by name: `godspeed` is the whole of it, `godspeed animacy` one series alone."""
    return {name: one for file in sorted(_FOLDER.glob("*.yaml")) for name, one in _sets_in(file)}


def _sets_in(file: Path) -> Iterator[tuple[str, QuestionSet]]:
    written: dict[str, Any] = yaml.safe_load(file.read_text(encoding="utf-8"))
    kind, unpublished = written.pop("kind"), tuple(written.pop("unpublished", ()))
    series, texts = written.pop("series"), written.pop("texts", {})
    chosen: dict[str, Mapping[str, Any]] = {"": series, **{name: {name: series[name]} for name in series}}
    for name, parts in chosen.items():
        yield (
            f"{file.stem} {name}".strip(),
            QuestionSet(
                kind=kind,
                items={item: text for items in parts.values() for item, text in items.items()},
                series={item: of for of, items in parts.items() for item in items},
                fields=written | ({"text": texts[name]} if name in texts else {}),
                unpublished=unpublished,
            ),
        )
