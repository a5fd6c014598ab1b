"""The methods draft carries the protocol's own numbers, in words one could print."""

import re
import subprocess
from pathlib import Path

import pytest

from study.methods import methods, methods_latex
from study.protocol import load_protocol

PROTOCOLS = Path(__file__).parents[2] / "protocols"
PAPER = load_protocol(PROTOCOLS / "hielscher2025")


def test_the_draft_says_what_was_done():
    draft = methods(PAPER)
    for said in (
        "two gestures (explain and wave) for the robot Pepper. Each was learned",
        "and modulated by ",
        "Secondary Action",
        f"which gave {len(PAPER.stimuli)} stimuli",
        f"planned for {PAPER.participants.planned} participants",
        f"saw {PAPER.length[0]} videos in about {PAPER.length[1]} minutes, in two parts",
        "12 videos were judged, each after its reference",
        "on 5 points from not at all (1) to very strongly (5)",
        "one-sample t-test (one-sided, greater) of the ratings on the target item against 3, the middle",
        "Holm correction over six tests",
        PAPER.sha256[:16],
    ):
        assert said in draft


@pytest.mark.parametrize("path", sorted(PROTOCOLS.glob("*/protocol.yaml")), ids=lambda path: path.parent.name)
def test_no_draft_repeats_itself_or_counts_one_as_many(path):
    draft = methods(load_protocol(path))
    for wrong in (r"\b(1|one) (videos|minutes|parts|were)", r" \.", r"\.\.", "  ", "None", "Left out: "):
        assert not re.search(wrong, draft), wrong
    sentences = draft.split(". ")
    assert len(sentences) == len(set(sentences))


def test_who_is_left_out_is_one_sentence():
    draft = methods(load_protocol(PROTOCOLS / "online"))
    assert (
        "we left out participants with an unfinished session, a median time per answer below 0.8 s or "
        "2 or more failed attention checks" in draft
    )


@pytest.mark.parametrize("name", ["hielscher2025", "online"])
def test_the_draft_compiles_as_latex(name, tmp_path):
    draft = methods_latex(load_protocol(PROTOCOLS / name))
    assert r"\section{Methods (draft)}" in draft and r"\subsection{Stimuli}" in draft
    (tmp_path / "draft.tex").write_text(
        f"\\documentclass{{article}}\n\\begin{{document}}\n{draft}\n\\end{{document}}\n", encoding="utf-8"
    )
    done = subprocess.run(
        ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "draft.tex"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]


def test_what_latex_would_take_for_a_command_stands_as_itself(tmp_path):
    text = (PROTOCOLS / "template" / "protocol.yaml").read_text(encoding="utf-8")
    text = text.replace('"Anything you noticed?"', '"50 % of {x} & \\\\cost^2 ~ $5_#?"')
    (tmp_path / "protocol.yaml").write_text(text, encoding="utf-8")
    draft = methods_latex(load_protocol(tmp_path))
    assert r"50 \% of \{x\} \& \textbackslash{}cost\textasciicircum{}2 \textasciitilde{} \$5\_\#?" in draft
