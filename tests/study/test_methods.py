"""The methods draft carries the protocol's own numbers."""

from pathlib import Path

from study.methods import methods, methods_latex
from study.protocol import load_protocol

PAPER = load_protocol(Path(__file__).parents[2] / "protocols" / "hielscher2025")


def test_the_draft_says_what_was_done():
    draft = methods(PAPER)
    for said in (
        "two gestures (explain, wave)",
        f"which gave {len(PAPER.stimuli)} stimuli",
        f"planned for {PAPER.participants.planned} participants",
        f"saw {PAPER.length[0]} videos in about {PAPER.length[1]} minutes in two parts",
        "12 videos were judged, each after its reference",
        "five options from “not at all” to “very strongly”",
        "one-sample t, alternative greater, Holm-corrected",
        PAPER.sha256[:16],
    ):
        assert said in draft


def test_the_draft_in_latex_has_nothing_that_latex_would_trip_over():
    draft = methods_latex(PAPER)
    assert r"\section{Methods (draft)}" in draft and r"\subsection{Stimuli}" in draft
    assert r"\emph{recognition}" in draft
    assert "``not at all'' to ``very strongly''" in draft
    assert not set("#“”…*") & set(draft.replace(r"\#", ""))
    assert draft.count("{") == draft.count("}")
