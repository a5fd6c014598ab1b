"""Every function of `import analysis` on columns that are empty, constant, missing, huge, tiny or tied."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pandas
import pytest
from hypothesis import given
from hypothesis import strategies as st

import analysis

nan = float("nan")
SIDES = ("greater", "less", "two-sided")
COLUMNS: tuple[Callable[[np.random.Generator, int], np.ndarray], ...] = (
    lambda rng, n: np.full(n, float(rng.integers(1, 6))),
    lambda rng, n: np.full(n, nan),
    lambda rng, n: rng.integers(1, 6, n).astype(float),
    lambda rng, n: rng.normal(size=n) * 10.0 ** rng.integers(-9, 9),
    lambda rng, n: rng.choice([1.0, 5.0, nan], n),
)


class Drawn:
    """Columns of up to eight answers."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.n = int(self.rng.integers(0, 9))
        self.x, self.y, self.other = self.column(), self.column(), self.column(int(self.rng.integers(0, 9)))
        self.null, self.side = float(self.rng.integers(1, 6)), SIDES[self.rng.integers(3)]
        self.table = np.column_stack([self.column() for _ in range(self.rng.integers(1, 5))])
        self.places = np.array([self.rng.permutation(3) + 1.0 for _ in range(self.n)]).reshape(self.n, 3)

    def column(self, n: int | None = None) -> np.ndarray:
        return COLUMNS[self.rng.integers(len(COLUMNS))](self.rng, self.n if n is None else n)

    def choices(self) -> np.ndarray:
        return self.rng.choice([0.0, 1.0, 1.0, nan], self.n)

    def count(self) -> tuple[int, int]:
        n = int(self.rng.integers(0, 9))
        return int(self.rng.integers(0, n + 1)), n

    def rows(self, *options: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        n = 2 * self.n
        return self.rng.choice([*options, nan], n), self.rng.choice([0.0, 1.0], n), self.rng.integers(0, 4, n)

    def crossed(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Value, participant, stimulus and a covariate."""
        answers, x, people = self.rows(1, 2, 3)
        return answers, people, self.rng.integers(0, 3, people.size), x

    def family(self) -> dict[str, float | None]:
        return {str(k): None if self.rng.random() < 0.3 else float(self.rng.random()) for k in range(self.n)}


CALLS: Mapping[str, Callable[[Drawn], object]] = {
    "adjust": lambda d: [
        analysis.adjust(d.family(), how) for how in ("none", "holm", "bonferroni", "benjamini-hochberg")
    ],
    "binomial": lambda d: analysis.binomial(*d.count(), 0.5, d.side),
    "bootstrap_mean": lambda d: analysis.bootstrap_mean(d.x, d.rng, resamples=99),
    "carry_over": lambda d: analysis.carry_over(np.column_stack([d.x, d.y, d.x]), d.places),
    "clopper_pearson": lambda d: analysis.clopper_pearson(*d.count()),
    "cronbach_alpha": lambda d: analysis.cronbach_alpha(d.table),
    "cumulative_link_mixed": lambda d: analysis.cumulative_link_mixed(*d.rows(1, 2, 3)),
    "equivalence": lambda d: analysis.equivalence(d.x, (d.null - 0.5, d.null + 0.5)),
    "fisher": lambda d: analysis.fisher(*d.count(), *d.count(), d.side),
    "friedman": lambda d: analysis.friedman(d.table),
    "gee_logistic": lambda d: analysis.gee_logistic(*d.rows(0, 1)),
    "icc": lambda d: analysis.icc(d.table),
    "jzs_bayes_factor": lambda d: [
        analysis.jzs_bayes_factor(analysis.one_sample_t(d.x, d.null, d.side)),
        analysis.jzs_bayes_factor(analysis.student_t(d.x, d.other, d.side)),
    ],
    "krippendorff_alpha": lambda d: analysis.krippendorff_alpha(d.table),
    "label_permutation": lambda d: analysis.label_permutation(d.table, 0),
    "linear_mixed": lambda d: [
        analysis.linear_mixed(*d.crossed()[:3]),
        analysis.linear_mixed(*d.crossed()),
    ],
    "logistic_mixed": lambda d: analysis.logistic_mixed(*d.rows(0, 1)),
    "mcnemar": lambda d: analysis.mcnemar(d.choices(), d.choices()),
    "newcombe": lambda d: analysis.newcombe(*d.count(), *d.count()),
    "one_sample_t": lambda d: analysis.one_sample_t(d.x, d.null, d.side),
    "paired_t": lambda d: analysis.paired_t(d.x, d.y, d.side),
    "position_effect": lambda d: analysis.position_effect(np.column_stack([d.x, d.y, d.x]), d.places),
    "sign_flip": lambda d: analysis.sign_flip(d.x, d.null, d.side),
    "student_t": lambda d: analysis.student_t(d.x, d.other, d.side),
    "t_sentence": lambda d: analysis.t_sentence(analysis.one_sample_t(d.x, d.null, d.side)),
    "welch_t": lambda d: analysis.welch_t(d.x, d.other, d.side),
    "wilcoxon": lambda d: analysis.wilcoxon(d.x, d.null, d.side),
    "wilson": lambda d: analysis.wilson(*d.count()),
}


def numbers(found: Any, name: str = "") -> Iterator[tuple[str, float]]:
    """Every number in a result with the name of its field."""
    if is_dataclass(found):
        for field in fields(found):
            yield from numbers(getattr(found, field.name), field.name)
    elif isinstance(found, Mapping):
        for value in found.values():
            yield from numbers(value, name)
    elif isinstance(found, list | tuple):
        for value in found:
            yield from numbers(value, name)
    elif found is not None and not isinstance(found, str):
        yield name, float(found)


@pytest.mark.parametrize("name", analysis.__all__)
@given(seed=st.integers(0, 2**32))
def test_a_result_is_finite_or_none_and_never_impossible(name: str, seed: int) -> None:
    for field, value in numbers(CALLS[name](Drawn(seed))):
        assert math.isfinite(value), field
        if field == "p" or field.startswith("p_"):
            assert 0 < value <= 1, field


class WithNA(Drawn):
    """The same columns as pandas has them: objects, and NA where nothing was answered."""

    def column(self, n: int | None = None) -> np.ndarray:
        return as_objects(super().column(n))

    def choices(self) -> np.ndarray:
        return as_objects(super().choices())

    def rows(self, *options: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        answers, conditions, people = super().rows(*options)
        return as_objects(answers), as_objects(conditions), as_objects(people)

    def family(self) -> dict[str, float | None]:
        return {name: pandas.NA if p is None else p for name, p in super().family().items()}


def as_objects(column: np.ndarray) -> np.ndarray:
    objects = column.astype(object)
    objects[np.isnan(column)] = pandas.NA
    return objects


@pytest.mark.parametrize("name", analysis.__all__)
@given(seed=st.integers(0, 2**32))
def test_na_is_missing_as_nan_is(name: str, seed: int) -> None:
    assert repr(CALLS[name](WithNA(seed))) == repr(CALLS[name](Drawn(seed)))


MODELS = {"gee_logistic": (0, 1), "logistic_mixed": (0, 1), "cumulative_link_mixed": (1, 2, 3)}


@pytest.mark.parametrize("name", MODELS)
def test_rows_without_an_answer_or_a_participant_are_left_out_of_models(name: str) -> None:
    rng = np.random.default_rng(3)
    people = np.repeat([f"P{person}" for person in range(12)], 4).astype(object)
    answers, conditions = rng.choice(MODELS[name], 48).astype(float), np.tile([0.0, 1.0], 24)
    answers[5], people[20] = nan, None
    there = ~(np.isnan(answers) | (people == None))  # noqa: E711
    fit = getattr(analysis, name)
    found = fit(answers, conditions, people)
    assert found == fit(answers[there], conditions[there], people[there])
    assert found.effect is not None and found.n == 46


REFUSED: Mapping[str, tuple[Callable[[], object], str]] = {
    "side of t": (lambda: analysis.student_t([1, 2], [3, 5], "Greater"), "did you mean greater?"),
    "side of ranks": (lambda: analysis.wilcoxon([1, 2], 0, "larger"), "alternative 'larger'"),
    "side of flips": (lambda: analysis.sign_flip([1, 2], 0, "both"), "alternative 'both'"),
    "side of a share": (lambda: analysis.binomial(1, 2, 0.5, "x"), "alternative 'x'"),
    "side of shares": (lambda: analysis.fisher(1, 2, 1, 2, "x"), "alternative 'x'"),
    "rule for zeros": (lambda: analysis.wilcoxon([1, 2], zeros="drop"), "zeros 'drop'"),
    "correction": (lambda: analysis.adjust({"a": 0.1}, "holms"), "did you mean holm?"),
    "more than all": (lambda: analysis.binomial(5, 3), "5 of 3 is no count"),
    "fewer than none": (lambda: analysis.wilson(-1, 3), "-1 of 3 is no count"),
    "half a count": (lambda: analysis.clopper_pearson(1.5, 3), "1.5 of 3 is no count"),
    "count of a group": (lambda: analysis.fisher(1, 2, 4, 3), "4 of 3 is no count"),
    "share above 1": (lambda: analysis.binomial(1, 3, 1.5), "null 1.5 is no share"),
    "rating as choice": (lambda: analysis.mcnemar([1, 4], [0, 1]), "1 for yes and 0 for no, not 4"),
    "rating in a model": (lambda: analysis.gee_logistic([1, 4], [0, 1], [1, 1]), "not 4"),
    "columns of two lengths": (lambda: analysis.gee_logistic([1, 0, 1], [0, 1], [1, 1]), "got 3 answers"),
    "infinite": (lambda: analysis.one_sample_t([1, math.inf], 3), "infinite"),
    "no table": (lambda: analysis.cronbach_alpha([1, 2, 3]), r"needs a table \(participants, items\)"),
    "bounds": (lambda: analysis.equivalence([1, 2, 3], (4, 2)), "the first is the lower one"),
}


@pytest.mark.parametrize("asked", REFUSED)
def test_what_cannot_be_asked_is_refused(asked: str) -> None:
    call, says = REFUSED[asked]
    with pytest.raises(ValueError, match=says.replace("?", r"\?")):
        call()
