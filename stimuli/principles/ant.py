"""Anticipation: move against the way before going it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from stimuli.attractor import ROUNDING
from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.principles.principle import Principle, Stage
from stimuli.rollout import integrate
from stimuli.spring import growth_rate
from stimuli.units import POSITION, in_base_unit

LARGEST_GROWTH = 100.0

_STEP = 1 / 400  # of the duration, in about which a dip is looked for …
_AFTERWARDS = 0.1  # … until that long after the window
_BISECTIONS = 40


def _growth(p: float, alpha: float, window: float) -> float:
    return math.exp(min(700.0, growth_rate(alpha / 2, -p) * window))


def growths(course: Course) -> dict[str, float]:
    """How much each joint's motion grows in the window, for those that anticipate literally."""
    if course.gain is None:
        return {}
    return {
        joint: _growth(-gain, course.alpha, course.window)
        for joint, gain in zip(course.joints, course.gain.tolist(), strict=True)
        if gain <= 0
    }


def _dip(value: object) -> object:
    """A dip as written, `8 deg`, in the base unit."""
    return in_base_unit(value, POSITION) if isinstance(value, str) else value


class Ant(Principle):
    """Invert the acceleration of the most important joints at the start of the motion.

    `form: literal`, as in the paper: y'' becomes -p y'' while t / tau < window. Inside the window the spring
    is unstable, so the dip grows as exp[(alpha / 2) (p + sqrt(p^2 + p)) window]; beyond a factor of 100 it is
    refused, and so are steps so coarse that the one in which the window ends would double it. Near p = 0 the
    joint stands still for the window; p = 0 itself means no anticipation.

    `form: mirror`: in the window the joint moves as y0 - p (y - y0), y being what it would have done. The dip
    is proportional to p and cannot run away.

    `dip: 8 deg` instead of an intensity lets each of these joints dip by that much (rad, m or, for hands, a
    share) against its way, in either form: the intensity is found for each of them by bisection.

    Importance is the demonstrated peak-to-peak motion as a share of the joint's range, so that radians and
    hands compare; `joints` names them instead.
    """

    kind: ClassVar[str] = "ant"
    title: ClassVar[str] = "Anticipation"
    stage: ClassVar[Stage] = Stage.ACCELERATION
    strong: ClassVar[float] = 0.4

    intensity: float = Field(0.0, ge=0, le=100)
    dip: Annotated[float, BeforeValidator(_dip), Field(gt=0)] | None = None
    window: float = Field(0.075, gt=0, lt=1)
    count: int = Field(1, ge=1)
    joints: tuple[str, ...] = ()
    form: Literal["literal", "mirror"] = "literal"

    @model_validator(mode="after")
    def _intensity_or_dip(self) -> Self:
        if self.dip is not None and self.intensity:
            raise ValueError("ant.dip: is given besides an intensity; one of them decides the other")
        return self

    @property
    def dial(self) -> str:
        """What says how strong this is."""
        return "intensity" if self.dip is None else "dip"

    @property
    def is_neutral(self) -> bool:
        """Neither an intensity nor a dip."""
        return self.intensity == 0 and self.dip is None

    def modulate(self, course: Course) -> Course:
        """Turn the important joints around in the window."""
        factor = np.ones(len(course.joints))
        for column in self.important(course):
            factor[column] = -(self.intensity if self.dip is None else self._intensity_for(course, column))
        if self.form == "mirror":
            return replace(course, window=self.window, mirror=factor)
        if self.growth(course.alpha) > LARGEST_GROWTH:
            raise InputError(
                f"ant.intensity: {self.intensity:g} in a window of {self.window:g} makes the motion grow "
                f"{self.growth(course.alpha):.3g}-fold before it starts, the limit being {LARGEST_GROWTH:g}. "
                f"Take at most {self.largest_intensity(course.alpha):.3g}, a shorter window, or form: mirror"
            )
        return replace(course, window=self.window, gain=factor)

    def important(self, course: Course) -> list[int]:
        """Columns of the joints that anticipate."""
        if not self.joints:
            return [int(column) for column in np.argsort(-course.amplitudes, kind="stable")[: self.count]]
        return [course.column(joint, "ant.joints") for joint in self.joints]

    def _intensity_for(self, course: Course, column: int) -> float:
        """The intensity at which a joint dips as far as wanted."""
        wanted = self.dip or 0.0
        low, high = 0.0, 100.0 if self.form == "mirror" else self.largest_intensity(course.alpha)
        deepest = self._dip_at(high, course, column)
        if deepest < wanted:
            joint = course.robot.joint(course.joints[column])
            raise InputError(
                f"ant.dip: {joint.name} dips by at most {deepest:.3g} {joint.unit}, not {wanted:.3g}, in a "
                f"window of {self.window:g}. Take a smaller dip, a longer window, or other joints"
            )
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            low, high = (middle, high) if self._dip_at(middle, course, column) < wanted else (low, middle)
        return (low + high) / 2

    def _dip_at(self, intensity: float, course: Course, column: int) -> float:
        """How far that joint alone moves the other way than it does without anticipation."""
        alone = replace(
            course,
            joints=(course.joints[column],),
            weights=course.weights[:, [column]],
            start=course.start[[column]],
            goal=course.goal[[column]],
            window=self.window,
        )
        factor = np.array([-intensity])
        anticipating = replace(alone, mirror=factor) if self.form == "mirror" else replace(alone, gain=factor)
        in_window = max(1, math.ceil(self.window / _STEP - ROUNDING))  # steps
        step = self.window / in_window
        n = round((self.window + _AFTERWARDS) / step)
        plain, turned = (integrate(each, step * course.tau_s, n)[0][:, 0] for each in (alone, anticipating))
        way = np.sign(plain[in_window] - plain[0])
        return float(np.max(way * (turned[0] - turned)))

    def growth(self, alpha: float) -> float:
        """How much a motion grows in the window, at most: the unstable mode of the inverted spring."""
        return _growth(self.intensity, alpha, self.window)

    def largest_intensity(self, alpha: float) -> float:
        """The intensity at which the growth reaches its bound: p + sqrt(p^2 + p) = k solved for p."""
        k = math.log(LARGEST_GROWTH) / (alpha / 2 * self.window)
        return k * k / (2 * k + 1)
