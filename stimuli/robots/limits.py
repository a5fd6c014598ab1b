"""How far and how fast a joint of one's own robot may move, and those that follow it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stimuli.robots.mimics import Mimic
    from stimuli.robots.model import JointKind

FURTHEST_M = 100.0  # of anything on a robot
MOST_TURNS = 10
FASTEST = 1000.0  # rad/s or m/s


@dataclass(frozen=True)
class Limits:
    """A joint's range, and its largest velocity where that is known."""

    lower: float
    upper: float
    velocity: float | None

    def of_leader(self, mimic: Mimic) -> Limits:
        """What a leader may do, these being the limits of the joint that follows it."""
        if mimic.multiplier == 0:
            stays = self.lower <= mimic.offset <= self.upper
            return Limits(-math.inf, math.inf, None) if stays else Limits(math.inf, -math.inf, None)
        ends = ((end - mimic.offset) / mimic.multiplier for end in (self.lower, self.upper))
        lower, upper = sorted(ends)
        return Limits(lower, upper, None if self.velocity is None else self.velocity / abs(mimic.multiplier))

    def and_also(self, other: Limits) -> Limits:
        """What keeps to both."""
        velocities = [limits.velocity for limits in (self, other) if limits.velocity is not None]
        return Limits(
            max(self.lower, other.lower), min(self.upper, other.upper), min(velocities, default=None)
        )


def beyond_belief(kind: JointKind, limits: Limits) -> str | None:
    """What no robot's joint does, and what would do; None where all may be."""
    far, velocity = max(limits.lower, limits.upper, key=abs), limits.velocity
    if kind == "revolute" and abs(far) > MOST_TURNS * math.tau:
        return (
            f"{far:g} rad is more than {MOST_TURNS} turns; give it in rad, or let the joint turn without end"
        )
    if kind == "prismatic" and abs(far) > FURTHEST_M:
        return f"{far:g} m is further than {FURTHEST_M:g} m; give it in m"
    if velocity is not None and velocity > FASTEST:
        return (
            f"velocity {velocity:g} is above {FASTEST:g} per second; give the true one, or 0 if it is unknown"
        )
    return None
