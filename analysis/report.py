"""From a file of responses to results.json, tables, figures and a report to read."""

from __future__ import annotations

import re
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import TYPE_CHECKING, Any

from analysis import apa
from analysis.dataset import read_responses
from analysis.figures import Drawing, draw_levels, draw_targets
from analysis.glossary import GLOSSARY, THREATS
from analysis.plan import Findings, Levels, Outcome, Targets, carry_out
from analysis.results import Provenance, Results
from analysis.tables import confusion_csv, confusion_latex, means_csv, targets_csv, targets_latex

if TYPE_CHECKING:
    from study.protocol import Protocol

PACKAGES = ("expressive-motion-study", "numpy", "scipy", "pandas", "matplotlib")
TEMPLATES = Path(__file__).parent / "templates"


def analyse(csv: Path, protocol: Protocol, out: Path) -> Results:
    """Analyse responses as the protocol says and write everything into the folder `out`.

    Writes results.json, report.html, tables/ (LaTeX and CSV) and figures/ (SVG, PDF, PNG). Equal input gives
    equal bytes. Raises ResponsesError where the file cannot be read without guessing, PlanError where the
    plan does not fit the study.
    """
    responses = read_responses(csv, protocol)
    findings = carry_out(responses, protocol)
    provenance = Provenance(
        study=protocol.study,
        protocol_sha256=protocol.sha256,
        responses_sha256=responses.sha256,
        software={"Python": python_version()} | {package: version(package) for package in PACKAGES},
    )
    results = Results(findings=findings, provenance=provenance)
    labels = _labels(protocol)
    drawings = draw(findings, labels)
    for folder in (out, out / "tables", out / "figures"):
        folder.mkdir(parents=True, exist_ok=True)
    results.write(out / "results.json")
    for name, text in tables(findings).items():
        (out / "tables" / name).write_text(text, encoding="utf-8", newline="")
    for drawing in drawings.values():
        drawing.write(out / "figures")
    (out / "report.html").write_text(html(results, protocol, drawings, labels), encoding="utf-8")
    return results


def tables(findings: Findings) -> dict[str, str]:
    """The tables by file name."""
    written = {}
    for outcome in findings.outcomes.values():
        if isinstance(outcome, Targets):
            written[f"{outcome.part}.tex"] = targets_latex(outcome)
            written[f"{outcome.part}.csv"] = targets_csv(outcome)
            written[f"{outcome.part}_means.csv"] = means_csv(outcome)
        elif outcome.mirrors is None and outcome.comparison.outcome is not None:
            written[f"{outcome.part}.tex"] = confusion_latex(outcome)
            written[f"{outcome.part}.csv"] = confusion_csv(outcome)
    return written


def draw(findings: Findings, labels: dict[str, str]) -> dict[str, Drawing]:
    """The figure of each hypothesis that has one."""
    drawings = {}
    for name, outcome in findings.outcomes.items():
        if isinstance(outcome, Targets):
            drawings[name] = draw_targets(outcome, labels)
        elif outcome.mirrors is None and outcome.comparison.outcome is not None:
            drawings[name] = draw_levels(outcome, labels)
    return drawings


