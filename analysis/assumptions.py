"""What a declared test assumes, and whether tests that do not assume it decide the same."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from analysis.levels import PAIRED, Compared
from analysis.plan import Levels, Outcome, Preferences, Targets
from analysis.statistics.t_test import TTest
from analysis.target import judge

Probabilities = Mapping[str, float | None]  # by stimulus or principle


@dataclass(frozen=True)
class Relaxed:
    """The same family of tests without an assumption of the declared one."""

    assumes: str
    test: str
    otherwise: tuple[str, ...]  # whose decision it turns round
    undefined: bool  # for all


def relaxed(outcome: Outcome) -> Iterator[Relaxed]:
    """Each assumption of the declared test, and the decisions of a test that does without it."""
    for assumes, test, probabilities in _tests(outcome):
        verdicts = judge(outcome.judging, {key: (test, p, None) for key, p in probabilities.items()})
        decided = {key: one.verdict.significant for key, one in outcome.results.items()}
        told = {key: one.significant for key, one in verdicts.items() if one.significant is not None}
        otherwise = tuple(key for key, significant in told.items() if significant != decided[key])
        yield Relaxed(assumes, test, otherwise, undefined=not told)


def _tests(outcome: Outcome) -> Iterator[tuple[str, str, Probabilities]]:
    if isinstance(outcome, Preferences):
        return  # an exact test, which assumes nothing of the kind
    if isinstance(outcome, Targets):
        yield from _of_targets(outcome)
    elif outcome.mirrors is None:
        yield from _of_levels(outcome)


def _of_targets(outcome: Targets) -> Iterator[tuple[str, str, Probabilities]]:
    if not all(isinstance(one.against.test, TTest) for one in outcome.results.values()):
        return
    if outcome.judging.test == "wilcoxon":
        return  # of ranks, which are neither normal nor evenly spaced
    yield (
        "normally distributed means",
        "exact sign flip",
        {key: one.against.exact.p for key, one in outcome.results.items()},
    )
    yield (
        "equally spaced points",
        "Wilcoxon's signed ranks",
        {key: one.wilcoxon.p_decisive for key, one in outcome.results.items()},
    )


def _of_levels(outcome: Levels) -> Iterator[tuple[str, str, Probabilities]]:
    results = outcome.results
    if outcome.judging.test in {"mcnemar", "wilcoxon"}:
        return  # exact, and of the pairs themselves; of ranks
    paired = outcome.judging.test in PAIRED
    if not paired:
        yield "equal variances", "Welch's t", {key: one.welch.p for key, one in results.items()}
        if outcome.comparison.outcome is not None:
            exact = {key: one.choices.fisher.p if one.choices else None for key, one in results.items()}
            yield "large samples", "Fisher's exact", exact
        if outcome.within:
            yield "independent answers", "paired t", {key: one.paired.p for key, one in results.items()}
    if outcome.within:
        name = "exact sign flip" if outcome.comparison.outcome is None else "McNemar's exact"
        assumes = "normally distributed means" if paired else "independent answers and normal means"
        yield assumes, name, {key: _exact_paired(one) for key, one in results.items()}


def _exact_paired(one: Compared) -> float | None:
    return one.sign_flip.p if one.choices is None else one.choices.mcnemar.p(one.sign_flip.alternative)
