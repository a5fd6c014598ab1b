from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from uuid import uuid4

import av
import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect, sync_playwright

from study.protocol import Protocol, load_protocol
from study.storage import open_store
from study.web.app import create_app
from study.web.credentials import Credentials, Passwords, new_credentials
from study.web.server import running
from study.web.site import Clip, Site

PASSWORD = "correct horse"
VIEWER = "battery staple"  # of whoever only looks on

SMALL = """
study: small
title: {en: "How does the robot move?", de: "Wie bewegt sich der Roboter?"}
contact: lab@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
modulations: {joy: {time: 0.8}, sadness: {time: 1.5}}
levels: {time: [1.4, 1.0, 0.7]}
practice: {stimulus: {gesture: wave}, ask: recognition}
parts:
  recognition:
    title: {en: "What does the robot express?", de: "Was drückt der Roboter aus?"}
    stimuli: {gesture: wave, modulations: [joy, sadness]}
    order: williams
    ask:
      - rate:
          text: {en: To which extent does the robot express …, de: Wie stark drückt der Roboter aus …}
          items:
            joy: {en: Joy, de: Freude}
            sadness: {en: Sadness, de: Trauer}
            anger: {en: Anger, de: Ärger}
            fear: {en: Fear, de: Angst}
            shame: {en: Shame, de: Scham}
            hurry: {en: Hurry, de: Eile}
          points: 5
          ends: {en: [not at all, very strongly], de: [gar nicht, sehr stark]}
  intensity:
    title: {en: "How intense is the motion?", de: "Wie intensiv ist die Bewegung?"}
    stimuli: {gesture: wave, levels: [time]}
    reference: medium
    order: {principles: williams, levels: balanced}
    ask:
      - choose:
          item: intensity
          text: {en: "Compared with the first video, the motion in the second video has a …",
                 de: "Verglichen mit dem ersten Video hat die Bewegung im zweiten Video eine …"}
          options:
            lower: {en: lower intensity, de: geringere Intensität}
            higher: {en: higher intensity, de: höhere Intensität}
          sides: balanced
participants: {planned: 4}
analysis:
  H1: {part: recognition, test: one-sample t, of: target, against: midpoint, alternative: greater}
  H2: {part: intensity, test: independent t, compare: [high, low], outcome: higher, alternative: greater}
"""

WAVE = """
gesture: wave
robot: pepper
title: {en: Greeting wave}
unit: deg
duration: 1.0 s
joints:
  RShoulderPitch: {0.0: home, 0.5: -40, 1.0: home}
"""


@pytest.fixture
def protocol(tmp_path: Path) -> Protocol:
    """A small study of both parts: 1 practice, 2 + 2 trials."""
    folder = tmp_path / "small"
    folder.mkdir()
    (folder / "protocol.yaml").write_text(SMALL, encoding="utf-8")
    (folder / "wave.yaml").write_text(WAVE, encoding="utf-8")
    return load_protocol(folder)


@pytest.fixture(scope="session")
def video_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("clips")


def write_clip(path: Path, *, shade: int, frames: int = 18, fps: int = 30) -> None:
    """A real, short H.264 clip: a bar that moves over a grey ground."""
    with av.open(path, "w", options={"movflags": "faststart"}) as container:
        stream = container.add_stream("libx264", rate=fps)
        stream.width, stream.height, stream.pix_fmt = 320, 180, "yuv420p"
        for number in range(frames):
            picture = np.full((180, 320, 3), shade, np.uint8)
            picture[:, 10 * number : 10 * number + 20] = 255 - shade
            for packet in stream.encode(av.VideoFrame.from_ndarray(picture, "rgb24")):
                container.mux(packet)
        for packet in stream.encode():
            container.mux(packet)


@pytest.fixture
def clips(protocol: Protocol, video_folder: Path) -> dict[str, Clip]:
    """A clip of 0.6 s for every stimulus of the study."""
    made = {}
    for number, stimulus in enumerate(protocol.stimuli):
        path = video_folder / f"{stimulus}.mp4"
        if not path.exists():
            write_clip(path, shade=60 + 10 * number)
        content = path.read_bytes()
        made[stimulus] = Clip(path, hashlib.sha256(content).hexdigest(), len(content), duration_s=18 / 30)
    return made


@pytest.fixture(scope="session")
def credentials() -> Credentials:
    """Made once: passwords are hashed slowly."""
    return new_credentials(Passwords(PASSWORD, VIEWER))


@pytest.fixture
def site(
    protocol: Protocol, clips: dict[str, Clip], credentials: Credentials, tmp_path: Path
) -> Iterator[Site]:
    store = open_store(f"sqlite:///{tmp_path}/data/study.db")
    yield Site(protocol, store, clips, credentials, "software 1")
    store.close()


@pytest.fixture
def address(site: Site) -> Iterator[str]:
    """The study on a real server."""
    with running(create_app(site)) as url:
        yield url


PATIENCE_MS = 20_000  # with other tests on the same machine
LOOKS = {
    "wide": {"locale": "en-GB", "viewport": {"width": 1280, "height": 800}},
    "narrow": {"locale": "en-GB", "viewport": {"width": 390, "height": 844}},
    "narrow German": {"locale": "de-DE", "viewport": {"width": 390, "height": 844}},
}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Debian's Chromium, without the window around the page, which would cost four times the work."""
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=shutil.which("chromium-headless-shell") or shutil.which("chromium"),
            args=["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
        )
        yield chromium
        chromium.close()


