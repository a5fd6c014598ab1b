"""However clear the answer, no probability is 0."""

from __future__ import annotations

import numpy as np

import analysis


def test_a_probability_below_the_smallest_number_is_not_zero() -> None:
    ratings = np.repeat([5.0, 4.0], [9000, 1000])
    for p in (
        analysis.one_sample_t(ratings, 3, "greater").p,
        analysis.paired_t(ratings, np.zeros_like(ratings)).p,
        analysis.binomial(9000, 9000, 0.5, "greater").p,
        analysis.binomial(9000, 9000, 0.5).p,
        analysis.fisher(9000, 9000, 0, 9000).p,
    ):
        assert p is not None and 0 < p < 1e-300
