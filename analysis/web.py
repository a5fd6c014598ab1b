"""The report as one HTML page that needs nothing else."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from analysis import apa
from analysis.description import described
from analysis.drawing import Drawing
from analysis.further import SEED
from analysis.glossary import GLOSSARY
from analysis.plan import Levels, Preferences, Targets
from analysis.results import Results
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

TEMPLATES = Path(__file__).parent / "templates"


def html(
    results: Results, protocol: Protocol, drawings: Mapping[str, Drawing], pictures: Mapping[str, str]
) -> str:
    """The report: the main story first, further checks folded, every column with its definition on hover.

    `pictures` are the drawings as SVG, by name.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    findings = results.findings
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"inline_svg": _inline_svg, "fixed": apa.number, "unbroken": apa.unbroken}
    outcomes = findings.outcomes
    return environment.get_template("report.html").render(
        title=protocol.title.in_("en"),
        css=Markup((TEMPLATES / "report.css").read_text(encoding="utf-8")),
        provenance=results.provenance,
        bootstrap_seed=SEED,
        findings=findings,
        further=results.further,
        described=[*described(findings)],
        pace=results.pace,
        varieties=results.varieties,
        note=findings.responses.note,
        alpha=findings.alpha,
        labels=labels_of(protocol),
        apa=apa,
        glossary=GLOSSARY,
        threats=[*threats(protocol)],
        drawings=drawings,
        pictures=pictures,
        texts={name: claim(protocol, name, outcome) for name, outcome in outcomes.items()},
        targets=[outcome for outcome in outcomes.values() if isinstance(outcome, Targets)],
        preferences=[outcome for outcome in outcomes.values() if isinstance(outcome, Preferences)],
        levels=[outcome for outcome in outcomes.values() if isinstance(outcome, Levels)],
        methods={name: method(outcome) for name, outcome in outcomes.items()},
        assumptions={name: assumptions(outcome) for name, outcome in outcomes.items()},
        missing=MISSING,
        left_out=left_out(results.further, findings),
        sentences={name: sentences(outcome) for name, outcome in outcomes.items()},
        summary=[summary(name, outcome) for name, outcome in outcomes.items()],
        warnings=warnings(findings),
        changed=[*results.further.changed(findings)],
    )


def _inline_svg(svg: str) -> Any:
    """An SVG as it can stand within HTML: without its prolog."""
    from markupsafe import Markup

    return Markup(re.sub(r"^.*?(?=<svg)", "", svg, count=1, flags=re.DOTALL))
