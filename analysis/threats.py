"""What the design of a study cannot tell, said in its report."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from study.protocol import Protocol


def threats(protocol: Protocol) -> Iterator[str]:
    """Whatever of this study's design limits what its numbers mean."""
    parts = protocol.parts.values()
    if any(part.references for part in parts):
        yield "Each clip is judged right after its reference, so its contrast is part of every judgement."
    if any(question.kind == "choose" and len(question.values or ()) == 2
           for part in parts for question in part.questions):  # fmt: skip
        yield "The choice is forced: there is no answer “same”, so indifference looks like guessing."
    gestures = len({shown.gesture for part in protocol.parts for shown in protocol.stimuli_of(part)})
    shown = "One gesture was shown" if gestures == 1 else f"{gestures} gestures were shown"
    yield (
        f"{shown}. A gesture is one draw from all gestures; statistics alone do not carry the results "
        "over to others."
    )
    for change in protocol.amendments:
        amended = f"The protocol was amended on {change.date} ({change.reason.rstrip('.')})"
        yield f"{amended}; who took part before and after is analysed together."
    if any(hypothesis.of == "target" for hypothesis in protocol.analysis.hypotheses.values()):
        yield (
            "One question per judgement is a Likert item, not a scale; t-tests treat its points as equally "
            "spaced."
        )
