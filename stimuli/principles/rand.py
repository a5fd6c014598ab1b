"""Randomization: no two motions quite alike, by noise on the weights."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar
from zlib import crc32

import numpy as np
from pydantic import Field

from stimuli.course import Course
from stimuli.principles.principle import Principle, Stage


class Rand(Principle):
    """Add coloured noise around the motion: w' = w + (1 + mean |w|) p eps, eps standard normal.

    Each joint draws from a stream of its own, made from the seed and the joint's name: the same seed gives
    the same motion, and a joint's noise does not depend on which other joints move. Acts on the weights as
    Arc left them. Weights are in the joint's unit, so the paper's "1 +" weighs more the smaller the motion.
    All joints are moved; `joints` names those that are to be instead, as a base that should stay where it is.
    """

    kind: ClassVar[str] = "rand"
    title: ClassVar[str] = "Randomization"
    stage: ClassVar[Stage] = Stage.WEIGHTS
    strong: ClassVar[float] = 0.3

    intensity: float = Field(0.0, ge=0, le=100)
    seed: int = Field(0, ge=0)
    joints: tuple[str, ...] = ()

    @property
    def is_affine(self) -> bool:
        """Whether motions change in proportion to the intensity, all else being equal."""
        return True

    def modulate(self, course: Course) -> Course:
        """Draw the noise."""
        noise = np.zeros_like(course.weights)  # (n_weights, d)
        for joint in self.joints or course.joints:
            drawn = np.random.default_rng([self.seed, crc32(joint.encode())])
            noise[:, course.column(joint, "rand.joints")] = drawn.standard_normal(len(noise))
        scale = 1 + np.abs(course.weights).mean(axis=0)
        return replace(course, weights=course.weights + scale * self.intensity * noise)
