"""Our server as the command line runs it: a process of its own, SQLite, everything switched on."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from random import getrandbits
from uuid import UUID

from tests.benchmarks.load import Browser, Tally

PROTOCOL = Path("protocols/hielscher2025")
PAGE = re.compile(r'<script type="application/json" id="page">(.*?)</script>', re.DOTALL)
CLIP_S = 4.0
SERVE = f"""
import hashlib, sys
from pathlib import Path
from study.protocol import load_protocol
from study.storage import open_store
from study.web.app import create_app
from study.web.credentials import open_credentials
from study.web.server import running
from study.web.site import Clip, Site

protocol = load_protocol(Path("{PROTOCOL}"))
folder = Path(sys.argv[1])
credentials, _ = open_credentials(folder)
hashes = {{name: hashlib.sha256(name.encode()).hexdigest() for name in protocol.stimuli}}
clips = {{name: Clip(folder, sha256, 0, {CLIP_S}) for name, sha256 in hashes.items()}}
store = open_store(f"sqlite:///{{folder}}/study.db")
with running(create_app(Site(protocol, store, clips, credentials, "benchmark", kind="simulated"))) as address:
    print(address, flush=True)
    sys.stdin.read()
"""
"""Simulated participants need not wait as long as the clips take; all else is as for people. Clips are not
fetched: videos are cached by browsers, and oTree's pages have none."""

_people = count()


@contextmanager
def study(folder: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Serve the paper's study with its answers in that folder; gives the process and the address."""
    folder.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-c", SERVE, str(folder)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield process, process.stdout.readline().strip()
        finally:
            process.kill()


async def take_part(
    address: str,
    tally: Tally,
    *,
    acknowledged: Callable[[str], object] = lambda _: None,
) -> None:
    """Take the study again and again, each time as somebody else, from somewhere else."""
    for time in count():
        number = next(_people)
        browser = Browser(address, headers={"X-Forwarded-For": f"10.0.{number // 250 % 250}.{number % 250}"})
        await browser.post("/start", {})
        page = await browser.post("/consent", {"agreed": "yes", "language": "en"})
        if time == 0:
            await tally.door.wait()
        while found := PAGE.search(page.text):
            submission = _answered(json.loads(found[1]), page.text)
            sending = browser.post_json("/study/answers", json.dumps(submission).encode())
            sent = await tally.answer(sending)
            if sent.status == 200:
                acknowledged(submission["id"])
            page = await tally.page(browser.get("/study"))
        browser.close()


def _answered(page: dict[str, object], html: str) -> dict[str, object]:
    radios = re.findall(r'type="radio" name="([\w-]+)" value="([\w-]+)"', html) if page["clips"] else []
    view = {"plays": 1, "played_s": CLIP_S, "duration_s": CLIP_S, "frames": 120, "dropped": 0}
    happenings = [
        {"at_ms": 100.0 * n, "name": name, "media_s": 0.1 * n}
        for n, name in enumerate(("loadeddata", "playing", "pause", "ended"))
    ]
    clips = page["clips"]
    assert isinstance(clips, list)
    return {
        "id": str(UUID(int=getrandbits(128), version=4)),
        "step": page["step"],
        "answers": [
            {"item": item, "value": value, "rt_ms": 1234.5, "changes": 0}
            for item, value in dict(radios).items()
        ],
        "views": [{"role": clip["role"], **view, "happenings": happenings} for clip in clips],
        "on_page_ms": 9876.5,
    }
