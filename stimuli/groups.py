"""Which joints of a course can be carried out at once, and in which order: sources before their targets."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stimuli.course import Course
from stimuli.errors import InputError
from stimuli.gates import Gates
from stimuli.robots.model import Relation
from stimuli.spring import growth_rate
from stimuli.trajectory import FloatArray, IndexArray

_NOTHING = np.zeros(())
_OVERGROWTH = 2.0  # by which a motion may grow too much because its window ends within a step


@dataclass(frozen=True)
class Group:
    """Joints that can be carried out at once, or gates through which others' motion then passes."""

    depth: int  # of their sources' sources: 0 where no other joint acts on them
    gain: float  # in Anticipation's window
    mirror: float
    columns: IndexArray  # (m,)
    gates: Gates | None = None
    shifts: FloatArray | None = None  # (c, m) see `Course.displaced`
    drags: FloatArray | None = None  # (c, m) of velocities in the attractor, besides

    @property
    def anticipates(self) -> bool:
        """Whether these joints move differently in the window."""
        return (self.gain, self.mirror) != (1.0, 1.0)

    def refuse_overrun(self, course: Course, end: float) -> None:
        """InputError where a step begun in the window ends at `end`, so late that the motion runs away."""
        if self.gain > 0:
            return
        growing, allowed = growth_rate(course.rate, self.gain), math.log(_OVERGROWTH)
        if growing * (end - course.window) > allowed:
            raise InputError(
                f"ant.intensity: {-self.gain:g} needs finer steps: its window of {course.window:g} ends "
                f"within one, and the motion would run away until {end:.3g} of the duration. Take steps of "
                f"at most {allowed / growing * course.tau_s:.2g} s (finer in bent time), or form: mirror"
            )

    def from_sources(self, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What sources in this motion (2, …, c) add to these joints' states, (2, …, m), and attractors."""
        if self.shifts is None:
            return _NOTHING, _NOTHING
        shift: FloatArray = motion @ self.shifts
        return shift, shift[0] + motion[1] @ self.drags


def groups(course: Course, *, gated: bool) -> list[Group]:
    """All joints in groups that move alike, and, where `gated`, the gates; sources before their targets."""
    d, gates = len(course.joints), course.gated if gated else ()
    depths = _depths(course, gates)
    gain = np.ones(d) if course.gain is None else course.gain
    mirror = np.ones(d) if course.mirror is None else course.mirror
    kinds = list(zip(depths[:d].tolist(), gain.tolist(), mirror.tolist(), strict=True))
    made = []
    for kind in set(kinds):
        columns = np.flatnonzero([kind == other for other in kinds])
        if kind[0]:
            shifts, drags = course.displaced[columns].T, 2 / course.rate * course.dragging[columns].T
            made.append(Group(*kind, columns, shifts=shifts, drags=drags))
        else:
            made.append(Group(*kind, columns))
    for depth in set(depths[d:].tolist()):
        columns = np.flatnonzero(depths[d:] == depth)
        through = Gates.of([gates[column] for column in columns], course.joints)
        made.append(Group(depth, 1.0, 1.0, d + columns, through))
    return sorted(made, key=lambda group: (group.depth, group.gain, group.mirror, group.gates is not None))


def _depths(course: Course, gates: tuple[Relation, ...]) -> IndexArray:
    """How long the longest chain of sources is that leads to each joint, then to each gate."""
    d = len(course.joints)
    acts = np.zeros((d + len(gates), d + len(gates)), dtype=bool)
    if course.is_coupled:
        acts[:d] = (course.displaced != 0) | (course.dragging != 0)
    for row, relation in enumerate(gates, d):
        opened_by = (relation.source, *(within.joint for within in relation.while_))
        acts[row, [course.joints.index(joint) for joint in opened_by]] = True
    depths = np.zeros(len(acts), dtype=np.int64)
    while acts.any():
        deeper = np.max(np.where(acts, depths + 1, 0), axis=1)
        if np.array_equal(deeper, depths):
            break
        depths = deeper
    return depths
