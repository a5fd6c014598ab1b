"""Answers go before pages: under load, what was answered is stored first, and pages are made in between."""

from __future__ import annotations

import asyncio

from study.storage import Store

LOOK_S = 0.001


class Turns:
    """Lets one page be made at a time, after every answer that has arrived by then has been taken in.

    Python runs one thread at a time: a page made while answers are made ready for the disk would hold them
    up, and whoever waits for them.
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self._turn = asyncio.Lock()

    async def wait(self) -> None:
        """Wait for the turn, as long as others are before."""
        async with self._turn:
            await asyncio.sleep(0)  # whatever else has arrived is looked at now
            while self._store.is_preparing:
                await asyncio.sleep(LOOK_S)
