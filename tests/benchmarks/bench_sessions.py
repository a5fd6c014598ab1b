"""Answers stored per second against oTree's production server, and answers lost by kill -9."""

from __future__ import annotations

import asyncio
import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path

from study.storage import open_store
from tests.benchmarks import otree_server, study_server
from tests.benchmarks.compare import Row
from tests.benchmarks.load import Tally, crowd

SECONDS = 12.0
PEER_SECONDS = 45.0  # with 200 participants its first answers come late
ROUNDS = 3
KILLS = 20
LATENCY_MS = 250.0


def rows() -> Iterator[Row]:
    """Throughput and latency with 50 and with 200 participants at once; then the kills."""
    for participants in (50, 200):
        pairs = [(_ours(participants), _otree(participants)) for _ in range(ROUNDS)]
        ratio = statistics.median(ours.per_s / peer.per_s for ours, peer in pairs)
        ours, peer = min(pairs, key=lambda pair: abs(pair[0].per_s / pair[1].per_s - ratio))
        yield Row(
            f"answers stored per second, {participants} participants",
            "oTree 6 production server, SQLite",
            ratio,
            10,
            detail=f"{_said(ours)}; oTree {_said(peer)}",
        )
    p99_ms = statistics.median(ours.percentile_ms(0.99) for ours, _ in pairs)
    yield Row(
        "99th percentile of storing an answer, 200 participants",
        f"{LATENCY_MS:g} ms",
        p99_ms / LATENCY_MS,
        1,
        at_most=True,
        detail=f"{p99_ms:.0f} ms; oTree {statistics.median(p.percentile_ms(0.99) for _, p in pairs):.0f} ms",
    )
    acknowledged, lost, doubled = _killed()
    yield Row(
        f"acknowledged answers lost or doubled over {KILLS} kill -9 under load",
        "none",
        lost + doubled,
        0,
        at_most=True,
        detail=f"{acknowledged} acknowledged, {lost} lost, {doubled} doubled",
    )


def _said(tally: Tally) -> str:
    client = tally.own_cpu_s / tally.elapsed_s
    return (
        f"{tally.per_s:.0f}/s, p99 {tally.percentile_ms(0.99):.0f} ms, {tally.errors} errors, "
        f"client {client:.0%} of a core"
    )


def _ours(participants: int) -> Tally:
    with tempfile.TemporaryDirectory() as folder, study_server.study(Path(folder)) as (_, address):
        return asyncio.run(
            crowd(participants, SECONDS, lambda _, tally: study_server.take_part(address, tally))
        )


def _otree(participants: int) -> Tally:
    with (
        tempfile.TemporaryDirectory() as folder,
        otree_server.otree(Path(folder) / "project", participants) as (address, codes),
    ):
        return asyncio.run(
            crowd(
                participants,
                PEER_SECONDS,
                lambda number, tally: otree_server.take_part(address, codes[number], tally),
            )
        )


def _killed() -> tuple[int, int, int]:
    """Acknowledged, lost and doubled answers after so many kills of one study under load."""
    acknowledged: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        for kill in range(KILLS):
            with study_server.study(Path(folder)) as (process, address):

                async def until_it_dies(address: str = address, wait_s: float = 0.2 + 0.05 * kill) -> None:
                    async def visit(_: int, tally: Tally) -> None:
                        await study_server.take_part(address, tally, acknowledged.append)

                    later = asyncio.get_running_loop().call_later
                    await crowd(20, wait_s + 2, visit, once_in=lambda: later(wait_s, process.kill))

                asyncio.run(until_it_dies())
        store = open_store(f"sqlite:///{folder}/study.db")
        stored = [str(r.submission.id) for _, responses in store.responses("simulated") for r in responses]
        store.close()
    return len(acknowledged), len(set(acknowledged) - set(stored)), len(stored) - len(set(stored))
