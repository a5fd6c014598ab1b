"""Anticipation: move against the way before going it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.principles.principle import Principle, Stage

LARGEST_GROWTH = 100.0


class Ant(Principle):
    """Invert the acceleration of the most important joints at the start of the motion.

    `form: literal`, as in the paper: y'' becomes -p y'' while t / tau < window. Inside the window the spring
    is unstable, so the dip grows as exp[(alpha / 2) (p + sqrt(p^2 + p)) window]; beyond a factor of 100 it is
    refused. Near p = 0 the joint stands still for the window; p = 0 itself means no anticipation.

    `form: mirror`: in the window the joint moves as y0 - p (y - y0), y being what it would have done. The dip
    is proportional to p and cannot run away.

    Importance is the demonstrated peak-to-peak motion as a share of the joint's range, so that radians and
    hands compare; `joints` names them instead.
    """

    kind: ClassVar[str] = "ant"
    title: ClassVar[str] = "Anticipation"
    stage: ClassVar[Stage] = Stage.ACCELERATION
    strong: ClassVar[float] = 0.4

    intensity: float = Field(0.0, ge=0, le=100)
    window: float = Field(0.075, gt=0, lt=1)
    count: int = Field(1, ge=1)
    joints: tuple[str, ...] = ()
    form: Literal["literal", "mirror"] = "literal"

    def modulate(self, course: Course) -> Course:
        """Turn the important joints around in the window."""
        factor = np.ones(len(course.joints))
        factor[self.important(course)] = -self.intensity
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
        unknown = sorted(set(self.joints) - set(course.joints))
        if unknown:
            raise InputError(f"ant.joints: no joint {unknown[0]!r}. Known: {', '.join(course.joints)}")
        return [course.joints.index(joint) for joint in self.joints]

    def growth(self, alpha: float) -> float:
        """How much a motion grows in the window, at most: the unstable mode of the inverted spring."""
        p = self.intensity
        return math.exp(min(700.0, alpha / 2 * (p + math.sqrt(p * p + p)) * self.window))

    def largest_intensity(self, alpha: float) -> float:
        """The intensity at which the growth reaches its bound: p + sqrt(p^2 + p) = k solved for p."""
        k = math.log(LARGEST_GROWTH) / (alpha / 2 * self.window)
        return k * k / (2 * k + 1)
