"""Power by simulation: the whole study taken and analysed as planned, many times, with an assumed effect."""

from __future__ import annotations

import csv
import random
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from analysis.dataset import read_responses
from analysis.plan import carry_out
from analysis.statistics.wilson import wilson
from study.orders import draw_plan
from study.simulation import Manner, choose

if TYPE_CHECKING:
    from study.protocol import Protocol

COLUMNS = ("participant", "part", "trial", "stimulus", "item", "response", "rt_ms")


@dataclass(frozen=True)
class SimulatedPower:
    """How often one test of a hypothesis was significant."""

    hypothesis: str
    test: str  # the stimulus, principle or scale it is about
    found: int
    runs: int

    @property
    def power(self) -> float:
        """The share of runs that found it."""
        return self.found / self.runs

    def __str__(self) -> str:
        low, high = wilson(self.found, self.runs) or (0.0, 1.0)
        within = f"95% CI {low:.0%} to {high:.0%}"
        return f"{self.hypothesis} {self.test}: {self.power:.0%} of {self.runs} runs ({within})"


def simulated_power(
    protocol: Protocol,
    *,
    runs: int,
    effect: float = 1.0,
    n: int | None = None,
    progress: Callable[[int], object] = lambda _: None,
) -> list[SimulatedPower]:
    """Simulate `runs` studies of n participants (as planned, unless told) and count what each test finds.

    `effect` 0 answers by chance; 1 sees what is meant about as well as the paper's participants, and moves
    compared ratings apart by one standard deviation. Orders, exclusions and corrections are the protocol's.
    """
    found: dict[tuple[str, str], int] = {}
    with tempfile.TemporaryDirectory() as scratch:
        table = Path(scratch) / "responses.csv"
        for run in range(runs):
            rng = random.Random(f"{protocol.seed}/power/{run}")
            with table.open("w", encoding="utf-8", newline="") as file:
                rows = csv.DictWriter(file, COLUMNS)
                rows.writeheader()
                rows.writerows(_answers(protocol, n or protocol.participants.planned, effect, rng))
            findings = carry_out(read_responses(table, protocol), protocol)
            for name, outcome in findings.outcomes.items():
                for test, one in outcome.results.items():
                    found[name, test] = found.get((name, test), 0) + bool(one.verdict.significant)
            progress(run + 1)
    return [SimulatedPower(name, test, count, runs) for (name, test), count in found.items()]


def _answers(protocol: Protocol, n: int, effect: float, rng: random.Random) -> Iterator[Mapping[str, str]]:
    """The rows that n participants leave behind."""
    manner = Manner(effect=effect)
    for slot in range(n):
        given: dict[str, set[str]] = {}
        for question in protocol.demographics:
            for item, answer in choose(protocol, None, question, manner, rng).items():
                given.setdefault(item, set()).add(answer)
        for trial in draw_plan(protocol, slot).trials:
            part = protocol.parts[trial.part]
            if trial.practice or not part.due(given):
                continue
            judged = protocol.judged[trial.stimulus]
            for question, _, _ in trial.asked(part):
                for item, answer in choose(protocol, judged, question, manner, rng).items():
                    given.setdefault(item, set()).add(answer)
                    yield {
                        "participant": f"simulated-{slot}",
                        "part": trial.part,
                        "trial": str(trial.number),
                        "stimulus": trial.stimulus,
                        "item": item,
                        "response": answer,
                        "rt_ms": "4000",
                    }
