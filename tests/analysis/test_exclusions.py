"""Rules of exclusion on the answers of a question, whoever saw which of its clips."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from analysis.answers import Answers
from analysis.dataset import Responses
from analysis.exclusions import apply_exclusions
from study.protocol import Exclusions

PEOPLE = ("flat", "varied", "nearly all left out", "spared")
FLAT, VARIED, ONE, NONE = [2, 2, 2], [1, 2, 2], [-1, 2, -1], [-1, -1, -1]


@pytest.mark.parametrize("clips", ["one clip", "another clip unseen", "a missing answer"])
def test_the_same_answer_throughout_counts_where_several_were_given(clips: str) -> None:
    codes = np.array([[FLAT], [VARIED], [ONE], [NONE]], dtype=np.int8)  # people, clips, items
    if clips == "another clip unseen":  # as between participants
        codes = np.concatenate([codes, np.full_like(codes, -1)], axis=1)
    if clips == "a missing answer":
        codes[0, 0, 0] = -1
    stimuli = tuple(f"s{place}" for place in range(codes.shape[1]))
    question = Answers("part", PEOPLE, stimuli, ("a", "b", "c"), tuple("12345"), codes, optional=True)
    rules = Exclusions(incomplete=False, straight_lining=True)
    _, flow = apply_exclusions(Responses(Path("r.csv"), "", PEOPLE, (question,)), rules)
    assert [one.participant for one in flow.excluded] == ["flat"]