def html(results: Results, protocol: Protocol, drawings: dict[str, Drawing], labels: dict[str, str]) -> str:
    """The report as one HTML page that needs nothing else."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    findings = results.findings
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"inline_svg": _inline_svg, "fixed": apa.number}
    from markupsafe import Markup

    return environment.get_template("report.html").render(
        title=protocol.title.in_("en"),
        css=Markup((TEMPLATES / "report.css").read_text(encoding="utf-8")),
        provenance=results.provenance,
        findings=findings,
        alpha=findings.alpha,
        labels=labels,
        apa=apa,
        glossary=GLOSSARY,
        threats=THREATS,
        drawings=drawings,
        texts={name: _text(protocol, name, outcome) for name, outcome in findings.outcomes.items()},
        targets=[outcome for outcome in findings.outcomes.values() if isinstance(outcome, Targets)],
        levels=[outcome for outcome in findings.outcomes.values() if isinstance(outcome, Levels)],
        sentences={name: sentences(outcome) for name, outcome in findings.outcomes.items()},
        summary=[_summary(name, outcome) for name, outcome in findings.outcomes.items()],
        warnings=[*_warnings(findings)],
        differs=_differs,
    )


def sentences(outcome: Outcome) -> dict[str, str]:
    """The test of each stimulus or principle as a sentence for a paper."""
    judging = outcome.judging
    tests: dict[str, Any] = (
        {name: (one.against.t_test, one.verdict) for name, one in outcome.results.items()}
        if isinstance(outcome, Targets)
        else {name: (one.student, one.verdict) for name, one in outcome.results.items()}
    )
    return {
        name: apa.t_sentence(
            test,
            verdict.p_adjusted if verdict.note is None else None,
            judging.alpha,
            judging.adjustment,
        )
        + (
            ""
            if verdict.note is None
            else f"; {verdict.test} p {apa.probability(verdict.p, judging.alpha)}, {judging.sides}"
        )
        for name, (test, verdict) in tests.items()
    }


def _summary(name: str, outcome: Outcome) -> str:
    """What was found, in one line."""
    found = [key for key, one in outcome.results.items() if one.verdict.significant]
    what = "rated above chance" if isinstance(outcome, Targets) else "told apart as expected"
    n, of = len(found), len(outcome.results)
    missed = [key for key in outcome.results if key not in found]
    but = f"; not {', '.join(missed)}" if missed and found else ""
    mirrors = outcome.mirrors if isinstance(outcome, Levels) else None
    mirror = f" (the mirror image of {mirrors}, not counted again)" if mirrors else ""
    alpha = apa.bounded(outcome.judging.alpha)
    return f"{name}: {n} of {of} {what} (p {outcome.judging.adjustment}, α = {alpha}){but}{mirror}."


def _warnings(findings: Findings) -> list[str]:
    """What a reader must not miss."""
    said = []
    for name, outcome in findings.outcomes.items():
        if isinstance(outcome, Targets):
            if outcome.chance == "midpoint":
                said.append(
                    f"{name}: the chance level is the middle of the scale by assumption; agreeing with every "
                    "item would pass it. The table of definitions below shows what others say."
                )
            if depends := [key for key, one in outcome.results.items() if one.depends_on_definition]:
                said.append(
                    f"{name}: the decision depends on the definition of chance for {', '.join(depends)}."
                )
        if degenerate := ", ".join(key for key, one in outcome.results.items() if one.verdict.note):
            said.append(f"{name}: no t-test for {degenerate} (zero variance); an exact test decides.")
    return said


def _differs(outcome: Targets, definition: str) -> bool:
    return any(
        one.sensitivity_verdicts[definition].significant != one.verdict.significant
        for one in outcome.results.values()
    )


def _text(protocol: Protocol, name: str, outcome: Outcome) -> str:
    """The hypothesis in words: the protocol's, or what its test says."""
    written = protocol.analysis.hypotheses[name].text
    if written:
        return written
    if isinstance(outcome, Targets):
        return "the intended expression is seen"
    first, second = outcome.comparison.levels
    return f"{first} is told from {second}"


def _labels(protocol: Protocol) -> dict[str, str]:
    """English names of items, where the protocol has them."""
    return {
        item: text.in_("en")
        for part in protocol.parts.values()
        for question in part.questions
        for item, text in question.items.items()
        if len(question.items) > 1
    }


def _inline_svg(svg: str) -> Any:
    """An SVG as it can stand within HTML: without prolog, and with ids of its own."""
    from markupsafe import Markup

    return Markup(re.sub(r"^.*?(?=<svg)", "", svg, count=1, flags=re.DOTALL))
