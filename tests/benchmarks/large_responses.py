"""From a large file of responses to all tests: what the analysis costs where a study is large."""

from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path

import numpy as np

from analysis.dataset import read_responses
from analysis.plan import carry_out
from study.protocol import Protocol, load_protocol

PAPER = Path(__file__).parents[2] / "protocols" / "hielscher2025"


def write_responses(path: Path, participants: int, seed: int = 0) -> int:
    """Write made-up responses to the paper's study, 48 rows per participant; returns the number of rows."""
    rng = np.random.default_rng(seed)
    protocol = load_protocol(PAPER)
    columns = [
        (part.id, stimulus, item, tuple(question.values or ()))
        for part in protocol.parts.values()
        for stimulus in part.stimuli
        for question in part.questions
        for item in question.items
    ]
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write("participant,part,stimulus,item,response\n")
        for part, stimulus, item, options in columns:
            drawn = rng.integers(0, len(options), participants)
            file.writelines(
                f"P{p:07},{part},{stimulus},{item},{options[answer]}\n" for p, answer in enumerate(drawn)
            )
    return participants * len(columns)


def read_and_test(path: Path, protocol: Protocol) -> dict[str, float]:
    """Seconds to read and to test, and the peak memory of this process in MB."""
    start = time.perf_counter()
    responses = read_responses(path, protocol)
    read = time.perf_counter()
    carry_out(responses, protocol)
    done = time.perf_counter()
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {"read_s": read - start, "test_s": done - read, "peak_mb": peak_mb}


if __name__ == "__main__":  # in a process of its own, so that the peak is that of one run
    sys.stdout.write(json.dumps(read_and_test(Path(sys.argv[1]), load_protocol(PAPER))) + "\n")
