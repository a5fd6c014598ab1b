"""Every statistic against R: on complete data, with holes, ties and constants, and after exclusions."""

from __future__ import annotations

import json

import pytest

from tests.analysis.statistics.reference import DATA, FOLDER, ITERATED, REFERENCES, Reference, read

NUMBERS = json.loads((FOLDER / "r.json").read_text(encoding="utf-8"))
TABLES = {name: read(name) for name in DATA}


@pytest.mark.parametrize("data", DATA)
@pytest.mark.parametrize("reference", REFERENCES, ids=lambda reference: reference.r[:60])
def test_the_number_is_that_of_r(reference: Reference, data: str) -> None:
    theirs, ours = NUMBERS[data][reference.r], reference.ours(TABLES[data])
    if theirs is None:
        assert ours is None  # R refuses to answer, and so do we
    else:
        assert ours is not None
        near_zero = reference.tolerance if reference.tolerance == ITERATED else 1e-12
        assert list(ours) == pytest.approx(theirs, rel=reference.tolerance, abs=near_zero)


def test_every_number_is_asked_for_and_every_question_answered() -> None:
    asked = [reference.r for reference in REFERENCES]
    assert len(set(asked)) == len(asked)
    assert all(list(NUMBERS[data]) == asked for data in DATA)
