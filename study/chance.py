"""Chance that stays the same for ever: the same key gives the same draws in every version of Python.

The stream of numbers is SHA-256(key / 0), SHA-256(key / 1), … cut into 64-bit integers, big end first. A draw
below n refuses the integers that would favour some results; a shuffle is Fisher and Yates's from the end.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from typing import TypeVar

T = TypeVar("T")


class Stream:
    """An endless stream of draws that depends on nothing but its key."""

    def __init__(self, *key: str | int) -> None:
        self.key = hashlib.sha256("/".join(map(str, key)).encode()).hexdigest()
        self._integers = self._generate()

    def _generate(self) -> Iterator[int]:
        block = 0
        while True:
            digest = hashlib.sha256(f"{self.key}/{block}".encode()).digest()
            yield from (int.from_bytes(digest[start : start + 8], "big") for start in range(0, 32, 8))
            block += 1

    def below(self, n: int) -> int:
        """One of 0, 1, …, n - 1, all equally likely."""
        fair = 2**64 - 2**64 % n
        return next(integer for integer in self._integers if integer < fair) % n

    def shuffled(self, things: Sequence[T]) -> tuple[T, ...]:
        """The things in a new order, all orders equally likely."""
        order = list(things)
        for last in range(len(order) - 1, 0, -1):
            other = self.below(last + 1)
            order[last], order[other] = order[other], order[last]
        return tuple(order)
