"""Many participants at once: a small HTTP client, and a crowd that keeps answering for some seconds."""

from __future__ import annotations

import asyncio
import time
from collections import Counter
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from http.cookies import SimpleCookie
from urllib.parse import urlencode, urlsplit


@dataclass(frozen=True)
class Answer:
    """An HTTP response."""

    status: int
    headers: dict[str, str]
    text: str


class Browser:
    """One visitor: one kept-alive connection, cookies, redirects. Quick, so that servers set the pace."""

    def __init__(self, address: str, *, headers: dict[str, str] | None = None) -> None:
        self._host = urlsplit(address).netloc
        self._headers = headers or {}
        self._cookies: dict[str, str] = {}
        self._streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None
        self._fresh = True  # the connection, made for the request under way
        self.path = "/"

    async def get(self, path: str) -> Answer:
        """Ask for a page."""
        return await self._follow(await self._send("GET", path))

    async def post(self, path: str, fields: dict[str, str], *, follow: bool = True) -> Answer:
        """Send a form."""
        form = {"Content-Type": "application/x-www-form-urlencoded"}
        answer = await self._send("POST", path, urlencode(fields).encode(), form)
        return await self._follow(answer) if follow else answer

    async def post_json(self, path: str, content: bytes) -> Answer:
        """Send JSON."""
        return await self._send("POST", path, content, {"Content-Type": "application/json"})

    def close(self) -> None:
        """Hang up."""
        if self._streams:
            self._streams[1].close()

    async def _follow(self, answer: Answer) -> Answer:
        while answer.status in {302, 303, 307}:
            answer = await self._send("GET", urlsplit(answer.headers["location"]).path)
        return answer

    async def _send(
        self, method: str, path: str, body: bytes = b"", headers: dict[str, str] | None = None
    ) -> Answer:
        self.path = path
        fields = {"Host": self._host, "Content-Length": str(len(body))} | self._headers | (headers or {})
        if self._cookies:
            fields["Cookie"] = "; ".join(f"{name}={value}" for name, value in self._cookies.items())
        lines = "".join(f"{name}: {value}\r\n" for name, value in fields.items())
        request = f"{method} {path} HTTP/1.1\r\n{lines}\r\n".encode() + body
        try:
            return await self._exchange(request)
        except (ConnectionError, asyncio.IncompleteReadError):
            if self._fresh:
                raise
            self._streams = None  # servers hang up on who is quiet, and browsers then ask again
            return await self._exchange(request)

    async def _exchange(self, request: bytes) -> Answer:
        self._fresh = self._streams is None
        if self._streams is None:
            host, _, port = self._host.partition(":")
            self._streams = await asyncio.open_connection(host, int(port), limit=2**20)
        reader, writer = self._streams
        writer.write(request)
        return await self._receive(reader)

    async def _receive(self, reader: asyncio.StreamReader) -> Answer:
        head = (await reader.readuntil(b"\r\n\r\n")).decode().split("\r\n")
        found: dict[str, str] = {}
        for line in head[1:-2]:
            name, _, value = line.partition(": ")
            found[name.lower()] = value
            if name.lower() == "set-cookie":
                self._cookies |= {key: morsel.value for key, morsel in SimpleCookie(value).items()}
        body = b""
        if found.get("transfer-encoding") == "chunked":
            while size := int(await reader.readline(), 16):
                body += (await reader.readexactly(size + 2))[:-2]
            await reader.readline()
        else:
            body = await reader.readexactly(int(found.get("content-length", 0)))
        return Answer(int(head[0].split()[1]), found, body.decode())


@dataclass
class Tally:
    """What a crowd achieved, from the moment on when everybody was in."""

    door: asyncio.Barrier
    latencies_s: list[float] = field(default_factory=list)  # of every acknowledged answer
    pages_s: list[float] = field(default_factory=list)  # until the next page was there
    errors: Counter[str] = field(default_factory=Counter)  # by status, or by what broke the connection
    elapsed_s: float = 0.0
    own_cpu_s: float = 0.0  # of the crowd itself, which must not be what is measured

    @property
    def per_s(self) -> float:
        """Answers stored per second."""
        return len(self.latencies_s) / self.elapsed_s

    async def answer(self, sending: Awaitable[Answer]) -> Answer:
        """Wait for an answer to be acknowledged, and count it."""
        start = time.perf_counter()
        answer = await sending
        if answer.status < 400:
            self.latencies_s.append(time.perf_counter() - start)
        else:
            self.errors[str(answer.status)] += 1
        return answer

    async def page(self, asking: Awaitable[Answer]) -> Answer:
        """Wait for the next page."""
        start = time.perf_counter()
        page = await asking
        self.pages_s.append(time.perf_counter() - start)
        return page


def percentile_ms(latencies_s: list[float], share: float) -> float:
    """So many ms or less for that share."""
    if not latencies_s:
        return float("inf")
    return 1000 * sorted(latencies_s)[int(share * (len(latencies_s) - 1))]


async def crowd(
    count: int,
    seconds: float,
    visit: Callable[[int, Tally], Awaitable[None]],
    *,
    once_in: Callable[[], object] = lambda: None,
) -> Tally:
    """Let so many take part side by side for so long, or until all are done.

    A visit waits at `tally.door` once, before its first answer; `once_in` is called when everybody is there.
    """
    tally = Tally(asyncio.Barrier(count + 1))
    visits = [asyncio.ensure_future(visit(number, tally)) for number in range(count)]
    everybody = asyncio.ensure_future(tally.door.wait())
    await asyncio.wait([everybody, *visits], return_when=asyncio.FIRST_COMPLETED)
    for one in visits:
        if one.done() and not everybody.done():  # without ever coming in
            one.result()
    once_in()
    start, own = time.perf_counter(), time.process_time()
    _, running = await asyncio.wait(visits, timeout=seconds)
    tally.elapsed_s, tally.own_cpu_s = time.perf_counter() - start, time.process_time() - own
    for one in running:
        one.cancel()
    results = await asyncio.gather(*visits, return_exceptions=True)
    tally.errors.update(type(result).__name__ for result in results if isinstance(result, Exception))
    return tally
