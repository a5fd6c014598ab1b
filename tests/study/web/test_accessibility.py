"""axe-core finds nothing on any page; it is told apart from what only eyes can judge."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect, sync_playwright

from study.web.app import create_app
from study.web.server import running
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("browser")
PASSWORD = "correct horse"  # as in the fixture `site`
RULES = {"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]}


@pytest.fixture
def page() -> Iterator[Page]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
        )
        yield chromium.new_page(viewport={"width": 390, "height": 844}, locale="de-DE")
        chromium.close()


def faults(page: Page) -> list[str]:
    found = Axe().run(page, options=RULES).response["violations"]
    return [f"{page.url} {fault['id']}: {node['html']}" for fault in found for node in fault["nodes"]]


def test_axe_finds_nothing_on_any_page(page: Page, site: Site) -> None:
    found: list[str] = []
    with running(create_app(replace(site, kind="simulated", door="kiosk"))) as address:

        def look() -> None:
            found.extend(faults(page))

        for path in ("/", "/withdraw", "/next", "/experimenter", "/nowhere"):
            page.goto(f"{address}{path}")
            look()
        page.goto(address)
        page.get_by_role("button", name="Starten").click()
        look()
        page.get_by_role("checkbox").check()
        page.get_by_role("button", name="Ich stimme zu, weiter").click()
        for _ in range(9):
            page.locator("#continue").wait_for()
            number = page.locator(".way label").inner_text()
            for figure in page.locator("figure.player").all():
                figure.get_by_role("button", name="Abspielen").click()
                figure.locator("button.again").wait_for()
            look()
            for radio in page.locator("input[type=radio][required]:enabled").all():
                radio.check()
            page.locator("#continue").click()
            expect(page.locator(".masthead")).not_to_contain_text(number)
        look()
        page.goto(f"{address}/experimenter")
        page.get_by_role("textbox").fill(PASSWORD)
        page.get_by_role("button", name="Anmelden").click()
        look()
        page.get_by_role("button", name="Links und QR-Codes").click()
        look()
    assert found == []
