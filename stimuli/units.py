"""Quantities as people write them: a number with its unit, such as `22 deg`, `0.35 rad`, `4.0 s`."""

from __future__ import annotations

import math
import re

ANGLE = {"rad": 1.0, "deg": math.pi / 180.0}
LENGTH = {"m": 1.0, "cm": 0.01, "mm": 0.001}
TIME = {"s": 1.0, "ms": 0.001}
POSITION = ANGLE | LENGTH

_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([A-Za-z]*)\s*")


def in_base_unit(value: object, units: dict[str, float]) -> float:
    """Value in the base unit: a bare number is in it already, a text names one of `units`.

    Raises ValueError, saying what would do.
    """
    match = _QUANTITY.fullmatch(str(value)) if isinstance(value, str) else None
    if match and (not match[2] or match[2] in units):
        number = float(match[1]) * units.get(match[2], 1.0)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        number = float(value)
    else:
        raise ValueError(f"{value!r} is not a number with one of the units {', '.join(units)}")
    if not math.isfinite(number):
        raise ValueError(f"{value!r} is not finite")
    return number
