"""Pages wait for answers."""

from __future__ import annotations

import asyncio
import threading

import pytest

from study.web.site import Site
from study.web.turns import Turns


def test_no_page_is_made_while_answers_are_made_ready_for_the_disk(site: Site) -> None:
    begun, may_end = threading.Event(), threading.Event()

    def answer(_: object) -> None:
        begun.set()
        may_end.wait()

    async def come_for_a_page() -> None:
        turns = Turns(site.store)
        await turns.wait()
        stored = site.store._writer.soon(answer)
        begun.wait()
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(turns.wait(), 0.05)
        may_end.set()
        await asyncio.wait_for(turns.wait(), 10)
        assert stored.result(10) is None

    asyncio.run(come_for_a_page())


def test_a_page_is_made_after_answers_that_could_not_be_stored(site: Site) -> None:
    failed = site.store._writer.soon(lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        failed.result(10)
    asyncio.run(asyncio.wait_for(Turns(site.store).wait(), 10))
