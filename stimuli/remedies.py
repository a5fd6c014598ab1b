"""What would make a motion fit that a robot cannot do."""

from __future__ import annotations

import math
from collections.abc import Callable

from stimuli.attractor import ROUNDING
from stimuli.course import Course
from stimuli.dmp import Primitive
from stimuli.errors import InputError
from stimuli.feasibility import in_short, share_that_fits, violations
from stimuli.principles import Modulation, Principle
from stimuli.principles.time import Time
from stimuli.robots.model import Robot
from stimuli.rollout import integrate, sampled
from stimuli.trajectory import Trajectory

_BISECTIONS = 12
_LEAST = 0.005  # of the way from neutral: nobody wants to be advised less
_TAIL = 1.5  # durations looked at where motions are compared sample by sample
_LONGEST = 16.0  # times as long is the longest that `fit: scale` tries


def advice(primitive: Primitive, modulation: Modulation, robot: Robot) -> str:
    """One sentence: what would do. All that it names was tried, as it is written there."""

    def fits(tried: Modulation) -> bool:
        return _fits(primitive, tried, robot)

    neutral = violations(primitive.rollout(Modulation(), robot), robot)
    if neutral:
        return f"The gesture itself does not fit, without any modulation: {in_short(neutral)}."
    alone = [
        _named(turned)
        for principle in modulation.principles
        if (turned := _strongest(primitive, modulation, principle, robot)) is not None
    ]
    if alone:
        return f"It would fit with {' or '.join(alone)}."

    def at(share: float) -> Modulation:
        return Modulation(
            principles=tuple(_rounded(_turned(one, share), one) for one in modulation.principles)
        )

    share = _last_good(lambda tried: fits(at(tried)), 0.0, 1.0) if fits(at(0.0)) else 0.0
    if share >= _LEAST:
        together = ", ".join(map(_named, at(share).principles))
        return (
            "No single intensity makes it fit; all of them would, "
            f"{share:.0%} as far from neutral: {together}."
        )
    without = [
        one.kind
        for one in modulation.principles
        if fits(Modulation(principles=tuple(other for other in modulation.principles if other is not one)))
    ]
    if without:
        return f"No intensity makes it fit; it would fit without {' or without '.join(without)}."
    return "No intensity makes it fit; without any modulation it would."


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


def _strongest(
    primitive: Primitive, modulation: Modulation, principle: Principle, robot: Robot
) -> Principle | None:
    """The principle as strong as fits, in round numbers, all else being equal; None where no strength does.

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
    turned = _rounded(_turned(principle, share), principle)
    return turned if share >= _LEAST and _fits(primitive, modulation.with_(turned), robot) else None


def _rounded(turned: Principle, principle: Principle) -> Principle:
    """A principle turned down, its dial rounded to three digits, towards neutral."""
    dial = principle.dial
    value = getattr(turned, dial)
    if not value:
        return turned
    digits = 2 - math.floor(math.log10(abs(value)))
    down = value > (principle.neutral if dial == "intensity" else 0.0)
    whole = (math.floor if down else math.ceil)(round(value * 10.0**digits, 6))
    return principle.model_copy(update={dial: float(f"{whole / 10.0**digits:.3g}")})


def _named(principle: Principle) -> str:
    """The principle's dial and where it stands, such as `exa.intensity 1.54`."""
    return f"{principle.kind}.{principle.dial} {getattr(principle, principle.dial):g}"


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
