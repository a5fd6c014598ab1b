"""From responses to tests and report, against a script of pingouin calls; every run a process of its own."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from tests.benchmarks.compare import Row, seconds
from tests.benchmarks.large_responses import PAPER, write_responses

PEER = "pingouin 0.7.0, group by group"
ROWS_EACH = 48  # of a participant of the paper's study
REPORT = (
    "import sys; from pathlib import Path\n"
    "from analysis.report import analyse; from study.protocol import load_protocol\n"
    f"analyse(Path(sys.argv[1]), load_protocol(Path({str(PAPER)!r})), Path(sys.argv[2]))\n"
)


def rows() -> Iterator[Row]:
    """Every comparison."""
    with tempfile.TemporaryDirectory() as folder:
        responses = Path(folder) / "responses.csv"
        for millions, rounds in ((1, 3), (5, 2)):
            write_responses(responses, participants=millions * 1_000_000 // ROWS_EACH)
            pairs = [(_ours(responses), _peer(responses)) for _ in range(rounds)]
            for what, key, unit in (("time", "seconds", "s"), ("peak memory", "peak_mb", "MB")):
                ratio = statistics.median(ours[key] / peer[key] for ours, peer in pairs)
                detail = f"{pairs[-1][0][key]:.3g} {unit} against {pairs[-1][1][key]:.3g} {unit}"
                name = f"CSV of {millions}M rows → all tests, {what}"
                yield Row(name, PEER, ratio, 0.4, at_most=True, detail=detail)
        write_responses(responses, participants=34)
        ratio = statistics.median(_whole(responses, Path(folder)) for _ in range(3))
        yield Row("N = 34 → full report, whole process", PEER, ratio, 1.5, at_most=True)


def _ours(responses: Path) -> dict[str, float]:
    found = _run("-m", "tests.benchmarks.large_responses", str(responses))
    return {"seconds": found["read_s"] + found["test_s"], "peak_mb": found["peak_mb"]}


def _peer(responses: Path) -> dict[str, float]:
    return _run("-m", "tests.benchmarks.pingouin_loop", str(responses))


def _run(*arguments: str) -> dict[str, float]:
    """What a Python process prints as JSON."""
    done = subprocess.run([sys.executable, *arguments], check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def _whole(responses: Path, out: Path) -> float:
    """Our wall time over the peer's, from start to end of the process."""
    ours = seconds(
        lambda: subprocess.run(
            [sys.executable, "-c", REPORT, str(responses), str(out / "report")], check=True
        )
    )
    return ours / seconds(lambda: _peer(responses))
