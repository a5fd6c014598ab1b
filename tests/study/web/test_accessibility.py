"""axe-core finds nothing on any page; what it calls needing a human eye is left to one."""

from __future__ import annotations

from dataclasses import replace

import pytest
from playwright.sync_api import Page, expect

from study.web.app import create_app
from study.web.server import running
from study.web.site import Site

pytestmark = [
    pytest.mark.xdist_group("pages"),
    pytest.mark.parametrize("page", ["narrow German"], indirect=True),
]
PASSWORD = "correct horse"  # as in the fixture `site`


def test_axe_finds_nothing_on_the_participant_s_pages(inspector, page: Page, site: Site) -> None:
    with running(create_app(replace(site, kind="simulated", door="kiosk"))) as address:
        inspector.visit(address)
        page.get_by_role("button", name="Starten").click()
        inspector.look()
        page.get_by_role("checkbox").check()
        page.get_by_role("button", name="Ich stimme zu, weiter").click()
        looked_at = set()
        for _ in range(9):
            page.locator("#continue").wait_for()
            place = page.locator(".way label").inner_text()
            for figure in page.locator("figure.player").all():
                figure.get_by_role("button", name="Abspielen").click()
                figure.locator("button.again").wait_for()
            if page.locator("input[required]").count():
                page.locator("#continue").click()
                expect(page.locator("#notice")).to_have_text("Bitte beantworten Sie alle Fragen.")
            looks_like = (page.locator("figure.player").count(), page.locator("fieldset").count())
            if looks_like not in looked_at:
                looked_at.add(looks_like)
                inspector.look()
            for radio in page.locator("input[type=radio][required]:enabled").all():
                radio.check()
            page.locator("#continue").click()
            expect(page.locator(".masthead")).not_to_contain_text(place)
        inspector.look()
        for path in ("/withdraw", "/next", "/nowhere"):
            inspector.visit(f"{address}{path}")
        page.goto(f"{address}/withdraw")
        page.get_by_role("checkbox").check()
        page.get_by_role("button", name="Zurücktreten und löschen").click()
        inspector.look()
        inspector.visit(f"{address}/withdraw")
        for phase in ("paused", "closed"):
            site.store.enter_phase(phase, now=site.clock())
            inspector.visit(address)
    assert inspector.faults == []


def test_axe_finds_nothing_where_something_is_wrong(inspector, page: Page, site: Site) -> None:
    with running(create_app(replace(site, door="link"))) as address:
        page.goto(address)
        page.get_by_label("Ihr persönlicher Code").fill("wrong")
        page.get_by_role("button", name="Weiter").click()
        expect(page.get_by_role("alert")).to_have_text("Dieser Code ist nicht bekannt.")
        inspector.look()
        for _ in range(20):
            page.request.post(f"{address}/code", form={"code": "wrong"})
        page.get_by_label("Ihr persönlicher Code").fill("wrong")
        page.get_by_role("button", name="Weiter").click()
        expect(page.get_by_role("heading", name="Bitte warten Sie ein wenig")).to_be_visible()
        inspector.look()
    with running(create_app(site)) as address:
        page.goto(address)
        page.get_by_role("button", name="Starten").click()
        page.get_by_role("checkbox").check()
        page.get_by_role("button", name="Ich stimme zu, weiter").click()
        expect(page.locator("#continue")).to_be_enabled()
        page.context.set_offline(True)
        page.get_by_role("button", name="Weiter").click()
        expect(page.locator("#notice")).to_contain_text("keine Verbindung")
        inspector.look()
        page.context.set_offline(False)
        expect(page.get_by_role("heading", name="Bevor es losgeht")).to_be_visible()
        site.store.enter_phase("paused", now=site.clock())
        inspector.visit(f"{address}/study")
        expect(page.get_by_role("heading", name="Die Studie macht eine Pause")).to_be_visible()
    assert inspector.faults == []


def test_axe_finds_nothing_on_the_experimenter_s_pages(inspector, page: Page, site: Site) -> None:
    with running(create_app(replace(site, door="kiosk"))) as address:
        inspector.visit(f"{address}/experimenter")
        page.get_by_label("Passwort").fill("wrong")
        page.get_by_role("button", name="Anmelden").click()
        inspector.look()
        page.get_by_label("Passwort").fill(PASSWORD)
        page.get_by_role("button", name="Anmelden").click()
        inspector.look()
        page.get_by_role("button", name="Links und QR-Codes").click()
        inspector.look()
        page.get_by_role("link", name="Zurück").click()
        inspector.look()  # now with participants
    assert inspector.faults == []
