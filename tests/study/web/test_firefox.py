"""A whole study in Debian's Firefox, driven by WebDriver BiDi as the browser itself speaks it.

Playwright asks this Firefox for commands it does not know, so the few that are needed here are sent directly.
https://www.w3.org/TR/webdriver-bidi/
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

from study.web.site import Site

pytestmark = pytest.mark.xdist_group("browser")
PATIENCE_S = 30
AGREEMENT = "I have read this information, I am at least 18 years old, and I take part of my own free will."
QUIET = {  # so that it asks nobody on the internet for anything
    "app.normandy.enabled": False,
    "browser.safebrowsing.malware.enabled": False,
    "browser.startup.homepage_override.mstone": "ignore",
    "datareporting.policy.dataSubmissionEnabled": False,
    "extensions.systemAddon.update.enabled": False,
    "network.captive-portal-service.enabled": False,
    "network.connectivity-service.enabled": False,
    "services.settings.server": "",
}

WATCHED = """(() => {  // how many; one that stuttered on a busy machine is played again
    const figures = [...document.querySelectorAll("figure")];
    const says = (figure, text) => figure.querySelector("[role=status]").textContent.startsWith(text);
    figures.find((figure) => says(figure, "The video was not"))?.querySelector("button").click();
    return figures.filter((figure) => says(figure, "Watched")).length;
})()"""


class Firefox:
    """One window of Firefox."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket
        self._numbers = count(1)
        self.version = self.send("session.new", capabilities={})["capabilities"]["browserVersion"]
        self._window = self.send("browsingContext.getTree")["contexts"][0]["context"]

    def send(self, method: str, **params: Any) -> Any:
        """Send a command and wait for what comes of it."""
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": params}))
        while True:
            answer = json.loads(self._socket.recv(timeout=PATIENCE_S))
            if answer.get("id") == number:
                assert answer["type"] == "success", answer
                return answer["result"]

    def go(self, address: str) -> None:
        """Open an address."""
        self.send("browsingContext.navigate", context=self._window, url=address, wait="complete")

    def reload(self) -> None:
        """Load the page again."""
        self.send("browsingContext.reload", context=self._window, wait="complete")

    def read(self, expression: str) -> Any:
        """The value of an expression of JavaScript."""
        target = {"context": self._window}
        answer = self.send("script.evaluate", expression=expression, target=target, awaitPromise=True)
        return answer["result"].get("value")

    def find(self, role: str, name: str, *, at_least: int = 1) -> list[dict[str, str]]:
        """All elements of that role and name, as a screen reader would have them, once there are enough."""

        def found() -> list[dict[str, str]]:
            locator = {"type": "accessibility", "value": {"role": role, "name": name}}
            nodes = self.send("browsingContext.locateNodes", context=self._window, locator=locator)["nodes"]
            return nodes if len(nodes) >= at_least else []

        return [{"sharedId": node["sharedId"]} for node in self.wait(found, f"{role} {name!r}")]

    def wait(self, look: Callable[[], Any], what: str) -> Any:
        """What `look` sees, as soon as it sees something."""
        deadline = time.monotonic() + PATIENCE_S
        while not (seen := look()):
            assert time.monotonic() < deadline, (
                f"{what} is not on the page: {self.read('document.body.innerText')}"
            )
            time.sleep(0.1)
        return seen

    def click(self, role: str, name: str, *, at_least: int = 1) -> None:
        """Click with the mouse on every element of that role and name."""
        for element in self.find(role, name, at_least=at_least):
            self.send(
                "script.callFunction",
                functionDeclaration="element => element.scrollIntoView({ block: 'center' })",
                arguments=[element],
                target={"context": self._window},
                awaitPromise=False,
            )
            there = {"type": "element", "element": element}
            moves = [
                {"type": "pointerMove", "x": 0, "y": 0, "origin": there},
                {"type": "pointerDown", "button": 0},
                {"type": "pointerUp", "button": 0},
            ]
            self._act({"type": "pointer", "id": "mouse", "actions": moves})

    def type(self, text: str) -> None:
        """Press the keys of a text."""
        keys = [{"type": kind, "value": key} for key in text for kind in ("keyDown", "keyUp")]
        self._act({"type": "key", "id": "keyboard", "actions": keys})

    def _act(self, source: dict[str, Any]) -> None:
        self.send("input.performActions", context=self._window, actions=[source])


@pytest.fixture
def firefox(tmp_path: Path) -> Iterator[Firefox]:
    """Firefox with a new profile, in English."""
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    assert program, "Firefox is among the packages of `.ci/system_packages test`"
    profile = tmp_path / "firefox"
    profile.mkdir()
    preferences = QUIET | {"intl.accept_languages": "en-GB"}
    lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in preferences.items()]
    (profile / "user.js").write_text("\n".join(lines))
    command = [
        program,
        "--headless",
        "--no-remote",
        "--profile",
        str(profile),
        "--remote-debugging-port",
        "0",
    ]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stderr is not None
            said = (re.search(r"BiDi listening on (ws://\S+)", line) for line in process.stderr)
            address = next(found[1] for found in said if found)
            with connect(f"{address}/session", max_size=None) as socket:
                yield Firefox(socket)
        finally:
            process.kill()


def test_a_whole_study_in_firefox(firefox: Firefox, address: str, site: Site) -> None:
    def proceed() -> None:
        place = firefox.read("document.querySelector('.way label').textContent")
        firefox.click("button", "Continue")
        firefox.wait(
            lambda: firefox.read(
                f"document.querySelector('.way label')?.textContent !== {json.dumps(place)}"
            ),
            "another page",
        )

    def watch(clips: int = 1) -> None:
        for seen in range(1, clips + 1):
            firefox.wait(lambda: firefox.read("!!document.querySelector('.stage button:enabled')"), "a clip")
            firefox.click("button", "Play")
            firefox.wait(lambda: firefox.read(WATCHED) == seen, "a clip watched in full")  # noqa: B023

    firefox.go(address)
    firefox.click("button", "Start")
    firefox.click("checkbox", AGREEMENT)
    firefox.click("button", "I agree, continue")
    firefox.click("spinbutton", "How old are you?")
    firefox.type("34")
    proceed()
    proceed()  # instructions
    watch()
    firefox.click("radio", "1, not at all", at_least=6)
    proceed()
    proceed()  # instructions
    for point in ("2", "4"):
        watch()
        firefox.reload()  # to be watched again
        watch()
        firefox.click("radio", point, at_least=6)
        proceed()
    proceed()  # instructions
    for choice in ("lower intensity", "higher intensity"):
        watch(2)
        firefox.click("radio", choice)
        proceed()
    firefox.find("heading", "You have reached the end")

    [(session, responses)] = site.store.responses("participant")
    assert session.completed_at is not None
    given = {response.submission.step: response.submission.values for response in responses}
    assert len(given) == len(responses) == 9
    assert given["demographics"] == {"age": "34", "gender": ""}
    assert [set(given[f"recognition:{trial}"].values()) for trial in (1, 2)] == [{"2"}, {"4"}]
    assert [given[f"intensity:{trial}"]["intensity"] for trial in (1, 2)] == ["lower", "higher"]
    views = [view for response in responses for view in response.submission.views]
    assert len(views) == 1 + 2 + 2 * 2
    for view in views:
        assert view.played_s == pytest.approx(0.6, abs=0.02)
        assert view.frames > 0
        assert {"playing", "ended"} <= {happening.name for happening in view.happenings}
