"""Dynamic movement primitives: a critically damped spring that chases a learned, moving attractor.

Notation, after Ijspeert et al. (2013) and Hielscher et al. (2025):

    tau^2 y'' = alpha (beta (g - y) - tau y') + f(x),    alpha = 4 beta

y position, g goal, tau duration (s), x phase, f(x) = x (sum_i w_i psi_i(x)) / (sum_i psi_i(x)) forcing term
with weights w. The phase falls evenly from 1 to 0 during tau and stays 0, so the forcing term is gone by then
and the spring comes to rest at the goal. With time in shares of the duration, s = t / tau, and rate = alpha /
2 this reads

    y'' = rate^2 (u - y) - 2 rate y',    u = g + f(x) / rate^2

Here it is learned; `stimuli.course` says what a rollout is made of, `stimuli.spring` takes the steps,
`stimuli.rollout` carries a whole course out in closed form and `stimuli.online` step by step.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from stimuli.course import Course, Scheme
from stimuli.ends import eased, rests_at_ends
from stimuli.errors import InputError
from stimuli.principles import Modulation
from stimuli.relations import relations_of
from stimuli.robots.model import Robot
from stimuli.rollout import roll_out
from stimuli.superposition import answers_in
from stimuli.trajectory import FloatArray, Trajectory

_REST_AFTER = 0.25  # of the duration, in which a learned motion is to stay at its goal


class Learning(BaseModel):
    """How demonstrations are learned and primitives integrated."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    alpha: float = Field(50.0, gt=0, le=1000)  # gain of the spring; intensities compare only at equal alpha
    n_weights: int = Field(50, ge=2, le=1000)  # per joint, centred at equal distances in time
    method: Literal["ridge", "lwr"] = "ridge"  # lwr: locally weighted regression, as in the paper
    regularisation: float = Field(
        1e-10, gt=0, le=1
    )  # of ridge, relative to the mean square response; 1e-6 if noisy
    scheme: Scheme = "foh"
    moving_ends: Literal["ease", "refuse"] = (
        "ease"  # what to do with a demonstration that does not rest there
    )
    dt_s: float = Field(0.01, gt=0, le=1)


@dataclass(frozen=True)
class Primitive:
    """What was learned of a demonstration: shape, start, end and duration."""

    joints: tuple[str, ...]
    weights: FloatArray  # (n_weights, d)
    start: FloatArray  # (d,)
    goal: FloatArray  # (d,)
    spans: FloatArray  # (d,) peak to peak of the demonstration
    tau_s: float
    learning: Learning

    @classmethod
    def learn(cls, demonstration: Trajectory, learning: Learning | None = None) -> Primitive:
        """The primitive that moves as the demonstration does, from rest to rest."""
        learning = learning or Learning()
        if not demonstration.duration_s > 0:
            raise InputError("A demonstration needs at least two samples at different times")
        if learning.moving_ends == "refuse" and not all(rests_at_ends(demonstration)):
            raise InputError(
                "The demonstration moves at its start or end; let it rest there, or set moving_ends: ease"
            )
        shown = eased(demonstration.resampled(learning.dt_s))
        offsets = shown.positions - shown.positions[0]  # (n + 1, d)
        fit = _ridge if learning.method == "ridge" else _locally_weighted
        return cls(
            joints=shown.joints,
            weights=fit(offsets, learning),
            start=shown.positions[0],
            goal=shown.positions[-1],
            spans=np.ptp(offsets, axis=0),
            tau_s=shown.duration_s,
            learning=learning,
        )

    def course(self, modulation: Modulation, robot: Robot) -> Course:
        """All that decides a rollout of this primitive on that robot under that modulation."""
        ranges = np.array([robot.joint(name).range for name in self.joints])
        plain = Course(
            robot=robot,
            joints=self.joints,
            relations=relations_of(robot, self.joints),
            alpha=self.learning.alpha,
            scheme=self.learning.scheme,
            amplitudes=self.spans / ranges,
            weights=self.weights,
            start=self.start,
            goal=self.goal,
            tau_s=self.tau_s,
        )
        return modulation.apply(plain)

    def rollout(self, modulation: Modulation, robot: Robot, dt_s: float | None = None) -> Trajectory:
        """The modulated motion, from rest to rest."""
        return roll_out(self.course(modulation, robot), dt_s or self.learning.dt_s)


def _ridge(offsets: FloatArray, learning: Learning) -> FloatArray:
    """Weights (n_weights, d) whose rollout comes closest to the demonstration, and rests after it as it does.

    A rollout is the spring's response to the goal plus, linearly, its responses R to each weight: so this is
    min_w |R w - (y - y_goal)|^2 + lambda |w|^2, in the very steps in which the primitive is rolled out.
    """
    q, r, to_goal = _responses(len(offsets) - 1, learning)
    rest = np.repeat(offsets[-1:], len(to_goal) - len(offsets), axis=0)
    wanted = np.concatenate([offsets, rest]) - to_goal * offsets[-1]
    weights: FloatArray = np.linalg.solve(r, q.T @ wanted)
    return weights


@lru_cache(maxsize=8)
def _responses(n: int, learning: Learning) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Responses to the weights, penalised and factored as Q R, and to the goal (samples, 1), in n steps.

    Kept, as gestures of one duration share them. Of Q only the rows of samples: those of the penalty meet 0.
    """
    shares = np.arange(n + 1 + round(_REST_AFTER * n)) / n
    x = 1 - np.minimum(shares, 1)
    responses = answers_in(x, learning.n_weights, learning.scheme, learning.alpha / 2, 1 / n)[0]
    to_weights, to_goal = responses[:, :-1], responses[:, -1:]
    penalty = np.sqrt(learning.regularisation * np.mean(np.sum(to_weights**2, axis=0)))
    q, r = np.linalg.qr(np.concatenate([to_weights, penalty * np.eye(learning.n_weights)]))
    return q[: len(shares)], r, to_goal


def _locally_weighted(offsets: FloatArray, learning: Learning) -> FloatArray:
    """Weights (n_weights, d), each fitted by itself to the forcing term near its centre (Schaal 1998).

    w_i = sum_k psi_i(x_k) x_k f_k / sum_k psi_i(x_k) x_k^2. Velocities are those the scheme goes by: backward
    differences for `semi`, else central ones; the motion is taken to rest before and after.
    """
    n, rate = len(offsets) - 1, learning.alpha / 2
    padded = np.concatenate([offsets[:1], offsets, offsets[-1:]])
    ahead, behind = (padded[2:] - padded[1:-1]) * n, (padded[1:-1] - padded[:-2]) * n
    velocities = behind if learning.scheme == "semi" else (ahead + behind) / 2
    forcing = (ahead - behind) * n - rate**2 * (offsets[-1] - offsets) + 2 * rate * velocities
    x = np.linspace(1.0, 0.0, n + 1)[:, None]
    bumps = np.exp(-(((x - np.linspace(1.0, 0.0, learning.n_weights)) * (learning.n_weights - 1)) ** 2))
    weights: FloatArray = (bumps * x).T @ forcing / np.sum(bumps * x**2, axis=0)[:, None]
    return weights
