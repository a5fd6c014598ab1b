"""The spring of a movement primitive, in discrete steps.

    y'' = gain (rate^2 (u - y) - 2 rate y')

With gain 1 it is critically damped, both poles at -rate; other gains come from Anticipation. A step leads
from the state (y, y') to `across @ state + before * u_0 + after * u_1`, the attractor u being u_0 before and
u_1 after it.

`foh` is exact for an attractor that is linear between samples, `zoh` for one that is held; both are stable at
any step. `semi` is semi-implicit Euler, as in the program of the paper's authors, and refused where it is
unstable.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from stimuli.course import Scheme
from stimuli.errors import InputError
from stimuli.trajectory import FloatArray

_SEMI_LIMIT = (math.sqrt(32) - 4) / 2  # of rate * step, above which semi-implicit Euler is unstable
_SHORT = 0.05  # rate * step below which closed forms divide rounding errors by the step; a series does not …
_TERMS = 8  # … and is then exact to rounding


@dataclass(frozen=True)
class Step:
    """One step of a spring."""

    across: FloatArray  # (2, 2)
    before: FloatArray  # (2,)
    after: FloatArray  # (2,)

    @cached_property
    def matrix(self) -> FloatArray:
        """`across`, `before` and `after` in one matrix, (2, 4)."""
        return np.column_stack([self.across, self.before, self.after])

    def taken(self, state: FloatArray, u_0: FloatArray, u_1: FloatArray) -> FloatArray:
        """States (2, m) after this step of springs chasing what goes from u_0 to u_1, (m,) each."""
        begin = np.empty((4, len(u_0)))
        begin[:2], begin[2], begin[3] = state, u_0, u_1
        made: FloatArray = np.dot(self.matrix, begin)
        return made


@lru_cache(maxsize=4096)
def step_of(scheme: Scheme, rate: float, h: float, gain: float = 1.0) -> Step:
    """The step over a time h."""
    if scheme == "semi":
        return _semi_implicit(rate, h, gain)
    across = decay(rate, h, gain)
    held = np.array([1.0, 0.0])  # where a spring stays while u is 1
    if scheme == "zoh":
        return Step(across, held - across @ held, np.zeros(2))
    if (1 + abs(gain)) * rate * h < _SHORT:
        return Step(across, *_drawn_in_a_short_step(rate, h, gain))
    # Behind u_0 + slope t every such spring, whatever its gain, can run at the distance 2 slope / rate.
    behind = np.array([-2 / rate, 1.0]) / h  # that motion at u = 0, for u_1 - u_0 = 1
    return Step(across, across @ (behind - held) - behind, held + behind - across @ behind)


def decay(rate: float, h: float, gain: float = 1.0) -> FloatArray:
    """What a time h makes of the state while u is 0: the exponential of the system's matrix, (2, 2)."""
    system = np.array([[0.0, 1.0], [-gain * rate**2, -2 * gain * rate]])
    middle = -gain * rate * np.eye(2)  # mean of the poles, which lie at middle +- spread
    spread = rate * np.sqrt(complex(gain * gain - gain))
    even = np.cosh(spread * h).real
    odd = (np.sinh(spread * h) / spread).real if spread else h
    made: FloatArray = math.exp(-gain * rate * h) * (even * np.eye(2) + odd * (system - middle))
    return made


def _drawn_in_a_short_step(rate: float, h: float, gain: float) -> tuple[FloatArray, FloatArray]:
    """`before` and `after` where u is linear, (2,) each: sums of (h A)^k h B / (k + 2)! times k + 1 or 1.

    A and B are those of x' = A x + B u.
    """
    pull, brake = (
        gain * h * rate**2,
        2 * gain * h * rate,
    )  # in numbers, as clocks need a step of their own each
    position, velocity = 0.0, pull / 2
    before, after = [position, velocity], [position, velocity]
    for k in range(1, _TERMS):
        position, velocity = h * velocity / (k + 2), -(pull * position + brake * velocity) / (k + 2)
        for row, term in enumerate((position, velocity)):
            before[row] += (k + 1) * term
            after[row] += term
    return np.array(before), np.array(after)


def growth_rate(rate: float, gain: float) -> float:
    """How fast a spring with gain -p <= 0 runs away: its unstable pole, rate (p + sqrt(p^2 + p))."""
    return rate * (-gain + math.sqrt(gain * gain - gain))


def _semi_implicit(rate: float, h: float, gain: float) -> Step:
    if rate * h >= _SEMI_LIMIT:
        raise InputError(
            f"scheme semi: unstable in steps of {h:.3g} of the duration at alpha {2 * rate:g}. "
            f"Take at least {math.ceil(rate / _SEMI_LIMIT) + 1} steps per motion, or scheme foh"
        )
    pull, brake = gain * h * rate**2, 2 * gain * h * rate
    across = np.array([[1 - h * pull, h * (1 - brake)], [-pull, 1 - brake]])
    return Step(across, np.array([h * pull, pull]), np.zeros(2))


def respond(chased: FloatArray, state: FloatArray, step: Step) -> FloatArray:
    """Motion (2, n + 1, m), positions and velocities, of springs chasing `chased` (n + 1, m) from `state`.

    The recursion x_{k+1} = A x_k + b_k as one banded system for positions and velocities alike: by Cayley and
    Hamilton x_{k+2} = tr(A) x_{k+1} - det(A) x_k + b_{k+1} + (A - tr(A)) b_k.
    """
    from scipy.linalg.lapack import dtbtrs  # late: slow to import

    if len(chased) == 1:
        return state[:, None]
    (a, b), (c, d) = step.across
    driven = (
        step.before[:, None, None] * chased[:-1] + step.after[:, None, None] * chased[1:]
    )  # b_k, (2, n, m)
    source = driven.copy()
    source[0, 1:] += b * driven[1, :-1] - d * driven[0, :-1]
    source[1, 1:] += c * driven[0, :-1] - a * driven[1, :-1]
    source[:, 0] += step.across @ state
    source[:, 1:2] -= (a * d - b * c) * state[:, None]
    n = source.shape[1]
    recursion = np.repeat([[1.0], [-(a + d)], [a * d - b * c]], n, axis=1)  # its diagonals
    solved, _ = dtbtrs(recursion, source.swapaxes(0, 1).reshape(n, -1), uplo="L", diag="U")
    motion = np.empty((2, *chased.shape))
    motion[:, 0] = state
    motion[:, 1:] = solved.reshape(n, 2, -1).swapaxes(0, 1)
    return motion
