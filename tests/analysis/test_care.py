"""How fast participants answered, and how much their own answers differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analysis.care import pace, varieties
from analysis.dataset import read_responses
from study.protocol import Protocol
from tests.analysis.conftest import Write, ratings


def test_a_participant_who_always_answers_the_same_has_no_spread(paper: Protocol, write: Write) -> None:
    rows = [(who, clip, item, "3" if who == "P01" else given) for who, clip, item, given in ratings(n=5)]
    (found,) = varieties(read_responses(write(rows), paper))
    own = [np.std([int(given) for who, *_, given in rows if who == f"P{p:02}"], ddof=1) for p in range(5)]
    assert (found.part, found.one_answer, found.sd.n, found.sd.least) == ("recognition", 1, 5, 0)
    assert (found.sd.median, found.sd.most) == pytest.approx((np.median(own), max(own)))


def test_nobody_is_lost_among_the_paces(paper: Protocol, write: Write) -> None:
    responses = read_responses(write(ratings(n=5)), paper)
    assert pace(responses) is None
    seconds = np.array([0.5, 2, np.nan, 8, 1])
    found = pace(replace(responses, median_rt_s=seconds))
    assert found is not None and sum(found.participants) == found.seconds.n == 4
    assert (found.seconds.least, found.seconds.median, found.seconds.most) == (0.5, 1.5, 8)
    assert found.participants[0] == found.participants[-1] == 1
    assert pace(replace(responses, median_rt_s=np.zeros(5))) is not None
