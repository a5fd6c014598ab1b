"""Demonstrations from files: one reader per format, this folder is the list.

A reader is a module with `SUFFIXES` and `read(path, robot, dt_s) -> Trajectory`. Every reader returns all
joints of the robot, those the file does not name at home.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from pathlib import Path

from stimuli.errors import InputError
from stimuli.robots.model import Robot
from stimuli.trajectory import Trajectory

Reader = Callable[[Path, Robot, float], Trajectory]


def _readers() -> dict[str, Reader]:
    modules = [
        importlib.import_module(f"{__name__}.{module.name}") for module in pkgutil.iter_modules(__path__)
    ]
    return {suffix: module.read for module in modules for suffix in getattr(module, "SUFFIXES", ())}


READERS: dict[str, Reader] = _readers()


def read_gesture(path: Path, robot: Robot, dt_s: float = 0.01) -> Trajectory:
    """The demonstration in a file, for all joints of the robot, sampled every dt_s."""
    if path.suffix.lower() not in READERS:
        known = ", ".join(sorted(READERS))
        raise InputError(f"{path}: {path.suffix or 'no suffix'!r} is no gesture format. Known: {known}")
    if not path.is_file():
        raise InputError(f"{path}: no such file")
    return READERS[path.suffix.lower()](path, robot, dt_s)
