"""From a file of responses to results.json, tables, figures and a report to read."""

from __future__ import annotations

import gc
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import TYPE_CHECKING

from analysis.alongside import alongside
from analysis.dataset import Responses, read_responses
from analysis.drawing import Drawing, styled
from analysis.figures import draw_compared, draw_levels, draw_targets
from analysis.further import look_further
from analysis.overview import draw_flow, draw_forest
from analysis.plan import Findings, Preferences, Targets, carry_out
from analysis.preferred import draw_preferences, preferred_csv, preferred_latex
from analysis.printed import write_pdf
from analysis.results import Provenance, Results
from analysis.tables import (
    compared_csv,
    compared_latex,
    confusion_csv,
    confusion_latex,
    means_csv,
    targets_csv,
    targets_latex,
)
from analysis.versions import of_one_study
from analysis.web import html
from analysis.words import labels_of
from stimuli.whole_files import all_or_none

if TYPE_CHECKING:
    from study.protocol import Protocol

PACKAGES = ("expressive-motion-study", "numpy", "scipy", "pandas", "matplotlib")


@contextmanager
def _garbage_kept() -> Iterator[None]:
    """Look for no garbage meanwhile: nearly all of a report's many objects last till its end."""
    looked = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if looked:
            gc.enable()


@_garbage_kept()
def analyse(
    csv: Path,
    protocol: Protocol,
    out: Path,
    columns: Mapping[str, str] | None = None,
    *,
    analysed: str | None = None,
) -> Results:
    """Analyse responses as the protocol says and write everything into the folder `out`.

    Writes results.json, report.html, report.pdf, tables/ (LaTeX and CSV) and figures/ (SVG, PDF, PNG), all
    of them or, where the run is ended or the disk is full, none. Equal input gives equal bytes, so the time
    of the analysis is in them only where `analysed` says it. `columns` says where the file calls a column
    otherwise. Raises ResponsesError where the file cannot be read without guessing, PlanError where the plan
    does not fit the study.
    """
    with of_one_study(csv, protocol) as earlier:
        responses = replace(read_responses(csv, protocol, columns), earlier=earlier)
    findings = carry_out(responses, protocol)
    provenance = Provenance(
        study=protocol.study,
        protocol_sha256=protocol.sha256,
        responses_sha256=responses.sha256,
        software={"Python": python_version()} | {package: version(package) for package in PACKAGES},
        seed=protocol.seed,
        answered=responses.answered,
        analysed=analysed,
    )
    with all_or_none(out) as folder:
        return _write(folder, findings, provenance, responses, protocol)


def _write(
    out: Path, findings: Findings, provenance: Provenance, responses: Responses, protocol: Protocol
) -> Results:
    """Look further, and write every file of the report into an empty folder."""
    import matplotlib.backends.backend_pdf  # noqa: F401  once for both processes below

    drawings = draw(findings, labels_of(protocol))
    figures = out / "figures"
    for folder in (out / "tables", figures):
        folder.mkdir()

    def write_figures() -> None:
        for drawing in drawings.values():
            drawing.write(figures)

    with alongside(write_figures):
        results = Results(findings, provenance, look_further(findings, responses, protocol))
        results.write(out / "results.json")
        for name, text in tables(findings).items():
            (out / "tables" / name).write_text(text, encoding="utf-8", newline="")
        write_pdf(out / "report.pdf", results, protocol, drawings)
    pictures = {file.stem: file.read_text(encoding="utf-8") for file in figures.glob("*.svg")}
    (out / "report.html").write_text(html(results, protocol, drawings, pictures), encoding="utf-8")
    return results


def tables(findings: Findings) -> dict[str, str]:
    """The tables by file name."""
    written = {}
    note = findings.responses.note
    for outcome in findings.outcomes.values():
        if isinstance(outcome, Targets):
            written[f"{outcome.name}.tex"] = targets_latex(outcome, note)
            written[f"{outcome.name}.csv"] = targets_csv(outcome, note)
            written[f"{outcome.name}_means.csv"] = means_csv(outcome, note)
        elif isinstance(outcome, Preferences):
            written[f"{outcome.name}.tex"] = preferred_latex(outcome, note)
            written[f"{outcome.name}.csv"] = preferred_csv(outcome, note)
        elif outcome.mirrors is None and outcome.comparison.outcome is not None:
            written[f"{outcome.name}.tex"] = confusion_latex(outcome, note)
            written[f"{outcome.name}.csv"] = confusion_csv(outcome, note)
        elif outcome.mirrors is None:
            written[f"{outcome.name}.tex"] = compared_latex(outcome, note)
            written[f"{outcome.name}.csv"] = compared_csv(outcome, note)
    return written


@styled
def draw(findings: Findings, labels: Mapping[str, str]) -> dict[str, Drawing]:
    """The flow of participants, the figure of each hypothesis, and the sizes of all effects, by file name."""
    drawings = [draw_flow(findings.flow)]
    for outcome in findings.outcomes.values():
        if isinstance(outcome, Targets):
            drawings.append(draw_targets(outcome, labels))
        elif isinstance(outcome, Preferences):
            drawings.append(draw_preferences(outcome, labels))
        elif outcome.mirrors is None:
            draw_one = draw_compared if outcome.comparison.outcome is None else draw_levels
            drawings.append(draw_one(outcome, labels))
    if (forest := draw_forest(findings, labels)) is not None:
        drawings.append(forest)
    return {drawing.name: drawing.noting(findings.responses.note) for drawing in drawings}
