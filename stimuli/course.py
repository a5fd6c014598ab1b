"""A course: all that decides one rollout of a movement primitive, as the principles change it.

A principle is a function from course to course; `stimuli.dmp` carries a course out. Time is counted as the
share s = t / tau of the motion's duration, 0 at the start and 1 at its end; the phase is x = 1 - progress(s).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from stimuli.errors import InputError, nearest
from stimuli.robots.model import Relation, Robot
from stimuli.trajectory import FloatArray

Scheme = Literal["foh", "zoh", "semi"]


@dataclass(frozen=True)
class Curve:
    """An increasing map of [0, 1] onto itself: how much is gone by at a share of time."""

    gone: Callable[[FloatArray], FloatArray]
    slope: Callable[[FloatArray], FloatArray]

    def after(self, first: Curve | None) -> Curve:
        """The curve that applies `first`, then this."""
        if first is None:
            return self
        return Curve(
            lambda share: self.gone(first.gone(share)),
            lambda share: self.slope(first.gone(share)) * first.slope(share),
        )


@dataclass(frozen=True)
class Course:
    """What the integrator is given. Arrays over joints have d entries, columns as in `joints`."""

    robot: Robot
    joints: tuple[str, ...]
    relations: tuple[Relation, ...]  # for Secondary Action and Follow Through, sources before their targets
    alpha: float
    scheme: Scheme
    amplitudes: FloatArray  # (d,) peak to peak of the demonstration, as a share of the joint's range

    weights: FloatArray  # (n_weights, d)
    start: FloatArray  # (d,)
    goal: FloatArray  # (d,)
    tau_s: float

    progress: Curve | None = None  # share of the phase gone by at a share of time; None: the same
    clock: Curve | None = None  # share of the whole motion, spring and all, gone by at a share of time

    exaggeration: float = 1.0  # factor on the forcing term …
    around: Literal["goal", "straight"] = (
        "goal"  # … around the unforced path, or a straight reach to the goal
    )

    window: float = 0.0  # share of time at the start in which …
    gain: FloatArray | None = None  # (d,) … accelerations are multiplied by this, …
    mirror: FloatArray | None = None  # (d,) … and so is the way from the start to the attractor

    # Targets in rows; in columns their sources: all joints, then what passes each gate (`stimuli.gates`).
    dragged: FloatArray | None = None  # (d, c) target's acceleration loses this times the source's
    induced: FloatArray | None = None  # (d, c) target's rate of position gains this times the source's
    carried: FloatArray | None = None  # (d, c) s; target's shown position gains this times source's velocity

    former_goal: FloatArray | None = None  # (d,) goal before a goal that glides …
    goal_lag_s: float = 0.0  # … with this time constant; 0: at once …
    goal_since: float = 0.0  # … from this share of time on
    until_then: Course | None = None  # whose goals are headed for before that

    def column(self, joint: str, place: str) -> int:
        """Where a joint stands; InputError, naming the place that names the joint, where there is none."""
        if joint in self.joints:
            return self.joints.index(joint)
        raise InputError(f"{place}: {self.robot.name} has no joint {joint!r}; {nearest(joint, self.joints)}")

    @property
    def rate(self) -> float:
        """alpha / 2, in shares of time: both poles of the spring are at -rate."""
        return self.alpha / 2

    @property
    def dragging(self) -> FloatArray:
        """`dragged`, zero where there is none."""
        return self.coupling(0.0) if self.dragged is None else self.dragged

    @property
    def carrying(self) -> FloatArray:
        """`carried`, zero where there is none."""
        return self.coupling(0.0) if self.carried is None else self.carried

    @property
    def displaced(self) -> FloatArray:
        """How much of its sources' positions a target's spring is displaced by, (d, c).

        A dragged target obeys y'' = F(u, y, y') - c y_S'': then z = y + c y_S is a plain spring that chases
        u + c (y_S + 2 y_S' / rate). An induced one has y' = v + k y_S': then z = y - k y_S chases u - k y_S.
        So a target is carried out as the plain spring z, after its sources, and z turned back into y.
        """
        return self.dragging if self.induced is None else self.dragging - self.induced

    @property
    def is_coupled(self) -> bool:
        """Whether any joint's spring depends on another's."""
        return self.dragged is not None or self.induced is not None

    @cached_property
    def causes(self) -> FloatArray:
        """What moves the springs, (n_weights + 1, d): the weights, exaggerated, and the way to the goal."""
        return np.concatenate([self.exaggeration * self.weights, (self.goal - self.start)[None]])

    @property
    def is_linear(self) -> bool:
        """Whether `causes` is all that moves them: goals stay, and exaggeration acts around the goal."""
        return (
            self.goal_lag_s == 0
            and self.until_then is None
            and (self.around == "goal" or self.exaggeration == 1)
        )

    @property
    def is_plain(self) -> bool:
        """Whether every joint is a spring of its own in even time: none acts on another, none anticipates."""
        return self.clock is None and self.window == 0 and self.carried is None and not self.is_coupled

    @property
    def gated(self) -> tuple[Relation, ...]:
        """Relations that hold under conditions, in the order of their columns."""
        return tuple(relation for relation in self.relations if relation.while_)

    def coupling(self, strength: float) -> FloatArray:
        """Strength times delta for each relation between moving joints; (d, c), targets in rows."""
        d, gated = len(self.joints), self.gated
        matrix = np.zeros((d, d + len(gated)))
        for relation in self.relations:
            row, column = self.joints.index(relation.target), self.joints.index(relation.source)
            matrix[row, d + gated.index(relation) if relation.while_ else column] = relation.sign * strength
        return matrix