@pytest.fixture
def page(browser: Browser, request: pytest.FixtureRequest) -> Iterator[Page]:
    """A page in a browser that knows nothing yet: wide, unless a test asks for another of LOOKS."""
    context = browser.new_context(**LOOKS[getattr(request, "param", "wide")])
    page = context.new_page()
    faults: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.set_default_timeout(PATIENCE_MS)
    yield page
    context.close()
    assert faults == []


class Visit:
    """An English-speaking participant at a browser."""

    def __init__(self, page: Page, address: str) -> None:
        self.page = page
        self.address = address

    def begin(self) -> None:
        """Come in and consent."""
        self.page.goto(self.address)
        self.page.get_by_role("button", name="Start").click()
        self.consent()

    def skip_to(self, page: int) -> None:
        """Come to a page of the study without a look at those before, where nothing must be answered."""
        server = self.page.context.request
        server.post(f"{self.address}/start")
        server.post(f"{self.address}/consent", form={"agreed": "yes", "language": "en"})
        blank = {"answers": [{"item": item, "value": ""} for item in ("age", "gender")]}
        before = [{"step": "demographics"} | blank, {"step": "instructions:practice"}]
        for answered in before[: page - 1]:
            server.post(
                f"{self.address}/study/answers", data={"id": str(uuid4()), "on_page_ms": 1} | answered
            )
        self.page.goto(f"{self.address}/study")
        expect(self.page.locator(".way label")).to_contain_text(f"Page {page} of")

    def consent(self) -> None:
        """Agree, and come to the first page."""
        self.page.get_by_role("checkbox").check()
        self.page.get_by_role("button", name="I agree, continue").click()
        expect(self.page.locator("#continue")).to_be_enabled()

    @property
    def place(self) -> str:
        """Page 3 of 9."""
        return self.page.locator(".way label").inner_text()

    def press_continue(self) -> None:
        """Send the page, whatever comes of it."""
        self.page.get_by_role("button", name="Continue", exact=True).click()

    def proceed(self, pages: int = 1) -> None:
        """Send the page and come to the next."""
        for _ in range(pages):
            before = self.place
            self.press_continue()
            expect(self.page.locator(".way label")).not_to_have_text(before)

    def watch(self) -> None:
        """Play all clips of the page."""
        for figure in self.page.locator("figure.player").all():
            figure.get_by_role("button", name="Play").click()
            expect(figure.get_by_role("status")).to_have_text("Watched")

    def rate(self, point: int) -> None:
        """Give every item the same point."""
        for row in self.page.get_by_role("radiogroup").all():
            row.get_by_role("radio").nth(point - 1).check()


@pytest.fixture
def visit(page: Page, address: str) -> Visit:
    """A participant who has yet to come in."""
    return Visit(page, address)


@pytest.fixture
def answer(page: Page) -> Callable[[str], None]:
    """Sends what the page's script would, as if all was watched, and comes to the page that is next."""

    def send(address: str) -> None:
        facts = json.loads(page.locator("#page").text_content() or "")
        fields = page.evaluate(
            "[...document.querySelectorAll('#answers [name]')].map(({name, type, value}) => "
            "[name, type === 'radio' ? value : ''])"
        )
        seen = {"plays": 1, "played_s": 0.6, "duration_s": 0.6, "frames": 0, "dropped": 0}
        sent = {
            "id": str(uuid4()), "step": facts["step"], "on_page_ms": 1,
            "answers": [{"item": item, "value": value} for item, value in dict(fields).items()],
            "views": [{"role": clip["role"]} | seen for clip in facts["clips"]],
        }  # fmt: skip
        assert page.request.post(f"{address}/study/answers", data=sent).ok
        page.goto(f"{address}/study")

    return send


RULES = {
    "runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"],
    "resultTypes": ["violations"],
}


class Inspector:
    """Somebody who looks at pages and keeps what is wrong with them."""

    WIDTHS = (1280, 820, 390)  # of a desk, a tablet and a phone

    def __init__(self, page: Page) -> None:
        page.emulate_media(reduced_motion="reduce")  # a colour on its way to another is not looked at
        self.page = page
        self.faults: list[str] = []

    def look(self) -> None:
        """Run axe-core, and measure."""
        found = Axe().run(self.page, options=RULES).response["violations"]
        here = f"{self.page.url} {self.page.locator('h1').inner_text()}"
        self.faults += [
            f"{here}: {fault['id']}: {node['html']}" for fault in found for node in fault["nodes"]
        ]
        self.measure()

    def measure(self) -> None:
        """See that nothing hangs over the edge of any screen."""
        here = f"{self.page.url} {self.page.locator('h1').inner_text()}"
        size = self.page.viewport_size
        for width in self.WIDTHS:
            self.page.set_viewport_size(size | {"width": width})
            if self.page.evaluate("document.documentElement.scrollWidth > innerWidth"):
                self.faults.append(f"{here}: wider than {width} px")
        self.page.set_viewport_size(size)


@pytest.fixture
def inspector(page: Page) -> Inspector:
    """An inspector before a small screen."""
    return Inspector(page)
