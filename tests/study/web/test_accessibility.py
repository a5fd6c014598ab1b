"""axe-core finds nothing on any page in either language, and none is wider than its screen; what axe calls
needing a human eye is left to one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest
from playwright.sync_api import Page
from starlette.exceptions import HTTPException

from study.participants import Contact, new_participant, new_token
from study.web.app import create_app
from study.web.pages import HERE
from study.web.server import running
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("pages")
PASSWORD = "correct horse"  # as in the fixture `site`
LONG = "Donaudampfschifffahrtselektrizitätenhauptbetriebswerkbauunterbeamtengesellschaft"
PAGES = {
    file.stem for file in HERE.glob("templates/*.html") if "{% extends" in file.read_text(encoding="utf-8")
} - {"step"}  # which is extended itself


@pytest.mark.parametrize("page", ["wide", "narrow German"], indirect=True)
def test_every_page_can_be_used_by_everybody(inspector, page: Page, answer, site: Site) -> None:
    looked_at = set()
    for template in every_page(page, answer, site):
        if template == "message" and template in looked_at:
            inspector.measure()  # only the words are others
        else:
            inspector.look()
        looked_at.add(template)
    assert inspector.faults == []
    assert looked_at == PAGES


def every_page(page: Page, answer: Callable[[str], None], site: Site) -> Iterator[str]:
    """Bring the browser to every page of a study, one after the other; gives the template of each."""
    kiosk = replace(site, kind="simulated", door="kiosk", backup_fault=lambda: f"/srv/{LONG}")
    app = create_app(kiosk)

    @app.get("/fails/{status}")
    def fail(status: int) -> None:
        raise HTTPException(status)

    with running(app) as address:
        page.goto(address)
        yield "entry"
        yield from a_session(page, address, answer)
        for status in (400, 404, 410, 428, 429, 503):
            page.goto(f"{address}/fails/{status}")
            yield "message"
        yield from at_the_door(page, address)
        for phase in ("paused", "closed"):
            site.store.enter_phase(phase, now=site.clock())
            page.goto(address)
            yield "entry"
        invited = new_participant(new_token(), kind="simulated", created_at=site.clock())
        site.store.add_participant(invited, Contact(note=LONG))
        site.store.log("video_failed", LONG, participant=invited.name, now=site.clock()).result()
        yield from of_the_experimenter(page, address)
    with running(create_app(replace(site, door="link"))) as address:
        page.goto(address)
        enter(page, "#code", "wrong")
        yield "entry"


def a_session(page: Page, address: str, answer: Callable[[str], None]) -> Iterator[str]:
    """From consent to withdrawal. Pages like those before are answered and not looked at."""
    language = page.locator("html").get_attribute("lang")
    page.get_by_role("button").click()
    yield "consent"
    page.request.post(f"{address}/consent", form={"agreed": "yes", "language": language})
    page.goto(f"{address}/study")
    page.locator("#continue:enabled").wait_for()
    enter(page, "input[type=number]", "7")
    yield "demographics"
    answer(address)
    yield "instructions"
    answer(address)
    yield "trial"
    watch_all(page)
    page.locator("#continue").click()  # with answers missing
    yield "trial"
    for _ in range(5):
        answer(address)
    yield "trial"  # of two clips
    watch_all(page)
    yield "trial"
    answer(address)
    answer(address)
    yield "debrief"
    page.goto(f"{address}/withdraw")
    yield "withdraw"
    page.locator("[name=sure]").check()
    page.locator("form button").click()
    yield "message"
    page.context.add_cookies([{"name": "language", "value": language, "url": address}])  # also deleted


def watch_all(page: Page) -> None:
    for figure in page.locator("figure.player").all():
        figure.get_by_role("button").click()
        figure.locator("button.again").wait_for()


def at_the_door(page: Page, address: str) -> Iterator[str]:
    """Withdrawing without a session, and a kiosk's key."""
    page.goto(f"{address}/withdraw")
    page.locator("[name=sure]").check()
    enter(page, "#code", "wrong")
    yield "withdraw"
    page.goto(f"{address}/next")
    enter(page, "#key", "wrong")
    yield "next"


def of_the_experimenter(page: Page, address: str) -> Iterator[str]:
    """Behind the password."""
    page.goto(f"{address}/experimenter")
    enter(page, "#password", "wrong")
    yield "login"
    enter(page, "#password", PASSWORD)
    yield "experimenter"
    page.locator("#note").fill(LONG)
    enter(page, "#count", "2")
    yield "invitations"


def enter(page: Page, field: str, value: str) -> None:
    """Fill in the form's last field, and see what is said."""
    page.locator(field).fill(value)
    page.locator(field).press("Enter")
    page.locator(".notice:not(:empty)").first.wait_for()
