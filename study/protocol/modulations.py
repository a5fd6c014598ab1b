"""Named modulations and levels: read from what is written to what the robot does.

A modulation names principles and their intensities, `{time: 0.85, exa: 1.3}`; what is not named is neutral.
It may start from another (`extends: joy`), move some of its intensities (`plus: {exa: 0.2}`,
`times: {arc: 1.5}`) and be a grid over several values (`grid: {time: [0.8, 1.2], exa: [1, 1.5]}`): then it
stands for its members `name_1`, `name_2`, …, the last value changing fastest.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError
from pydantic_core import InitErrorDetails

from stimuli.errors import nearest
from stimuli.principles import PRINCIPLES, Modulation, nearest_principle
from study.written import NAME, refusal, relocated, reworded, wrong_at

LEVELS = ("low", "medium", "high")  # names of a list of three
_OWN = ("extends", "plus", "times", "grid")


def _modulation(principles: Mapping[str, Any]) -> Modulation:
    """Read the principles one by one, so that everything wrong with any of them is said."""
    errors: list[InitErrorDetails] = []
    for kind, value in principles.items():
        if kind not in PRINCIPLES:
            meant = "write decimals with a point, as in 1.4" if kind.isdigit() else nearest_principle(kind)
            error = wrong_at((kind,), f"is no principle; {meant}", value, NAME)
            errors += relocated(error, ())
            continue
        if isinstance(value, bool) or value == {}:
            error = wrong_at((kind,), f"needs an intensity, such as {kind}: 1.2", value)
            errors += relocated(error, ())
            continue
        try:
            PRINCIPLES[kind].model_validate(value if isinstance(value, Mapping) else {"intensity": value})
        except ValidationError as refused:
            errors += relocated(refusal(reworded(refused, PRINCIPLES[kind].model_fields)), (kind,))
    if errors:
        raise refusal(errors)
    return Modulation.model_validate(dict(principles))


def read_modulations(value: Any) -> Any:
    """Read all named modulations, grids taken apart into their members."""
    if not isinstance(value, Mapping):
        return value
    read: dict[str, Modulation] = {}
    errors: list[InitErrorDetails] = []
    for name in value:
        try:
            for member, principles in _members(name, value):
                read[member] = _modulation(principles)
        except ValidationError as error:
            errors += relocated(error, (name,))
    if errors:
        raise refusal(errors)
    return read


def _members(name: str, written: Mapping[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    """The modulations one entry stands for: itself, or one for each cell of its grid."""
    principles = _principles(name, written, ())
    grid = written[name].get("grid")
    if grid is None:
        return [(name, principles)]
    if not isinstance(grid, Mapping) or not grid or not all(isinstance(v, list) and v for v in grid.values()):
        raise wrong_at(("grid",), "must hold lists of values, such as {time: [0.8, 1.2]}", grid)
    cells = itertools.product(*grid.values())
    return [
        (f"{name}_{number}", principles | dict(zip(grid, cell, strict=True)))
        for number, cell in enumerate(cells, start=1)
    ]


def _principles(name: str, written: Mapping[str, Any], through: tuple[str, ...]) -> dict[str, Any]:
    """The principles of an entry, with those of what it extends."""
    entry = written[name]
    if not isinstance(entry, Mapping):
        raise wrong_at((), "must be principles and their values, such as {time: 0.85, exa: 1.3}", entry)
    principles: dict[str, Any] = {}
    if (base := entry.get("extends")) is not None:
        if not isinstance(base, str):
            raise wrong_at(("extends",), "must be the name of a modulation", base)
        if base in (*through, name):
            circle = " → ".join((*through, name, base))
            raise wrong_at(("extends",), f"goes in a circle: {circle}", base)
        if base not in written:
            raise wrong_at(("extends",), f"is no modulation; {nearest(base, written)}", base)
        principles |= _principles(base, written, (*through, name))
    for word, change in (("plus", float.__add__), ("times", float.__mul__)):
        changes = entry.get(word, {})
        if not isinstance(changes, Mapping):
            raise wrong_at((word,), "must be principles and numbers, such as {exa: 0.1}", changes)
        for kind, amount in changes.items():
            if not isinstance(principles.get(kind), (int, float)) or not isinstance(amount, (int, float)):
                raise wrong_at((word, kind), "needs a number that `extends` brings; there is none", amount)
            principles[kind] = round(change(float(principles[kind]), float(amount)), 12)
    return principles | {kind: value for kind, value in entry.items() if kind not in _OWN}


def read_levels(value: Any) -> Any:
    """Read the levels of principles: `arc: [1, 3, 8]` (low, medium, high) or `arc: {weak: 1, strong: 8}`."""
    if not isinstance(value, Mapping):
        return value
    read: dict[str, dict[str, Modulation]] = {}
    errors: list[InitErrorDetails] = []
    for kind, levels in value.items():
        try:
            read[kind] = _read_levels_of(kind, levels)
        except ValidationError as error:
            errors += relocated(error, (kind,))
    if errors:
        raise refusal(errors)
    return read


def _read_levels_of(kind: str, written: Any) -> dict[str, Modulation]:
    if isinstance(written, list) and len(written) == len(LEVELS):
        places: list[tuple[str, str | int, Any]] = list(zip(LEVELS, range(len(LEVELS)), written, strict=True))
    elif isinstance(written, Mapping) and len(written) > 1:
        places = [(level, level, value) for level, value in written.items()]
    else:
        raise wrong_at(
            (), "must be three values, low to high, or values by name: {weak: 1, strong: 8}", written
        )
    levels: dict[str, Modulation] = {}
    errors: list[InitErrorDetails] = []
    for level, place, value in places:
        try:
            levels[level] = _modulation({kind: value})
        except ValidationError as error:
            errors += relocated(error, (place,), drop=1)
    if errors:
        raise refusal(errors)
    return levels
