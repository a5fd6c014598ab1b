"""oTree's production server, with a study of one question on each of ten pages, in a fresh folder."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.benchmarks.load import Browser, Tally

HOME = Path(".venv-otree")
PINNED = "otree==6.0.15"
KEY = "benchmark"
ROUNDS = 10

SETTINGS = f"""
SESSION_CONFIGS = [dict(name="rating", num_demo_participants=1, app_sequence=["rating"])]
SESSION_CONFIG_DEFAULTS = dict(real_world_currency_per_point=1.0, participation_fee=0.0)
LANGUAGE_CODE = "en"
REAL_WORLD_CURRENCY_CODE = "EUR"
ADMIN_USERNAME = "admin"
ADMIN_PASSWORD = "admin"
SECRET_KEY = "{KEY}"
"""
APP = f"""
from otree.api import *

class C(BaseConstants):
    NAME_IN_URL = "rating"
    PLAYERS_PER_GROUP = None
    NUM_ROUNDS = {ROUNDS}

class Subsession(BaseSubsession):
    pass

class Group(BaseGroup):
    pass

class Player(BasePlayer):
    rating = models.IntegerField(choices=[1, 2, 3, 4, 5])

class Rate(Page):
    form_model = "player"
    form_fields = ["rating"]

class End(Page):
    @staticmethod
    def is_displayed(player):
        return player.round_number == C.NUM_ROUNDS

page_sequence = [Rate, End]
"""
PAGE = "{{ block title }}Rate{{ endblock }}{{ block content }}{{ formfields }}{{ next_button }}{{ endblock }}"


@contextmanager
def otree(folder: Path, participants: int) -> Iterator[tuple[str, list[str]]]:
    """Serve a session with so many participants; gives the address and their codes."""
    program = _installed()
    (folder / "rating").mkdir(parents=True)
    (folder / "_static").mkdir()
    (folder / "settings.py").write_text(SETTINGS)
    (folder / "requirements.txt").write_text("otree\n")
    (folder / "rating" / "__init__.py").write_text(APP)
    (folder / "rating" / "Rate.html").write_text(PAGE)
    (folder / "rating" / "End.html").write_text("{{ block content }}The end{{ endblock }}")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    path = f"{Path(program).parent}:{os.environ['PATH']}"  # it starts itself by name
    env = os.environ | {"PATH": path, "OTREE_PRODUCTION": "1", "OTREE_REST_KEY": KEY}
    command = [program, "prodserver1of2", str(port)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run([program, "resetdb", "--noinput"], cwd=folder, env=env, check=True, **quiet)
    with subprocess.Popen(command, cwd=folder, env=env, start_new_session=True, **quiet) as process:
        address = f"http://127.0.0.1:{port}"
        try:
            _wait_for(address)
            made = _api(
                address, "sessions", {"session_config_name": "rating", "num_participants": participants}
            )
            listed = _api(address, f"sessions/{made['code']}", None)
            yield address, [person["code"] for person in listed["participants"]]
        finally:
            os.killpg(process.pid, signal.SIGKILL)  # it has children of its own
            process.wait()


async def take_part(address: str, code: str, tally: Tally) -> None:
    """Answer all pages as one participant."""
    browser = Browser(address)
    page = await browser.get(f"/InitializeParticipant/{code}")
    await tally.door.wait()
    while 'name="rating"' in page.text:
        fields = dict(
            re.findall(r"<input type=.hidden. name=['\"](\w+)['\"] value=['\"]([^'\"]*)['\"]", page.text)
        )
        path = browser.path
        sent = await tally.answer(browser.post(path, fields | {"rating": "3"}, follow=False))
        page = await tally.page(browser.get(sent.headers.get("location", path).removeprefix(address)))
    browser.close()


def _installed() -> str:
    program = HOME / "bin" / "otree"
    if not program.exists():
        subprocess.run([sys.executable, "-m", "venv", str(HOME)], check=True)
        install = [str(HOME / "bin" / "pip"), "install", "--quiet", PINNED]
        subprocess.run(install, check=True)
    return str(program.absolute())


def _wait_for(address: str) -> None:
    for _ in range(300):
        try:
            urllib.request.urlopen(address, timeout=2).close()
        except OSError:
            time.sleep(0.1)
        else:
            return
    raise TimeoutError(f"oTree did not start at {address}")


def _api(address: str, path: str, content: dict[str, object] | None) -> dict[str, object]:
    body = None if content is None else json.dumps(content).encode()
    headers = {"otree-rest-key": KEY, "Content-Type": "application/json"}
    request = urllib.request.Request(f"{address}/api/{path}", body, headers)
    with urllib.request.urlopen(request, timeout=120) as answer:
        found: dict[str, object] = json.loads(answer.read())
        return found
