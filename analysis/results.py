"""results.json: every number of the report, for programs.

Strict JSON; what is undefined is null beside a reason.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from functools import cached_property
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from analysis.assumptions import relaxed
from analysis.care import Pace, Variety, pace, varieties
from analysis.chance import DEFINITIONS
from analysis.description import described
from analysis.further import SEED, Further
from analysis.levels import Compared
from analysis.plan import Findings, Levels, Preferences, Targets
from analysis.statistics.samples import Moments
from analysis.statistics.t_test import TTest
from analysis.target import AgainstChance, Recognised, Verdict

Json = dict[str, Any]


@dataclass(frozen=True)
class Provenance:
    """What the numbers came from."""

    study: str
    protocol_sha256: str
    responses_sha256: str
    software: Mapping[str, str]
    seed: int = 0  # of the study's orders
    answered: tuple[str, str] | None = None  # when the first and the last answer were given
    analysed: str | None = None  # when, where somebody said so: no clock is read, for equal bytes


@dataclass(frozen=True)
class Results:
    """A study's findings, and where they came from."""

    findings: Findings
    provenance: Provenance
    further: Further

    def as_json(self) -> Json:
        """The contents of results.json."""
        flow = self.findings.flow
        content: Json = {
            "study": self.provenance.study,
            "data": self.findings.responses.kind,
            "protocol_sha256": self.provenance.protocol_sha256,
            "responses_sha256": self.provenance.responses_sha256,
            "answered_at": self.provenance.answered,
            "analysed_at": self.provenance.analysed,
            "software": dict(self.provenance.software),
            "seed": self.provenance.seed,
            "alpha": self.findings.alpha,
            "participants": {
                "answered": flow.answered,
                "n": flow.analysed,
                "excluded": [asdict(one) for one in flow.excluded],
                "rules": list(flow.rules),
            },
            "missing": "left out of each test it concerns; paired tests use complete pairs",
            "hypotheses": {},
        }
        for name, outcome in self.findings.outcomes.items():
            content["hypotheses"][name] = {
                "part": outcome.part,
                "results": outcome.name,
                **asdict(outcome.judging),
                **({"mirrors": outcome.mirrors} if isinstance(outcome, Levels) else {}),
            }
            if isinstance(outcome, Targets):
                content[outcome.name] = {s: _recognised(one, outcome) for s, one in outcome.results.items()}
                content[f"{outcome.name}_means"] = outcome.means
            elif isinstance(outcome, Preferences):
                content[outcome.name] = outcome.results
            elif outcome.mirrors is None:
                content[outcome.name] = {
                    name: _compared(one, outcome) for name, one in outcome.results.items()
                }
        for outcome in self.findings.outcomes.values():
            if isinstance(outcome, Levels) and outcome.mirrors:
                for principle, one in outcome.results.items():
                    mirrored = {"student": t_json(one.student, one.verdict), "verdict": asdict(one.verdict)}
                    content[outcome.name].setdefault(principle, {}).setdefault("mirrors", {})[
                        outcome.hypothesis
                    ] = mirrored
        content["further"] = self._further()
        content["answering"] = {"pace": self.pace, "varieties": self.varieties}
        content["described"] = [*described(self.findings)]
        strictly: Json = strict(content)
        return strictly

    @cached_property
    def pace(self) -> Pace | None:
        """How fast the participants analysed answered."""
        return pace(self.findings.responses)

    @cached_property
    def varieties(self) -> tuple[Variety, ...]:
        """How much the ratings of each of them differ."""
        return tuple(varieties(self.findings.responses))

    def _further(self) -> Json:
        """Further checks, by name of the results; without exclusions only where somebody was left out."""
        further, outcomes = self.further, self.findings.outcomes
        content: Json = {"scales": further.scales, "bootstrap_seed": SEED}
        for name in (*further.targets, *further.levels):
            part: Json = content.setdefault(outcomes[name].name, {})
            part["tests"] = further.targets.get(name) or further.levels[name]
            beside: tuple[tuple[str, Mapping[str, Any]], ...] = (
                ("crossed", further.crossed),
                ("agreement", further.agreement),
                ("order", further.order),
            )
            part |= {key: found[name] for key, found in beside if name in found}
            if name in further.confusions:
                stimuli, items = outcomes[name].answers.stimuli, outcomes[name].answers.items
                part["highest_rated"] = {
                    ties: {
                        s: dict(zip(items, row, strict=True)) for s, row in zip(stimuli, counts, strict=True)
                    }
                    for ties, counts in further.confusions[name].items()
                }
        for outcome in outcomes.values():
            if without := [*relaxed(outcome)]:
                content[outcome.name]["without_assumptions"] = without
        content["before_exclusions"] = {
            name: {key: one.verdict for key, one in outcome.results.items()}
            for name, outcome in further.before.items()
        }
        return content

    def write(self, path: Path) -> None:
        """Write results.json."""
        text = json.dumps(self.as_json(), indent=1, ensure_ascii=False, allow_nan=False)
        path.write_text(text + "\n", encoding="utf-8")


