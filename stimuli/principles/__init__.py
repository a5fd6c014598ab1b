"""Animation principles as modulations of a movement primitive: one file each, this folder is the list.

A protocol names them by `kind`: `{time: 0.85, exa: 1.3, ant: {intensity: 0.3, window: 0.075}}`. A bare number
is the principle's intensity. What is not named is neutral, and neutral changes nothing, bit for bit.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, SerializeAsAny, ValidationError, model_serializer, model_validator

from stimuli.course import Course
from stimuli.errors import closest, nearest
from stimuli.principles.principle import Principle, Stage

__all__ = ["PRINCIPLES", "Modulation", "Principle", "Stage", "nearest_principle"]


def _kinds() -> dict[str, type[Principle]]:
    """Every principle in this folder, in the order in which they act."""
    for module in pkgutil.iter_modules(__path__):
        importlib.import_module(f"{__name__}.{module.name}")
    return {
        kind.kind: kind
        for kind in sorted(Principle.__subclasses__(), key=lambda kind: (kind.stage, kind.kind))
    }


PRINCIPLES: dict[str, type[Principle]] = _kinds()


class Modulation(BaseModel):
    """Principles together, in the order in which they act whatever the order in which they were written."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    principles: tuple[SerializeAsAny[Principle], ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _from_mapping(cls, value: Any) -> Any:
        """From `{kind: parameters}`, as in a protocol."""
        if not isinstance(value, Mapping) or set(value) == {"principles"}:
            return value
        return {"principles": in_order(_principle(kind, parameters) for kind, parameters in value.items())}

    @model_serializer
    def _to_mapping(self) -> dict[str, Any]:
        """To `{kind: parameters}`, all parameters written out."""
        return {principle.kind: principle.model_dump(mode="json") for principle in self.principles}

    def __getitem__(self, kind: str) -> Principle:
        return next(principle for principle in self.principles if principle.kind == kind)

    def with_(self, principle: Principle) -> Modulation:
        """This modulation with that principle instead of the one of its kind, or added."""
        others = (other for other in self.principles if other.kind != principle.kind)
        return Modulation(principles=in_order([*others, principle]))

    def apply(self, course: Course) -> Course:
        """The course as all principles change it."""
        for principle in self.principles:
            course = principle.apply(course)
        return course


def in_order(principles: Iterable[Principle]) -> tuple[Principle, ...]:
    """Sorted by stage, then by name: Arc before Rand, Time before Slow."""
    return tuple(sorted(principles, key=lambda principle: list(PRINCIPLES).index(principle.kind)))


def nearest_principle(name: object) -> str:
    """Say which principle was meant, if one is near by its kind or title, and otherwise list all kinds."""
    kinds = {principle.title.lower().replace(" ", "_"): kind for kind, principle in PRINCIPLES.items()}
    close = closest(name, [*PRINCIPLES, *kinds])
    return nearest(kinds.get(close or "", name), PRINCIPLES)


def _principle(kind: object, parameters: object) -> Principle:
    """One principle from its parameters; ValueError names kind, field, value and what would do."""
    if kind not in PRINCIPLES:
        raise ValueError(f"{kind!r} is not a principle; {nearest_principle(kind)}")
    made = PRINCIPLES[str(kind)]
    if not isinstance(parameters, Mapping):
        parameters = {"intensity": parameters}
    try:
        return made.model_validate(dict(parameters))
    except ValidationError as err:
        first = err.errors()[0]
        name = ".".join(str(part) for part in first["loc"])
        if first["type"] == "extra_forbidden":
            raise ValueError(f"{kind}.{name}: no such parameter; {nearest(name, made.model_fields)}") from err
        message = first["msg"].removeprefix("Value error, ")
        if not name:
            raise ValueError(message if message.startswith(f"{kind}.") else f"{kind}: {message}") from err
        if message.startswith(f"{kind}."):
            raise ValueError(message) from err
        raise ValueError(f"{kind}.{name}: {message}, not {first['input']!r}") from err
