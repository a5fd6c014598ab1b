"""What a one-dimensional sample is: its moments without the missing values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
ROUNDING = 1e-12  # of the largest value: less of a difference is none


def numbers(values: ArrayLike) -> FloatArray:
    """The values as floats; pandas.NA is NaN."""
    try:
        return np.asarray(values, dtype=float)
    except TypeError:
        objects = np.asarray(values, dtype=object)
        return np.where(missing(objects), np.nan, objects).astype(float)


def missing(values: NDArray[Any]) -> NDArray[np.bool_]:
    """Where there is no value: NaN, and among objects also None and pandas.NA."""
    if values.dtype != object:
        return np.asarray(np.not_equal(values, values))
    import pandas as pd

    return np.asarray(pd.isna(values))


def observed(values: ArrayLike) -> FloatArray:
    """The values that are there: a flat float array without NaN."""
    flat = numbers(values).ravel()
    present: FloatArray = flat[~np.isnan(flat)]
    return _finite(present)


def _finite(values: FloatArray) -> FloatArray:
    if np.isinf(values).any():
        raise ValueError("a value is infinite; what is missing is NaN or None")
    return values


def observed_pairs(first: ArrayLike, second: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Values of two aligned samples where neither is missing; position i of both is one participant."""
    a, b = numbers(first).ravel(), numbers(second).ravel()
    if a.shape != b.shape:
        raise ValueError(f"paired samples need equal lengths, got {a.size} and {b.size}")
    both = ~(np.isnan(a) | np.isnan(b))
    return _finite(a[both]), _finite(b[both])


def observed_rows(
    values: ArrayLike, x: ArrayLike, *groups: ArrayLike
) -> tuple[FloatArray, FloatArray, list[NDArray[np.intp]]]:
    """Answers, their conditions and their groups (the first: participants), each numbered from 0.

    Rows that miss any are left out.
    """
    answers, conditions = numbers(values).ravel(), numbers(x).ravel()
    if {answers.size, conditions.size, *(np.size(group) for group in groups)} != {answers.size}:
        counted = zip(("participants", "stimuli"), groups, strict=False)
        sizes = ", ".join(f"{np.size(group)} {name}" for name, group in counted)
        raise ValueError(
            f"columns need equal lengths, got {answers.size} answers, {conditions.size} conditions, {sizes}"
        )
    names = [np.asarray(group).ravel() for group in groups]
    lost = np.isnan(answers) | np.isnan(conditions)
    for group in names:
        lost = lost | missing(group)
    numbered = [np.unique(group[~lost], return_inverse=True)[1] for group in names]
    return _finite(answers[~lost]), conditions[~lost], numbered


@dataclass(frozen=True)
class Moments:
    """Number, mean, standard deviation and standard error of a sample; None where undefined."""

    n: int
    mean: float | None
    sd: float | None  # n − 1 in the denominator
    se: float | None  # sd / √n


def moments(values: ArrayLike) -> Moments:
    """Describe a sample, missing values left out."""
    x = observed(values)
    if x.size == 0:
        return Moments(n=0, mean=None, sd=None, se=None)
    mean = float(x.mean())
    if x.size == 1:
        return Moments(n=1, mean=mean, sd=None, se=None)
    alike = np.ptp(x) <= ROUNDING * np.abs(x).max()  # as 0.6 − 0.4 and 0.4 − 0.2 are
    sd = 0.0 if alike else float(x.std(ddof=1))
    return Moments(n=x.size, mean=mean, sd=sd, se=sd / float(np.sqrt(x.size)))