def strict(value: Any) -> Any:
    """A value in terms of JSON: dataclasses as objects, and never a number that is not finite."""
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: strict(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): strict(item) for key, item in value.items()}
    if isinstance(value, str) or value is None or isinstance(value, bool):
        return value
    if isinstance(value, Sequence):
        return [strict(item) for item in value]
    number = value.item() if isinstance(value, np.generic) else value
    assert isfinite(number), "undefined numbers are None with a reason"
    return number


def t_json(result: TTest, verdict: Verdict | None = None) -> Json:
    """A t-test by its fields, with the adjusted p where this test was the one that decided."""
    content: Json = {
        "method": result.method.name,
        "n": result.n[0] if len(result.n) == 1 else result.n,
        "estimate": result.estimate,
        "ci95": result.ci95,
        "null": result.null,
        "t": result.t,
        "df": result.df,
        "p": result.p,
        "p_adjusted": None if verdict is None or result.p is None else verdict.p_adjusted,
        "alternative": result.alternative,
        "d": result.d,
        "d_ci95": result.d_ci95,
        "g": result.g,
        "g_ci95": result.g_ci95,
        "standardiser": result.method.standardiser,
    }
    return content if result.reason is None else content | {"reason": result.reason}


def _summary(summary: Moments) -> Json:
    content: Json = asdict(summary)
    return content if summary.se is not None else content | {"reason": f"undefined: n = {summary.n}"}


def _recognised(one: Recognised, outcome: Targets) -> Json:
    return {
        "item": one.item,
        **_summary(one.summary),
        "chance": {
            "definition": outcome.chance,
            "id": one.against.definition.id,
            "value": one.against.null,
            "estimated": one.against.estimated,
        },
        "t_test": _against(one.against, one.verdict),
        "wilcoxon": one.wilcoxon,
        "exact": one.against.exact,
        "verdict": one.verdict,
        "sensitivity": {
            name: {
                "id": DEFINITIONS[name].id,
                "value": other.null,
                "estimated": other.estimated,
                **_against(other, verdict),
                "p_adjusted": verdict.p_adjusted,
                "decided_by": verdict.test,
                "significant": verdict.significant,
            }
            for name, other in one.sensitivity.items()
            for verdict in [one.sensitivity_verdicts[name]]
        },
        "depends_on_definition": one.depends_on_definition,
    }


def _against(result: AgainstChance, verdict: Verdict) -> Json:
    if isinstance(result.test, TTest):
        return t_json(result.test, None if verdict.by else verdict)
    exact = {"hits": result.test.k, "p": result.test.p, "p_adjusted": verdict.p_adjusted}
    return t_json(result.t_test) | exact


def _compared(one: Compared, outcome: Levels) -> Json:
    content: Json = {
        "summaries": {level: _summary(summary) for level, summary in one.summaries.items()},
        "student": t_json(one.student, one.verdict if one.verdict.test == "independent t" else None),
        "welch": t_json(one.welch),
        "paired": t_json(one.paired, one.verdict if one.verdict.test == "paired t" else None)
        | {"d_av": one.d_av},
        "wilcoxon": one.wilcoxon,
        "sign_flip": one.sign_flip,
        "verdict": one.verdict,
    }
    if (choices := one.choices) is None:
        return content
    shares = {
        level: None if sum(counts) == 0 else [count / sum(counts) for count in counts]
        for level, counts in choices.counts.items()
    }
    names = (outcome.comparison.outcome, outcome.comparison.other)
    return {
        "counts": {level: dict(zip(names, counts, strict=True)) for level, counts in choices.counts.items()},
        "proportions": {
            level: dict.fromkeys(names) | {"reason": "no answers"}
            if share is None
            else dict(zip(names, share, strict=True))
            for level, share in shares.items()
        },
        **content,
        "mcnemar": choices.mcnemar,
        "fisher": choices.fisher,
        "binomial": choices.binomial,
        "difference": choices.difference,
    }
