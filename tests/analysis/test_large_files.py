import tracemalloc
from pathlib import Path

import pytest

from analysis import fields
from analysis.dataset import read_responses
from analysis.plan import carry_out
from study.protocol import Protocol
from tests.benchmarks.large_responses import write_responses

BYTES_A_ROW = 50  # five million rows stay within 250 MB and what Python itself takes


def test_another_answer_takes_no_more_than_fifty_bytes(
    paper: Protocol, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fields, "BLOCK", 1 << 16)
    path = tmp_path / "r.csv"

    def peak(participants: int) -> tuple[int, int]:
        rows = write_responses(path, participants)
        tracemalloc.start()
        carry_out(read_responses(path, paper), paper)
        held = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return rows, held

    (few, little), (many, much) = peak(2000), peak(3000)
    assert (much - little) / (many - few) < BYTES_A_ROW
