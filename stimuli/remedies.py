"""What would make a motion fit that a robot cannot do."""

from __future__ import annotations

import math
from collections.abc import Callable

from stimuli.attractor import ROUNDING
from stimuli.course import Course
from stimuli.dmp import Primitive
from stimuli.errors import InputError
from stimuli.feasibility import share_that_fits, violations
from stimuli.principles import Modulation, Principle
from stimuli.principles.time import Time
from stimuli.robots.model import Robot
from stimuli.rollout import integrate, sampled
from stimuli.trajectory import Trajectory

_BISECTIONS = 12
_TAIL = 1.5  # durations looked at where motions are compared sample by sample
_LONGEST = 16.0  # times as long is the longest that `fit: scale` tries


def advice(primitive: Primitive, modulation: Modulation, robot: Robot) -> str:
    """One sentence: which intensity would do, or which ones together."""
    alone = [
        f"{principle.kind}.{principle.dial} {largest:.3g}"
        for principle in modulation.principles
        if (largest := _largest(primitive, modulation, principle, robot)) is not None
    ]
    if alone:
        return f"It would fit with {' or '.join(alone)}."

    def at(share: float) -> Modulation:
        weaker = (_turned(principle, share) for principle in modulation.principles)
        return Modulation(principles=tuple(weaker))

    share = _last_good(lambda tried: _fits(primitive, at(tried), robot), 0.0, 1.0)
    together = ", ".join(
        f"{one.kind}.{one.dial} {getattr(one, one.dial):.3g}" for one in at(share).principles
    )
    return (
        f"No single intensity makes it fit; all of them would, {share:.0%} as far from neutral: {together}."
    )


def retimed(primitive: Primitive, modulation: Modulation, robot: Robot) -> Modulation | None:
    """The modulation with the shortest duration that fits, where it asks for `fit: scale` and one does."""
    asked = next((one for one in modulation.principles if isinstance(one, Time)), None)
    if asked is None or asked.fit != "scale":
        return None

    def at(factor: float) -> Modulation:
        return modulation.with_(asked.model_copy(update={"intensity": asked.intensity * factor}))

    if not _fits(primitive, at(_LONGEST), robot):
        return None
    return at(_last_good(lambda tried: _fits(primitive, at(tried), robot), _LONGEST, 1.0, 2 * _BISECTIONS))


def _largest(
    primitive: Primitive, modulation: Modulation, principle: Principle, robot: Robot
) -> float | None:
    """The strength nearest to the wanted one that fits, all else being equal; None where none does.

    In closed form where motions are affine in it, else by bisection.
    """

    def at(share: float) -> Modulation:
        return modulation.with_(_turned(principle, share))

    def fits(share: float) -> bool:
        return _fits(primitive, at(share), robot)

    if principle.is_neutral or not fits(0.0):
        return None
    share = None
    if principle.is_affine:
        share = _affine_share(primitive.course(at(0.0), robot), primitive.course(at(1.0), robot), primitive)
        share = math.nextafter(share, 0.0)
        if not (fits(share * (1 - 1e-6)) and not fits(min(1.0, share + 1e-3))):
            share = None  # other principles make it not affine after all
    if share is None:
        share = _last_good(fits, 0.0, 1.0)
    return float(getattr(_turned(principle, share), principle.dial))


def _affine_share(good: Course, bad: Course, primitive: Primitive) -> float:
    dt_s = primitive.learning.dt_s
    n = math.ceil(_TAIL * good.tau_s / dt_s - ROUNDING)
    neutral, wanted = (
        Trajectory(sampled(n, dt_s), integrate(course, dt_s, n)[0], course.joints) for course in (good, bad)
    )
    return share_that_fits(neutral, wanted, good.robot)


def _turned(principle: Principle, share: float) -> Principle:
    """The principle, that share of the way from neutral to what it is."""
    neutral = principle.neutral if principle.dial == "intensity" else 0.0
    wanted = getattr(principle, principle.dial)
    turned = neutral + share * (wanted - neutral)
    return principle.model_copy(update={principle.dial: turned or (None if principle.dial == "dip" else 0.0)})


def _fits(primitive: Primitive, modulation: Modulation, robot: Robot) -> bool:
    try:
        return not violations(primitive.rollout(modulation, robot), robot)
    except InputError:  # beyond what the principle itself allows
        return False


def _last_good(fits: Callable[[float], bool], good: float, bad: float, times: int = _BISECTIONS) -> float:
    """The last place that fits on the way from a good to a bad one, by bisection."""
    for _ in range(times):
        middle = (good + bad) / 2
        good, bad = (middle, bad) if fits(middle) else (good, middle)
    return good
