"""Answers go before pages: under load, what was answered is stored first, and pages are made in between."""

from __future__ import annotations

import asyncio


class Turns:
    """Lets one page be made at a time, after every answer that has arrived by then has been taken in."""

    def __init__(self) -> None:
        self._turn = asyncio.Lock()

    async def wait(self) -> None:
        """Wait for the turn, as long as others are before."""
        async with self._turn:
            await asyncio.sleep(0)  # whatever else has arrived is looked at now
