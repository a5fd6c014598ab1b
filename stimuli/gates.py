"""Relations that hold only while joints between source and target are within limits.

Such a relation does not carry over its source's motion y_S, but what passes its gate: q' = m y_S', with m
from 0, closed, to 1, open. Then Secondary Action adds delta p m y_S', and Follow Through takes off
delta p (m y_S')'. The gate closes smoothly towards the limits, so that neither position nor velocity jumps.
Where it is open throughout, q is y_S and both are the paper's formulas.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stimuli.robots.model import Relation
from stimuli.trajectory import FloatArray, IndexArray


@dataclass(frozen=True)
class Gates:
    """The gates of some relations, R of them, and the joints that open them, C in all."""

    sources: IndexArray  # (R,)
    joints: IndexArray  # (C,) gate after gate
    firsts: IndexArray  # (R,) where in `joints` each gate's begin
    limits: FloatArray  # (3, C) lower, upper, and the way inside a limit on which the gate closes

    @classmethod
    def of(cls, relations: list[Relation], joints: tuple[str, ...]) -> Gates:
        """The gates of these relations between joints, which are counted as in `joints`."""
        within = [within for relation in relations for within in relation.while_]
        counts = [len(relation.while_) for relation in relations]
        return cls(
            sources=np.array([joints.index(relation.source) for relation in relations]),
            joints=np.array([joints.index(one.joint) for one in within]),
            firsts=np.cumsum([0, *counts[:-1]]),
            limits=np.array([(one.lower, one.upper, one.edge) for one in within]).T,
        )

    def opening(self, positions: FloatArray) -> FloatArray:
        """How far each gate is open, (…, R), at these positions of all joints, (…, d)."""
        lower, upper, edge = self.limits
        at = positions[..., self.joints]
        inside = np.minimum(np.maximum(np.minimum(at - lower, upper - at) / edge, 0.0), 1.0)
        opening: FloatArray = np.multiply.reduceat(inside * inside * (3 - 2 * inside), self.firsts, axis=-1)
        return opening

    def passed(self, motion: FloatArray, start: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What passes from sample to sample, (n - 1, R), and its velocities, (n, R).

        Of a motion (2, n, at least d), offsets from the start and velocities of all joints.
        """
        opening = self.opening(start + motion[0, :, : len(start)])
        steps = (opening[1:] + opening[:-1]) / 2 * np.diff(motion[0][:, self.sources], axis=0)
        return steps, opening * motion[1][:, self.sources]
