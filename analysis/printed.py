"""What stands on the pages of report.pdf: the main story; the further checks are in report.html."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from analysis import apa
from analysis.drawing import ALARM, FAINT, Drawing
from analysis.further import SEED
from analysis.pages import Pages
from analysis.plan import Levels, Outcome, Targets
from analysis.results import Provenance, Results
from analysis.threats import threats
from analysis.words import (
    MISSING,
    assumptions,
    claim,
    labels_of,
    left_out,
    method,
    sentences,
    summary,
    warnings,
)

if TYPE_CHECKING:
    from study.protocol import Protocol

TARGET_HEAD = ("Clip", "N", "M", "SD", "t", "df", "p", "p adj.", "d [95% CI]")
LEVEL_HEAD = ("Principle", "shares", "t", "df", "p", "p adj.", "d [95% CI]", "McNemar p", "diff. [95% CI]")
RATING_HEAD = ("Rating", "means", "t", "df", "p", "p adj.", "d [95% CI]", "Wilcoxon p", "diff. [95% CI]")
GROUPS_HEAD = tuple("Welch p" if name == "Wilcoxon p" else name for name in RATING_HEAD)


def write_pdf(path: Path, results: Results, protocol: Protocol, drawings: Mapping[str, Drawing]) -> None:
    """Write the report's main story as A4 pages."""
    findings, labels = results.findings, labels_of(protocol)
    title = f"Results: {protocol.title.in_('en')}"
    hashed = results.provenance.responses_sha256[:12]
    with Pages(path, title, f"{protocol.study}, responses {hashed}", findings.responses.note) as pages:
        pages.heading(title, size=17)
        pages.write(f"Study {protocol.study}, N = {findings.flow.analysed} analysed.", colour=FAINT)
        for name, outcome in findings.outcomes.items():
            pages.write(summary(name, outcome), size=10)
        for warning in warnings(findings):
            pages.write(warning, colour=ALARM)
        pages.heading("Participants")
        pages.draw(drawings["participants"])
        pages.write(f"{MISSING} {left_out(results.further, findings)}")
        for name, outcome in findings.outcomes.items():
            pages.heading(f"{name}: {claim(protocol, name, outcome)}")
            _outcome(pages, outcome, drawings, labels)
        if "effects" in drawings:
            pages.heading("Effect sizes")
            pages.draw(drawings["effects"])
        pages.heading("What the design cannot tell")
        for threat in threats(protocol):
            pages.write(f"– {threat}")
        pages.heading("Where the numbers come from")
        for line in _provenance(results.provenance):
            pages.write(line, size=7.5)


def _outcome(
    pages: Pages, outcome: Outcome, drawings: Mapping[str, Drawing], labels: Mapping[str, str]
) -> None:
    mirrored = isinstance(outcome, Levels) and outcome.mirrors is not None
    pages.write(
        f"The same test as {outcome.mirrors} seen from the other side: printed, not counted again."
        if isinstance(outcome, Levels) and mirrored
        else f"{method(outcome)} {assumptions(outcome)}",
        with_next=True,
    )
    if not mirrored:
        pages.draw(drawings[outcome.name])
        if isinstance(outcome, Targets):
            pages.tabulate(TARGET_HEAD, _target_rows(outcome, labels))
            pages.write(
                f"By other definitions of chance, {outcome.judging.adjustment} p († another decision):",
                with_next=True,
            )
            pages.tabulate(*_definitions(outcome, labels))
        elif isinstance(outcome, Levels):
            ratings = RATING_HEAD if outcome.within else GROUPS_HEAD
            pages.tabulate(
                LEVEL_HEAD if outcome.comparison.outcome else ratings, _level_rows(outcome, labels)
            )
        if outcome.judging.test in {"wilcoxon", "mcnemar"}:  # beside t and its p
            pages.write(f"p adj. is by {outcome.judging.named}.")
    found = sentences(outcome)
    for place, (key, sentence) in enumerate(found.items(), start=2):
        last_but_one = place == len(found)  # the last does not stand alone on a page
        pages.write(f"{labels.get(key, key.capitalize())}: {sentence}.", size=8, with_next=last_but_one)


def _provenance(provenance: Provenance) -> Iterator[str]:
    yield f"Responses SHA-256 {provenance.responses_sha256}"
    answered = dict.fromkeys(provenance.answered or ())
    yield f"Answered {' to '.join(answered)}" if answered else "When was answered is not in the file"
    if provenance.analysed:
        yield f"Analysed {provenance.analysed}"
    yield f"Protocol SHA-256 {provenance.protocol_sha256}"
    yield f"Seeds {provenance.seed} of the study's orders, {SEED} of the bootstrap"
    yield ", ".join(f"{package} {version}" for package, version in provenance.software.items())


def _target_rows(outcome: Targets, labels: Mapping[str, str]) -> list[list[str]]:
    rows = []
    for key, one in outcome.results.items():
        test = one.against.t_test
        rows.append([
            labels.get(key, key.capitalize()), str(one.summary.n), apa.number(one.summary.mean),
            apa.number(one.summary.sd), apa.number(test.t), apa.degrees(test.df),
            _p(test.p, outcome), _p(one.verdict.p_adjusted, outcome),
            apa.estimate(test.d, test.d_ci95),
        ])  # fmt: skip
    return rows


def _definitions(outcome: Targets, labels: Mapping[str, str]) -> tuple[list[str], list[list[str]]]:
    results = outcome.results
    head = ["Definition", *(labels.get(key, key.capitalize()) for key in results)]
    rows = [
        [f"{other.definition.id}: {other.definition.says}"]
        + [
            "† " * (verdict.significant != one.verdict.significant) + _p(verdict.p_adjusted, outcome)
            for one in results.values()
            for verdict in [one.sensitivity_verdicts[name]]
        ]
        for name, other in next(iter(results.values())).sensitivity.items()
    ]
    return head, rows


def _level_rows(outcome: Levels, labels: Mapping[str, str]) -> list[list[str]]:
    rows = []
    for key, one in outcome.results.items():
        test, choices = one.deciding_t, one.choices
        beside = one.wilcoxon.p_decisive if outcome.within else one.welch.p
        counts = choices.counts.values() if choices else ()
        found = [apa.share(row[0], sum(row)) for row in counts] or [
            apa.number(m.mean) for m in one.summaries.values()
        ]
        rows.append([
            labels.get(key, key.capitalize()), " / ".join(found),
            apa.number(test.t), apa.degrees(test.df), _p(test.p, outcome),
            _p(one.verdict.p_adjusted, outcome), apa.estimate(test.d, test.d_ci95),
            _p(choices.mcnemar.p(outcome.judging.alternative) if choices else beside, outcome),
            apa.estimate(choices.difference.estimate, choices.difference.ci95)
            if choices else apa.estimate(test.estimate, test.ci95),
        ])  # fmt: skip
    return rows


def _p(value: float | None, outcome: Outcome) -> str:
    return "–" if value is None else apa.probability(value, outcome.judging.alpha).removeprefix("= ")
