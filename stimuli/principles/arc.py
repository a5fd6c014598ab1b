"""Arc: rounder or sharper paths, by smoothing or sharpening the weights."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from stimuli.course import Course
from stimuli.principles.principle import Principle, Stage


class Arc(Principle):
    """Smooth the weights (p > 0) or sharpen them by unsharp masking (p < 0).

    w' = G(p) * w for p > 0, and w' = w + (w - G(-p) * w) for p < 0, G(sigma) a Gaussian filter along the
    weights of each joint, reflected at the ends, cut off at four sigma.

    With `unit: weights`, as in the paper, sigma counts weights, so what an intensity does depends on how many
    there are. With `unit: duration` sigma is a share of the motion's duration, whatever their number: 0.1 of
    50 weights is the paper's 4.9.
    """

    kind: ClassVar[str] = "arc"
    title: ClassVar[str] = "Arc"
    stage: ClassVar[Stage] = Stage.WEIGHTS
    strong: ClassVar[float] = 5.0

    intensity: float = Field(0.0, ge=-100, le=100)
    unit: Literal["weights", "duration"] = "weights"

    def modulate(self, course: Course) -> Course:
        """Filter the weights."""
        from scipy.ndimage import gaussian_filter1d  # late: slow to import

        weights = course.weights  # (n_weights, d)
        sigma = abs(self.intensity) * (1 if self.unit == "weights" else len(weights) - 1)
        smooth: np.ndarray = gaussian_filter1d(weights, sigma, axis=0, mode="reflect", truncate=4.0)
        return replace(course, weights=smooth if self.intensity > 0 else weights + (weights - smooth))
