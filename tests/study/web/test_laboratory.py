"""The experimenter's side in a real browser: the study live, and a computer handed from one to the next."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from study.simulation import take_part
from study.web.app import create_app
from study.web.server import running
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("pages")
PASSWORD = "correct horse"  # as in the fixture `site`


@pytest.fixture
def address(site: Site) -> Iterator[str]:
    """The study at a laboratory's computer."""
    with running(create_app(replace(site, door="kiosk"))) as url:
        yield url


@pytest.fixture
def desk(browser: Browser, address: str) -> Iterator[Page]:
    """The experimenter's page, on a computer of their own."""
    context = browser.new_context(locale="en-GB")
    desk = context.new_page()
    desk.goto(f"{address}/experimenter")
    desk.get_by_label("Password").fill(PASSWORD)
    desk.get_by_role("button", name="Log in").click()
    yield desk
    context.close()


def test_the_experimenter_sees_the_study_as_it_runs(visit, page: Page, desk: Page) -> None:
    people = desk.get_by_role("region", name="Participants")
    expect(desk.get_by_text("Nobody has come yet.")).to_be_visible()
    visit.begin()
    expect(people.get_by_text("0/9 · demographics")).to_be_visible()
    visit.proceed()
    expect(people.get_by_text("1/9 · instructions:practice")).to_be_visible()
    expect(desk.get_by_text("1 in this hour, 1 in 24 hours")).to_be_visible()
    desk.get_by_role("button", name="Pause").focus()
    name = people.locator("code")
    desk.evaluate("name => getSelection().selectAllChildren(name)", name.element_handle())
    page.evaluate(
        """fetch("/study/events", {method: "POST", headers: {"Content-Type": "application/json"},
                 body: JSON.stringify({name: "video_failed", detail: "<b>503</b>"})})"""
    )
    expect(desk.get_by_text("a video failed: <b>503</b>")).to_be_visible()
    assert desk.evaluate("getSelection().toString()") == name.inner_text()
    expect(desk.get_by_role("button", name="Pause")).to_be_focused()

    desk.get_by_role("button", name="Pause").click()
    expect(desk.get_by_role("heading", name="The study is paused")).to_be_visible()
    visit.press_continue()  # stored all the same
    expect(page.get_by_role("heading", name="The study is paused")).to_be_visible()
    expect(people.get_by_text("2/9 · practice:1")).to_be_visible()
    desk.get_by_role("button", name="Resume").click()
    expect(desk.get_by_role("heading", name="The study is open")).to_be_visible()
    page.reload()
    expect(page.get_by_role("heading", name="Practice")).to_be_visible()


def test_the_data_are_a_click_away(desk: Page) -> None:
    names = ("responses.csv", "Codebook", "All records (JSON)", "Backup (SQLite)")
    for name in names:
        with desk.expect_download() as download:
            desk.get_by_role("link", name=name).click()
        assert download.value.path().stat().st_size > 50


def test_a_lost_server_is_said(site: Site, browser: Browser) -> None:
    with running(create_app(site)) as address:
        desk = browser.new_context(locale="en-GB").new_page()
        desk.goto(f"{address}/experimenter")
        desk.get_by_label("Password").fill(PASSWORD)
        desk.get_by_role("button", name="Log in").click()
        expect(desk.get_by_role("heading", name="The study is open")).to_be_visible()
        expect(desk.locator("#lost")).to_be_hidden()
    expect(desk.locator("#lost")).to_contain_text("The connection to the server is lost")
    desk.context.close()


def test_the_next_participant_finds_nothing_of_the_one_before(visit, page: Page, desk: Page) -> None:
    visit.begin()
    page.get_by_label("How old are you?").fill("34")
    visit.proceed()
    page.get_by_role("link", name="For the experimenter").click()
    page.get_by_role("link", name="Back to the study").click()  # a kiosk has no other way back
    page.get_by_role("link", name="For the experimenter").click()
    page.get_by_label("Key").fill(re.findall(r"\d{6}", desk.locator(".code").inner_text())[0])
    page.get_by_role("button", name="Next participant").click()
    expect(page.get_by_role("heading", name="Welcome")).to_be_visible()
    assert {cookie["name"] for cookie in page.context.cookies()} <= {"language"}
    assert page.evaluate("localStorage.length") == 0
    for _ in range(3):
        page.go_back()
        expect(page.get_by_role("heading", name=re.compile("Welcome|Next participant"))).to_be_visible()


def test_the_report_is_sealed_until_all_have_come_and_the_study_is_closed_by_hand(
    site: Site, page: Page
) -> None:
    def analyse(_: Path, out: Path) -> None:
        out.mkdir()
        (out / "report.html").write_text("the report")

    rehearsal = replace(site, kind="simulated", analyse=analyse)
    with running(create_app(rehearsal)) as address:
        page.goto(f"{address}/experimenter")
        page.get_by_label("Password").fill(PASSWORD)
        page.get_by_role("button", name="Log in").click()
        expect(page.get_by_text("The report is sealed until")).to_be_visible()
        expect(page.get_by_role("link", name="Report so far")).to_have_count(0)
        for number in range(site.protocol.participants.planned):
            take_part(rehearsal, address, number, {"attentive": 1.0})
        with page.expect_download() as download:
            page.get_by_role("link", name="Report so far").click()
        assert download.value.path().read_text() == "the report"
        page.get_by_role("button", name="Close: nobody else can begin").click()
        expect(page.get_by_role("heading", name="The study is closed")).to_be_visible()
        site.store.enter_phase("open", now=site.clock())  # by a colleague
        expect(page.get_by_role("heading", name="The study is open")).to_be_visible()
        site.store.enter_phase("closed", now=site.clock())
        page.goto(address)
        expect(page.get_by_text("The study is closed: nobody can begin")).to_be_visible()


def test_a_sheet_of_invitations_fits_its_paper(desk: Page, tmp_path) -> None:
    desk.get_by_label("How many").fill("12")
    desk.get_by_role("button", name="Create links and QR codes").click()
    expect(desk.get_by_role("listitem")).to_have_count(12)
    desk.emulate_media(media="print")
    desk.set_viewport_size({"width": 700, "height": 1000})  # A4 without its margins, in CSS pixels
    assert desk.evaluate("document.documentElement.scrollWidth") <= 700
    expect(desk.get_by_role("button", name="Print, or save as PDF")).to_be_hidden()
    desk.pdf(path=tmp_path / "sheet.pdf", format="A4", margin={"left": "12mm", "right": "12mm"})
    assert (tmp_path / "sheet.pdf").read_bytes().count(b"/Type /Page\n") == 2
