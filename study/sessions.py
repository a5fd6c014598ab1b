"""A session's way through the study, as pure functions: from the plan and what is stored to the next page.

A session is a fixed list of steps and the set of steps already answered. The next page is the first step not
answered; nothing else is remembered, so a reload, a second tab, the back button or another device can only
ever lead to the same page.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from functools import lru_cache
from itertools import groupby
from typing import Any, Literal
from uuid import UUID

from study.orders import Plan, Trial

PRACTICE = "practice"

StepKind = Literal["demographics", "instructions", "trial"]


@dataclass(frozen=True)
class Step:
    """One page to be answered. Its key is stored with the response."""

    key: str
    kind: StepKind
    part: str | None = None  # for instructions and trials; None for the instructions of the practice
    trial: Trial | None = None


@dataclass(frozen=True)
class Session:
    """A participant who has consented, and all that was fixed for them at that moment."""

    participant: str
    plan: Plan
    plan_sha256: str
    protocol_sha256: str
    software: str
    language: str
    consent_sha256: str  # of the text that was agreed to, as it was shown
    completion_code: str
    begun_at: datetime  # UTC
    completed_at: datetime | None = None


class Verdict(Enum):
    """What becomes of a submission."""

    STORE = "store"
    KNOWN = "known"  # sent again: acknowledged, not stored twice
    ELSEWHERE = "elsewhere"  # the step was answered before, in another tab or on another device
    NOT_YET = "not yet"  # the step is unknown, or others come before it


Pages = tuple[Step, ...]


@lru_cache(maxsize=1024)
def steps(plan: Plan, *, demographics: bool = True, left_out: frozenset[str] = frozenset()) -> Pages:
    """All pages between consent and debriefing, in order: demographics, instructions, practice, parts.

    `left_out` are the parts that earlier answers spare this participant.
    """
    trials_due = [trial for trial in plan.trials if trial.part not in left_out]
    pages: list[Step] = []
    if demographics:
        pages.append(Step(key="demographics", kind="demographics"))
    for section, trials in groupby(trials_due, key=lambda trial: PRACTICE if trial.practice else trial.part):
        part = None if section == PRACTICE else section
        pages.append(Step(key=f"instructions:{section}", kind="instructions", part=part))
        for number, trial in enumerate(trials, start=1):
            pages.append(Step(key=f"{section}:{number}", kind="trial", part=trial.part, trial=trial))
    return tuple(pages)


def next_step(pages: Sequence[Step], answered: Collection[str]) -> Step | None:
    """The first page not yet answered; None when the study is done."""
    return next((page for page in pages if page.key not in answered), None)


def judge(submission_id: UUID, step: str, *, pages: Sequence[Step], answered: dict[str, UUID]) -> Verdict:
    """Decide about a submission, given the steps already answered and the submissions that answered them."""
    if step in answered:
        return Verdict.KNOWN if answered[step] == submission_id else Verdict.ELSEWHERE
    due = next_step(pages, answered)
    if submission_id in tuple(answered.values()):  # at once: another thread adds to them
        return Verdict.NOT_YET  # a browser makes an id for one page only
    return Verdict.STORE if due is not None and due.key == step else Verdict.NOT_YET


def plan_json(plan: Plan) -> str:
    """The plan as canonical JSON: what is stored and hashed."""
    fields = vars(plan) | {"trials": [vars(trial) for trial in plan.trials]}
    return json.dumps(fields, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def plan_sha256(plan: Plan) -> str:
    """Hash of the plan's canonical JSON."""
    return hashlib.sha256(plan_json(plan).encode()).hexdigest()


@lru_cache(maxsize=1024)
def read_plan(text: str) -> Plan:
    """The plan from its canonical JSON."""
    fields: dict[str, Any] = json.loads(text)
    trials = tuple(Trial(**_tuples(trial)) for trial in fields.pop("trials"))
    return Plan(**fields, trials=trials)


def _tuples(trial: dict[str, Any]) -> dict[str, Any]:
    rows = {name: tuple(tuple(row) for row in trial[name]) for name in ("items", "options")}
    return trial | rows | {"pair": tuple(pair) if (pair := trial.get("pair")) else None}
