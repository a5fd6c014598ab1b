"""Who is left out of the tests, by rules declared before the first answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analysis.answers import Answers
from analysis.dataset import Responses
from study.protocol import Exclusions


@dataclass(frozen=True)
class Excluded:
    """One participant left out, and the first rule that said so."""

    participant: str
    rule: str


@dataclass(frozen=True)
class Flow:
    """How many participants answered, were left out by which rule, and are analysed."""

    answered: int
    excluded: tuple[Excluded, ...]
    analysed: int
    rules: tuple[str, ...]  # those in force, in the order applied

    def count(self, rule: str) -> int:
        """How many a rule left out."""
        return sum(one.rule == rule for one in self.excluded)


def apply_exclusions(responses: Responses, rules: Exclusions) -> tuple[Responses, Flow]:
    """The responses of those who stay, and the flow of participants."""
    in_force: list[tuple[str, NDArray[np.bool_]]] = []
    if rules.incomplete:
        in_force.append(("incomplete", _incomplete(responses)))
    if rules.faster_than is not None:
        if responses.median_rt_s is None:
            in_force.append(
                (f"faster than {rules.faster_than:g} s (not applied: no column rt_ms)", _nobody(responses))
            )
        else:
            quick = np.nan_to_num(responses.median_rt_s, nan=np.inf) < rules.faster_than
            in_force.append((f"faster than {rules.faster_than:g} s per answer (median)", quick))
    if rules.failed_attention is not None:
        rule = f"failed {rules.failed_attention} or more attention checks"
        if responses.checks:
            in_force.append((rule, _failed_checks(responses) >= rules.failed_attention))
        else:
            in_force.append((f"{rule} (not applied: the study has none)", _nobody(responses)))
    if rules.straight_lining:
        in_force.append(("same answer throughout a part", _straight_lining(responses)))
    left_out: dict[str, str] = {}
    for rule, breaks in in_force:
        for place in np.flatnonzero(breaks):
            left_out.setdefault(responses.participants[place], rule)
    kept = np.array([name not in left_out for name in responses.participants], dtype=bool)
    flow = Flow(
        answered=len(responses.participants),
        excluded=tuple(Excluded(name, left_out[name]) for name in responses.participants if name in left_out),
        analysed=int(kept.sum()),
        rules=tuple(rule for rule, _ in in_force),
    )
    return responses.of_participants(kept), flow


def _nobody(responses: Responses) -> NDArray[np.bool_]:
    return np.zeros(len(responses.participants), dtype=bool)


def _incomplete(responses: Responses) -> NDArray[np.bool_]:
    """Participants who left an item of a stimulus they were to see unanswered, (participants,).

    An earlier version of the study asked what somebody who took part in it answered.
    """
    unfinished = _nobody(responses)
    began_with = [responses.earlier.get(name, "") for name in responses.participants]
    for version in sorted({*began_with}):
        mine = np.array([began == version for began in began_with])
        for question in responses.questions:
            there: Any = question.codes.T[..., mine].T >= 0
            asked = there.any(axis=0) if version else np.ones(there.shape[1:], dtype=bool)  # stimuli, items
            judged = asked.any(axis=1)
            finished = (there | ~asked).all(axis=2)[:, judged].sum(axis=1)
            shown = judged.sum() if question.shown is None else min(question.shown, judged.sum())
            spared = question.optional & ~there.any(axis=(1, 2))
            unfinished[mine] |= (finished < shown) & ~spared
    return unfinished


def _failed_checks(responses: Responses) -> NDArray[np.int64]:
    """How many attention checks each participant answered otherwise than asked, (participants,)."""
    failed = np.zeros(len(responses.participants), dtype=np.int64)
    for check in responses.checks:
        wrong = (check.codes >= 0) & (check.chose(str(check.expected)) != 1)
        failed += wrong.sum(axis=(1, 2))
    return failed


def _straight_lining(responses: Responses) -> NDArray[np.bool_]:
    """Participants whose answers to the items of a question are several and all the same, (participants,)."""
    straight = _nobody(responses)
    for question in responses.questions:
        if len(question.items) > 1:
            straight |= gave_one_answer(question)
    return straight


def gave_one_answer(question: Answers) -> NDArray[np.bool_]:
    """Participants whose answers to a question are several and all the same, (participants,)."""
    there = question.codes >= 0
    lowest = question.codes.min(axis=(1, 2), where=there, initial=np.iinfo(np.int8).max)
    alike = question.codes.max(axis=(1, 2)) == lowest
    straight: NDArray[np.bool_] = alike & (np.count_nonzero(there, axis=(1, 2)) > 1)
    return straight
