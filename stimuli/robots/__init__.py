"""Robots, one file of code and one of facts each: this folder is the list.

A packaged robot `name` is `name.yaml` (its facts) beside `name.py` with `load() -> Robot`; what that is split
over is `name_….py`.
"""

from __future__ import annotations

import os
from importlib import import_module
from importlib.resources import files
from pathlib import Path

from stimuli.backends import backends
from stimuli.errors import InputError, nearest
from stimuli.robots.facts import read_facts
from stimuli.robots.model import Robot
from stimuli.robots.robot_file import ROBOT_FILES, read_robot_file

ROBOTS: tuple[str, ...] = tuple(
    sorted(
        entry.name.removesuffix(".yaml")
        for entry in files(__name__).iterdir()
        if entry.name.endswith(".yaml")
    )
)


def load_robot(name_or_path: str, base: Path) -> Robot:
    """The packaged robot of that name, or the one a YAML file describes, its path relative to `base`."""
    if name_or_path in ROBOTS:
        robot: Robot = import_module(f"{__name__}.{name_or_path}").load()
        return robot
    backends(os.environ)  # a wrong one is said before MuJoCo is imported, which would fail
    if name_or_path.endswith(ROBOT_FILES):
        from stimuli.robots.files import read_robot

        return read_robot(base / name_or_path)
    if name_or_path.startswith("robot_descriptions/"):
        from stimuli.robots.files import described_robot

        return described_robot(name_or_path)
    raise InputError(
        f"robot: {name_or_path!r} is not a robot; {nearest(name_or_path, ROBOTS)}\n"
        "One of your own is the path of its YAML file, or robot_descriptions/NAME."
    )


def title_of(name_or_path: str, base: Path) -> str:
    """What a robot is called, for people to read; found without its model."""
    if name_or_path in ROBOTS:
        return read_facts(name_or_path).title
    if name_or_path.endswith(ROBOT_FILES):
        return read_robot_file(base / name_or_path)[0].title
    return name_or_path
