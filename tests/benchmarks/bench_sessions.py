"""Answers stored per second against oTree's production server, how long that takes, and what a kill -9 loses.

Everybody answers at once, again and again, without looking at anything: the worst that so many can do. People
are slower: watching a clip alone takes them some five seconds a page.
"""

from __future__ import annotations

import asyncio
import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path

from study.storage import open_store
from tests.benchmarks import otree_server, study_server
from tests.benchmarks.compare import Row
from tests.benchmarks.load import Tally, crowd, percentile_ms

SECONDS = 10.0
PEER_SECONDS = 24.0  # with 200 participants its first answers come late
ROUNDS = 2
KILLS = 20
P99_MS = 250.0

Pair = tuple[Tally, Tally]


def rows() -> Iterator[Row]:
    """Throughput with 50 and with 200 participants at once, latency with 200; then the kills."""
    for participants in (50, 200):
        pairs = [(_ours(participants), _otree(participants)) for _ in range(ROUNDS)]
        ours, peer = pairs[-1]
        yield Row(
            f"answers stored per second, {participants} participants",
            "oTree 6 production server, SQLite",
            statistics.mean(ours.per_s / peer.per_s for ours, peer in pairs),
            10,
            detail=f"{_said(ours)}; oTree {_said(peer)}",
        )
    yield Row(
        f"99th percentile of storing an answer, {participants} participants",
        f"{P99_MS:g} ms",
        statistics.mean(percentile_ms(ours.latencies_s, 0.99) for ours, _ in pairs) / P99_MS,
        1,
        at_most=True,
        detail=f"the same runs; until the next page is there as well: {_pages(ours)}; oTree {_pages(peer)}",
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
    p99_ms, client = percentile_ms(tally.latencies_s, 0.99), tally.own_cpu_s / tally.elapsed_s
    errors = ", ".join(f"{count} × {kind}" for kind, count in tally.errors.items()) or "no errors"
    return f"{tally.per_s:.0f}/s, p99 {p99_ms:.0f} ms, {errors}, client {client:.0%} of a core"


def _pages(tally: Tally) -> str:
    return f"p50 {percentile_ms(tally.pages_s, 0.5):.0f} ms, p99 {percentile_ms(tally.pages_s, 0.99):.0f} ms"


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
                        await study_server.take_part(address, tally, acknowledged=acknowledged.append)

                    later = asyncio.get_running_loop().call_later
                    await crowd(20, wait_s + 2, visit, once_in=lambda: later(wait_s, process.kill))

                asyncio.run(until_it_dies())
        store = open_store(f"sqlite:///{folder}/study.db")
        stored = [str(r.submission.id) for _, responses in store.responses("simulated") for r in responses]
        store.close()
    return len(acknowledged), len(set(acknowledged) - set(stored)), len(stored) - len(set(stored))
