"""Choregraphe's Python exports (`.py`): lists `names`, `times` (s) and `keys` (rad), read and never executed.

    names.append("HeadYaw"); times.append([0.4, 1.2]); keys.append([0.1, [-0.2, [3, -0.1, 0], [3, 0.1, 0]]])

A key is an angle, or an angle with its left and right handle, [type, time, angle] as offsets from the key:
type 3 is Bezier, others are straight. The lists may also be written at once, `names = [...]`, in literals.
What exports end in, `try: … except BaseException, err: print err`, is Python 2 and not looked at. Time begins
at 0; a joint whose first key comes later sets out from home, at rest.
"""

from __future__ import annotations

import ast
import math
import re
from pathlib import Path
from typing import Any

from stimuli.errors import InputError
from stimuli.gestures.bezier import Handle, Key, from_home, sample
from stimuli.gestures.reading import each_once, known_joint, read_text, sampled_times, whole_body
from stimuli.robots.model import Robot
from stimuli.trajectory import Trajectory

SUFFIXES = (".py",)

_LISTS = ("names", "times", "keys")
_BEZIER = 3
_SENDING = re.compile(r"^try\s*:", re.MULTILINE)  # where lists end and the robot is spoken to
_TOO_DEEP = (RecursionError, MemoryError)


def read(path: Path, robot: Robot, dt_s: float) -> Trajectory:
    """The gesture in an exported script."""
    try:
        script = ast.parse(_SENDING.split(read_text(path), maxsplit=1)[0])
    except (SyntaxError, ValueError, *_TOO_DEEP) as err:
        raise InputError(f"{path}: not readable as Python: {err}") from err
    lists: dict[str, list[Any]] = {name: [] for name in _LISTS}
    for statement in ast.walk(script):
        _collect(statement, lists, path)
    names, times, keys = (lists[name] for name in _LISTS)
    if not names or not len(names) == len(times) == len(keys):
        found = ", ".join(f"{len(lists[name])} {name}" for name in _LISTS)
        raise InputError(f"{path}: {found}; an export has as many names as lists of times and of keys")
    each_once(map(str, names), str(path))
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
        keyed = [_key(moment, value, place) for moment, value in zip(moments, values, strict=True)]
        curves[str(name)] = from_home(keyed, robot.home[str(name)])
    end = max(key.time_s for curve in curves.values() for key in curve)
    grid = sampled_times(end, dt_s, str(path))
    return whole_body(grid, {name: sample(curve, grid) for name, curve in curves.items()}, robot)


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
        try:
            return ast.literal_eval(value)
        except (ValueError, TypeError) as err:
            raise InputError(
                f"{path}:{value.lineno}: {ast.unparse(value)} is no literal; nothing is executed"
            ) from err
    except _TOO_DEEP as err:
        raise InputError(f"{path}:{value.lineno}: too deeply nested to be a list of keys") from err


def _key(moment: Any, key: Any, place: str) -> Key:
    def handle(written: Any) -> Handle | None:
        kind, time, angle = written
        return (_finite(time), _finite(angle)) if kind == _BEZIER else None

    try:
        if not isinstance(key, list):
            return Key(_finite(moment), _finite(key))
        angle, left, right = (*key, None, None)[:3]
        return Key(
            _finite(moment),
            _finite(angle),
            None if left is None else handle(left),
            None if right is None else handle(right),
        )
    except (TypeError, ValueError, OverflowError) as err:
        raise InputError(
            f"{place}: key {key!r} at {moment!r} is no angle, nor an angle with two handles"
        ) from err


def _finite(number: Any) -> float:
    value = float(number)
    if not math.isfinite(value):
        raise ValueError(f"{value} is not finite")
    return value
