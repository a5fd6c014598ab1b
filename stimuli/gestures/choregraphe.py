"""Choregraphe's Python exports (`.py`): lists `names`, `times` (s) and `keys` (rad), read and never executed.

    names.append("HeadYaw"); times.append([0.4, 1.2]); keys.append([0.1, [-0.2, [3, -0.1, 0], [3, 0.1, 0]]])

A key is an angle, or an angle with its left and right handle, [type, time, angle] as offsets from the key:
type 3 is Bezier, others are straight. The lists may also be written at once, `names = [...]`, in literals.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

from stimuli.errors import InputError
from stimuli.gestures.bezier import Handle, Key, sample
from stimuli.gestures.reading import known_joint, read_text, whole_body
from stimuli.robots.model import Robot
from stimuli.trajectory import Trajectory, even_times

SUFFIXES = (".py",)

_LISTS = ("names", "times", "keys")
_BEZIER = 3


def read(path: Path, robot: Robot, dt_s: float) -> Trajectory:
    """The gesture in an exported script."""
    try:
        script = ast.parse(read_text(path))
    except (SyntaxError, ValueError) as err:
        raise InputError(f"{path}: not readable as Python: {err}") from err
    lists: dict[str, list[Any]] = {name: [] for name in _LISTS}
    for statement in ast.walk(script):
        _collect(statement, lists, path)
    names, times, keys = (lists[name] for name in _LISTS)
    if not names or not len(names) == len(times) == len(keys):
        found = ", ".join(f"{len(lists[name])} {name}" for name in _LISTS)
        raise InputError(f"{path}: {found}; an export has as many names as lists of times and of keys")
    curves = {}
    for name, moments, values in zip(names, times, keys, strict=True):
        place = f"{path}: {name}"
        known_joint(str(name), robot, place)
        if (
            not isinstance(moments, list)
            or not isinstance(values, list)
            or not len(moments) == len(values) > 0
        ):
            raise InputError(f"{place}: times {moments!r} and keys {values!r} are not lists of one length")
        curves[str(name)] = [
            _key(moment, value, place) for moment, value in zip(moments, values, strict=True)
        ]
    begin = min(key.time_s for curve in curves.values() for key in curve)
    end = max(key.time_s for curve in curves.values() for key in curve)
    if end <= begin:
        raise InputError(f"{path}: all keys lie at {begin:g} s; a gesture needs some duration")
    grid = even_times(end - begin, dt_s)
    return whole_body(grid, {name: sample(curve, grid + begin) for name, curve in curves.items()}, robot)


def _collect(statement: ast.AST, lists: dict[str, list[Any]], path: Path) -> None:
    """Take in `names = [...]` and `names.append(...)`, and likewise times and keys."""
    match statement:
        case ast.Assign(targets=[ast.Name(id=name)], value=ast.List() as value) if name in lists:
            lists[name] += _literal(value, path)
        case ast.Expr(ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="append"), args=[value])):
            if name in lists:
                lists[name].append(_literal(value, path))


def _literal(value: ast.expr, path: Path) -> Any:
    try:
        return ast.literal_eval(value)
    except ValueError as err:
        raise InputError(
            f"{path}:{value.lineno}: {ast.unparse(value)} is no literal; nothing is executed"
        ) from err


def _key(moment: Any, key: Any, place: str) -> Key:
    def handle(written: Any) -> Handle | None:
        kind, time, angle = written
        return (float(time), float(angle)) if kind == _BEZIER else None

    try:
        if not isinstance(key, list):
            return Key(float(moment), float(key))
        angle, left, right = (*key, None, None)[:3]
        return Key(
            float(moment),
            float(angle),
            None if left is None else handle(left),
            None if right is None else handle(right),
        )
    except (TypeError, ValueError) as err:
        raise InputError(
            f"{place}: key {key!r} at {moment!r} is no angle, nor an angle with two handles"
        ) from err
