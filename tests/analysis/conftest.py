"""The paper's study, with responses made up so that their counts are the published ones."""

from __future__ import annotations

import csv
import random
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

from analysis.published import HIGHER, N
from study.protocol import Protocol, load_protocol

PAPER = Path(__file__).parents[2] / "protocols" / "hielscher2025"
EMOTIONS = ("joy", "sadness", "anger", "fear", "shame", "hurry")
Row = tuple[str, str, str, str]
Write = Callable[..., Path]


def ratings(n: int = N, seed: int = 1) -> list[Row]:
    """Ratings in which targets stand out."""
    rng = random.Random(seed)
    return [
        (f"P{p:02}", emotion, item, str(min(5, max(1, round(rng.gauss(4 if emotion == item else 2, 1))))))
        for p in range(n)
        for emotion in EMOTIONS
        for item in EMOTIONS
    ]


def choices(n: int = N) -> list[Row]:
    """The published counts, in an arbitrary pairing."""
    return [
        (f"P{p:02}", f"{principle}_{level}", "intensity", "higher" if p < k else "lower")
        for principle, counts in HIGHER.items()
        for level, k in counts.items()
        for p in range(n)
    ]


@pytest.fixture(scope="session")
def paper() -> Protocol:
    return load_protocol(PAPER)


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write rows as a responses file."""

    def write_rows(rows: Iterable[Row], name: str = "responses.csv") -> Path:
        path = tmp_path / name
        with path.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(("participant", "stimulus", "item", "response"))
            writer.writerows(rows)
        return path

    return write_rows
