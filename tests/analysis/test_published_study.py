"""From the published counts to the published table, and to what its t-tests must have been."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from analysis.paper import check_paper
from analysis.published import HIGHER, N, Verification
from analysis.report import analyse
from analysis.results import Results
from analysis.web import html
from study.protocol import Protocol
from tests.analysis.conftest import PAPER, choices, ratings

PRINTED = {  # the paper's Table II, in hundredths: high ↑, high ↓, low ↑, low ↓ (Arc/low ↑ mended)
    "arc": (94, 6, 0, 100),
    "ant": (79, 21, 26, 74),
    "time": (100, 0, 0, 100),
    "exa": (100, 0, 0, 100),
    "sec": (94, 6, 3, 97),
    "follow": (56, 44, 29, 71),
}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory, paper: Protocol) -> tuple[Results, Path]:
    folder = tmp_path_factory.mktemp("published")
    responses = folder / "responses.csv"
    rows = [("participant", "stimulus", "item", "response"), *ratings(), *choices()]
    responses.write_text("".join(",".join(row) + "\n" for row in rows), encoding="utf-8")
    return analyse(responses, paper, folder / "out"), folder / "out"


@pytest.fixture(scope="module")
def written(study: tuple[Results, Path]) -> dict:
    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    return json.loads((study[1] / "results.json").read_text(encoding="utf-8"), parse_constant=refuse)


def test_the_published_proportions_are_printed(written: dict) -> None:
    for principle, hundredths in PRINTED.items():
        shares = written["intensity"][principle]["proportions"]
        found = [shares[level][answer] for level in ("high", "low") for answer in ("higher", "lower")]
        assert tuple(round(100 * share) for share in found) == hundredths


def test_follow_through_is_the_published_t_test(written: dict) -> None:
    student = written["intensity"]["follow"]["student"]
    assert (student["t"], student["df"]) == (pytest.approx(2.256419413900831561), 66)
    assert student["p"] == pytest.approx(0.013681101791085880)
    assert student["alternative"] == "greater"
    assert written["intensity"]["follow"]["binomial"]["high"]["p"] == pytest.approx(0.30379568063653994)


@pytest.mark.parametrize("principle", ["time", "exa"])
def test_complete_separation_has_no_t_but_an_exact_probability(written: dict, principle: str) -> None:
    found = written["intensity"][principle]
    for test in ("student", "welch"):
        assert (found[test]["t"], found[test]["p"], found[test]["d"]) == (None, None, None)
        assert found[test]["reason"] == "undefined: zero variance in both groups"
    assert found["counts"] == {"high": {"higher": 34, "lower": 0}, "low": {"higher": 0, "lower": 34}}
    assert found["fisher"]["p"] == pytest.approx(3.5145627607867045e-20)
    assert found["mcnemar"]["p_one_sided"] == pytest.approx(2.0**-34)
    assert found["verdict"]["test"] == "Fisher's exact"
    assert 0 < found["verdict"]["p_adjusted"] < 1e-18


def test_every_principle_supports_the_hypothesis_and_its_mirror_gives_the_same_test(written: dict) -> None:
    for found in written["intensity"].values():
        assert found["verdict"]["significant"]
        mirrored = found["mirrors"]["H2.2"]["student"]
        assert mirrored["p"] == (found["student"]["p"] and pytest.approx(found["student"]["p"]))


def test_every_emotion_is_tested_against_the_midpoint_with_all_definitions_beside_it(written: dict) -> None:
    assert len(written["recognition"]) == 6
    for emotion, found in written["recognition"].items():
        assert (found["item"], found["n"], found["t_test"]["df"]) == (emotion, 34, 33)
        assert found["chance"] == {"definition": "midpoint", "id": "A", "value": 3.0, "estimated": False}
        assert sorted(one["id"] for one in found["sensitivity"].values()) == [
            "A",
            "B",
            "C",
            "D",
            "E1",
            "E2",
            "F",
            "G",
        ]
        assert found["sensitivity"]["midpoint"]["p_adjusted"] == found["t_test"]["p_adjusted"]


def test_the_latex_table_has_the_published_cells(study: tuple[Results, Path]) -> None:
    lines = (study[1] / "tables" / "intensity.tex").read_text(encoding="utf-8").splitlines()
    for place, level in enumerate(("high", "low")):
        row = next(line for line in lines if line.strip().startswith(level))
        cells = [
            cell.strip(" $\\{}").split("{")[-1].split()[-1]
            for cell in row.removesuffix("\\\\").split("&")[1:]
        ]
        printed = [h for cells in PRINTED.values() for h in cells[2 * place : 2 * place + 2]]
        assert [round(100 * float(cell)) for cell in cells] == printed
    assert "N~=~34 per cell" in "".join(lines)


def test_the_report_stands_alone(study: tuple[Results, Path]) -> None:
    report = (study[1] / "report.html").read_text(encoding="utf-8").replace("\u00a0", " ")
    assert "undefined: zero variance in both groups" in report
    assert "t(66) = 2.26, p = .014, one-sided" in report
    for outside in ('src="http', 'href="http', "<script", "@import"):
        assert outside not in report


def test_what_is_defined_on_hover_is_defined_below_too(study: tuple[Results, Path]) -> None:
    report = (study[1] / "report.html").read_text(encoding="utf-8")
    on_hover = set(re.findall(r'<abbr title="([^"]+)"', report))
    below = report[report.index('id="definitions"') :]
    assert len(on_hover) > 20
    assert all(f"<dd>{text}</dd>" in below for text in on_hover)


def test_the_time_of_the_analysis_is_there_only_where_it_was_said(
    study: tuple[Results, Path], paper: Protocol
) -> None:
    results, out = study
    report = (out / "report.html").read_text(encoding="utf-8")
    assert "when is not in the file" in report and "<dt>Analysed</dt>" not in report
    provenance = replace(results.provenance, analysed="2026-11-22T10:00")
    timed = replace(results, provenance=provenance)
    assert "<dt>Analysed</dt><dd>2026-11-22T10:00</dd>" in html(timed, paper, {}, {})
    assert (results.as_json()["analysed_at"], timed.as_json()["analysed_at"]) == (None, "2026-11-22T10:00")


def test_equal_responses_give_equal_bytes_and_mujoco_is_not_needed(
    study: tuple[Results, Path], tmp_path: Path
) -> None:
    program = (
        "import sys; sys.modules['mujoco'] = None\n"
        "from pathlib import Path\n"
        "from analysis.report import analyse\n"
        "from study.protocol import load_protocol\n"
        f"analyse(Path({str(study[0].findings.responses.path)!r}), load_protocol(Path({str(PAPER)!r})), "
        "Path(sys.argv[1]))\n"
    )
    once, again = tmp_path / "once", tmp_path / "again"
    runs = [subprocess.Popen([sys.executable, "-c", program, str(out)]) for out in (once, again)]
    assert [run.wait(timeout=300) for run in runs] == [0, 0]
    files = sorted(path.relative_to(once) for path in once.rglob("*") if path.is_file())
    assert {"results.json", "report.html", "report.pdf"} < {str(file) for file in files}
    assert len(files) >= 20
    for file in files:
        assert (once / file).read_bytes() == (again / file).read_bytes(), file
    assert (once / "results.json").read_bytes() == (study[1] / "results.json").read_bytes()


@pytest.mark.parametrize("name", ["intensity", "recognition"])
def test_the_latex_tables_compile_and_fit_a_column(
    study: tuple[Results, Path], tmp_path: Path, name: str
) -> None:
    table = (study[1] / "tables" / f"{name}.tex").read_text(encoding="utf-8")
    packages = next(line for line in table.splitlines() if line.startswith("% packages: "))
    paper = tmp_path / "paper.tex"
    paper.write_text(
        "\\documentclass{article}\n"
        f"\\usepackage{{{packages.removeprefix('% packages: ').replace(' ', '')}}}\n"
        "\\setlength{\\textwidth}{252pt}\n"
        f"\\begin{{document}}\n{table}\\end{{document}}\n",
        encoding="utf-8",
    )
    done = subprocess.run(
        ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", paper.name],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]
    assert "Overfull" not in done.stdout


def test_the_latex_table_passes_its_own_check(study: tuple[Results, Path]) -> None:
    found = check_paper(study[1] / "tables" / "intensity.tex", N)
    ((_, table),) = found.tables
    assert isinstance(table, Verification) and table.cells == 24 and not found.faults
    assert {one.name: one.counts and one.counts[0][0] for one in table.recomputed} == {
        f"P_{name.capitalize()}": counts["high"] for name, counts in HIGHER.items()
    }


def test_the_pages_hold_the_main_story(study: tuple[Results, Path]) -> None:
    pages = (study[1] / "report.pdf").read_bytes()
    assert pages.startswith(b"%PDF") and 3 <= pages.count(b"/Type /Page ") <= 8


def test_further_checks_are_in_the_results(written: dict) -> None:
    further = written["further"]
    assert written["data"] == "participant"
    assert set(further["recognition"]["tests"]["joy"]) == {
        "mean_ci95", "friedman", "permutation", "ordinal", "bayes", "equivalence", "hits"
    }  # fmt: skip
    assert sum(further["recognition"]["highest_rated"]["share"]["joy"].values()) == pytest.approx(34)
    follow = further["intensity"]["tests"]["follow"]
    assert follow["gee"]["effect"] == pytest.approx(1.1118575154181303)  # ln(19/15 · 24/10)
    time = further["intensity"]["tests"]["time"]
    assert time["gee"]["reason"] == "undefined: complete separation in a condition"
