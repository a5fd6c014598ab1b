"""How much one visitor may ask for: enough for any person, too little for guessing or flooding.

Nobody is ever locked out: allowances fill up again, and each address or participant has its own.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from fastapi import Request
from starlette.exceptions import HTTPException

MOST_REMEMBERED = 100_000


@dataclass
class Limit:
    """An allowance per key, of so many at once, filling up again by so many a second."""

    most: float
    per_s: float
    clock: Callable[[], float] = time.monotonic
    _left: dict[str, tuple[float, float]] = field(default_factory=dict)  # key → what was left, and when
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def left(self, key: str) -> float:
        """What the key may still take."""
        left, then = self._left.get(key, (self.most, 0.0))
        return min(self.most, left + (self.clock() - then) * self.per_s)

    def take(self, key: str) -> bool:
        """Take one, if there is one."""
        with self._lock:
            left = self.left(key)
            if left < 1:
                return False
            if len(self._left) >= MOST_REMEMBERED:
                self._left = {
                    known: state for known, state in self._left.items() if self.left(known) < self.most
                }
            self._left[key] = (left - 1, self.clock())
            return True

    @property
    def wait_s(self) -> int:
        """After how long there is one again."""
        return math.ceil(1 / self.per_s)


@dataclass(frozen=True)
class Limits:
    """The allowances of one application."""

    guesses: Limit = field(
        default_factory=lambda: Limit(most=10, per_s=1 / 10)
    )  # wrong codes, keys, passwords
    entries: Limit = field(default_factory=lambda: Limit(most=500, per_s=5))  # a laboratory shares an address
    sendings: Limit = field(
        default_factory=lambda: Limit(most=300, per_s=10)
    )  # answers and notes of one person


def address_of(request: Request) -> str:
    """Where a request comes from; behind a proxy, what the proxy says."""
    return request.client.host if request.client else ""


def limits_of(request: Request) -> Limits:
    """The allowances of the application."""
    limits: Limits = request.app.state.limits
    return limits


def require(limit: Limit, key: str) -> None:
    """Take one of the key's allowance, or refuse the request."""
    if not limit.take(key):
        refuse(limit)


def refuse(limit: Limit) -> None:
    """Say that it was too much, and when to come again."""
    raise HTTPException(429, headers={"Retry-After": str(limit.wait_s)})


def require_guesses_left(request: Request) -> None:
    """Refuse whoever has guessed wrongly too often."""
    limit = limits_of(request).guesses
    if limit.left(_guesser(request)) < 1:
        refuse(limit)


def count_wrong_guess(request: Request) -> None:
    """Note a wrong guess."""
    limits_of(request).guesses.take(_guesser(request))


def _guesser(request: Request) -> str:
    """Who guesses what: guessing codes keeps nobody at the same address from their password or key."""
    return f"{address_of(request)} {request.scope['route'].name}"
