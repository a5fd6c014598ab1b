"""The small YAML file beside a robot's model: what it may say, and where it says it.

robot: my_robot
title: My robot
model: my_robot.urdf            # or MJCF; meshes are STL, OBJ or, in a URDF, COLLADA
search: [../descriptions]       # folders that hold the URDF's packages, if none above the model does
home: {shoulder: 0.4}           # rad or m; joints not named are at zero, or at the nearest limit
velocities: {shoulder: 2.0}     # per second, where the model has none or they should differ
hands: [wrist]
head: head
relations:                      # for Secondary Action and Follow Through; found from the tree unless given
  - {source: shoulder, target: elbow, sign: -1}
camera: {azimuth_deg: 20, elevation_deg: 6}
look: {upper_arm: "#d95f02"}    # colours of links

The model may also be `robot_descriptions/NAME` (see `stimuli.robots.descriptions`).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import yaml
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PositiveFloat,
    ValidationError,
)

from stimuli.errors import InputError, nearest
from stimuli.lines import line_of, refuse_doubles
from stimuli.robots.limits import FASTEST
from stimuli.robots.model import Relation, View

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

ROBOT_FILES = (".yaml", ".yml")  # what such a file's name ends in
Location = tuple[str | int, ...]
Place = Callable[[Location], str]  # file, line and field of an entry
Colour = Annotated[str, Field(pattern="^#[0-9a-fA-F]{6}$")]


def _fields_of(kind: type[View | Relation]) -> BeforeValidator:
    """Refuse fields that the kind does not have."""
    names = [field.name for field in dataclasses.fields(kind)]

    def refuse(value: object) -> object:
        for name in value if isinstance(value, dict) else ():
            if name not in names:
                raise ValueError(f"{name!r} is no field here; {nearest(name, names)}")
        return value

    return BeforeValidator(refuse)


def _above_the_floor(view: View) -> View:
    if not 0 <= view.elevation_deg <= 90:
        raise ValueError(f"elevation_deg is {view.elevation_deg:g}; it lies from 0, level, to 90, from above")
    return view


class RobotFile(BaseModel):
    """What the file says."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    robot: str
    title: str
    model: str
    search: tuple[Path, ...] = ()
    home: Mapping[str, float] = Field(default_factory=dict)
    velocities: Mapping[str, Annotated[PositiveFloat, Field(le=FASTEST)]] = Field(default_factory=dict)
    hands: tuple[str, ...] = ()
    head: str | None = None
    relations: tuple[Annotated[Relation, _fields_of(Relation)], ...] | None = None
    camera: Annotated[View, _fields_of(View), AfterValidator(_above_the_floor)] = View()
    look: Mapping[str, Colour] = Field(default_factory=dict)


def read_robot_file(path: Path) -> tuple[RobotFile, Place]:
    """What a file says, and where. InputError where it cannot be read or says something else."""
    try:
        text = path.read_text(encoding="utf-8")
        tree = yaml.compose(text, Loader=yaml.SafeLoader)
        refuse_doubles(tree, path)
        return RobotFile.model_validate(yaml.safe_load(text)), partial(_place, path, tree)
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError) as error:
        raise InputError(f"{path}: cannot be read as a robot file: {error}") from error
    except ValidationError as error:
        first = error.errors()[0]
        raise InputError(f"{_place(path, tree, first['loc'])}: {_wrong(first)}") from error


def check_names(facts: RobotFile, joints: Sequence[str], links: Sequence[str], place: Place) -> None:
    """InputError where the file names a joint that does not move by itself, or a link there is not."""
    named: Iterator[tuple[Location, str]]
    for what, known, named in (
        ("joint that moves by itself", joints, _joints_named(facts)),
        ("link", links, _links_named(facts)),
    ):
        for location, name in named:
            if name not in known:
                raise InputError(f"{place(location)}: {name!r} is no {what}; {nearest(name, known)}")


def _joints_named(facts: RobotFile) -> Iterator[tuple[Location, str]]:
    for entry, joints in (("home", facts.home), ("velocities", facts.velocities)):
        yield from (((entry, joint), joint) for joint in joints)
    for at, relation in enumerate(facts.relations or ()):
        yield ("relations", at, "source"), relation.source
        yield ("relations", at, "target"), relation.target


def _links_named(facts: RobotFile) -> Iterator[tuple[Location, str]]:
    yield from ((("hands", at), link) for at, link in enumerate(facts.hands))
    yield from ((("look", link), link) for link in facts.look)
    if facts.head:
        yield ("head",), facts.head


def _place(path: Path, tree: yaml.Node | None, location: Location) -> str:
    line = f"{path}:{line_of(tree, location)}"
    return f"{line}: {'.'.join(map(str, location))}" if location else line


def _wrong(error: ErrorDetails) -> str:
    """What is wrong with a field, and what would do."""
    if error["type"] == "extra_forbidden":
        return f"is no field here; {nearest(error['loc'][-1], RobotFile.model_fields)}"
    if error["type"] == "missing":
        return "is missing"
    if error["type"] == "value_error":
        return error["msg"].removeprefix("Value error, ")
    return f"{error['msg']}, not {error['input']!r}"
