"""Which of two clips is preferred: how often one is chosen over the other, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from analysis.answers import Answers
from analysis.fields import ResponsesError
from analysis.statistics.binomial import Binomial, binomial
from analysis.target import Judging, Verdict, judge


@dataclass(frozen=True)
class Two:
    """One pair of stimuli, and which of the two counts."""

    pair: str
    first: str
    second: str


@dataclass(frozen=True)
class Preferred:
    """One pair with its test: the share that preferred the first, against one half."""

    compared: Two
    test: Binomial
    verdict: Verdict


def preferences(
    answers: Answers, item: str, pairs: Mapping[str, Two], judging: Judging
) -> dict[str, Preferred]:
    """Test each pair by the exact binomial test; the family is the pairs.

    Each participant sees a pair once, so the answers to it are independent.
    """
    tests = {name: _test(answers, item, compared, judging) for name, compared in pairs.items()}
    verdicts = judge(judging, {name: ("binomial", test.p, test.reason) for name, test in tests.items()})
    return {name: Preferred(pairs[name], test, verdicts[name]) for name, test in tests.items()}


def _test(answers: Answers, item: str, compared: Two, judging: Judging) -> Binomial:
    chosen = answers.codes[:, answers.stimuli.index(compared.pair), answers.items.index(item)]
    first, second = (
        int((chosen == answers.options.index(one)).sum()) for one in (compared.first, compared.second)
    )
    if first + second < int((chosen >= 0).sum()):
        raise ResponsesError(
            f"{compared.pair} is answered by a clip that was not shown; "
            f"known: {compared.first}, {compared.second}"
        )
    return binomial(first, first + second, 0.5, judging.alternative)
