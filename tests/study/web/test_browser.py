"""A whole study in a real browser, with real videos, on a real server."""

from __future__ import annotations

import csv
import io
from collections import Counter

import pytest
from playwright.sync_api import Browser, Page, expect

from study.export import responses_csv
from study.participants import new_participant, new_personal_code, token_of_code
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("browser")
EXPRESSIONS = ["joy", "sadness", "anger", "fear", "shame", "hurry"]


def test_a_whole_study_reloaded_at_every_step_leaves_every_answer_once(visit, page: Page, site: Site) -> None:
    def proceed() -> None:
        visit.proceed()
        place = visit.place
        page.reload()
        assert visit.place == place

    visit.begin()
    page.reload()
    page.get_by_label("How old are you?").fill("34")
    proceed()
    proceed()  # instructions of the practice
    visit.watch()
    visit.rate(1)
    proceed()
    proceed()  # instructions of the first part
    for point in (2, 4):
        visit.watch()
        visit.rate(3)
        page.reload()  # in the middle: to be watched again
        expect(page.get_by_role("radio").first).to_be_disabled()
        visit.watch()
        visit.rate(3)
        visit.rate(point)
        proceed()
    proceed()  # instructions of the second part
    visit.watch()
    page.get_by_label("lower intensity").check()
    proceed()
    visit.watch()
    page.get_by_label("higher intensity").check()
    visit.press_continue()
    expect(page.get_by_role("heading", name="You have reached the end")).to_be_visible()
    page.reload()
    expect(page.get_by_role("heading", name="You have reached the end")).to_be_visible()

    rows = list(csv.DictReader(io.StringIO(responses_csv(site.store))))
    counts = Counter((row["part"], row["stimulus"], row["item"]) for row in rows)
    expected = {("demographics", "", item) for item in ("age", "gender")}
    expected |= {("recognition", stimulus, item) for stimulus in ("joy", "sadness") for item in EXPRESSIONS}
    expected |= {("intensity", stimulus, "intensity") for stimulus in ("time_low", "time_high")}
    assert counts == dict.fromkeys(expected, 1)
    answers = {(row["part"], row["trial"]): row["response"] for row in rows if row["item"] != "gender"}
    assert answers == {
        ("demographics", ""): "34",
        ("recognition", "1"): "2",
        ("recognition", "2"): "4",
        ("intensity", "1"): "lower",
        ("intensity", "2"): "higher",
    }
    for row in rows[2:]:
        assert float(row["played_s"]) == pytest.approx(0.6, abs=0.02)
        assert row["plays"] == "1"
        assert float(row["rt_ms"]) > 0
    _, responses = next(site.store.responses("participant"))
    for response in responses:
        for answer in response.submission.answers:
            if answer.item in EXPRESSIONS and response.submission.step.startswith("recognition"):
                assert answer.changes == 1, "3 was replaced"
        assert response.submission.on_page_ms > max(
            (answer.rt_ms or 0 for answer in response.submission.answers), default=0
        )


@pytest.mark.parametrize("page", ["narrow German"], indirect=True)
def test_what_is_impossible_is_said_in_the_language_of_the_study(
    page: Page, address: str, site: Site
) -> None:
    page.goto(address)
    page.get_by_role("button", name="Starten").click()
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="Ich stimme zu, weiter").click()
    page.get_by_label("Wie alt sind Sie?").fill("7")
    page.get_by_role("button", name="Weiter").click()
    expect(page.locator("#notice")).to_have_text("Bitte geben Sie eine Zahl von 18 bis 120 an.")
    expect(page.get_by_label("Wie alt sind Sie?")).to_be_focused()
    page.get_by_label("Wie alt sind Sie?").fill("3.4e1")
    page.get_by_role("button", name="Weiter").click()
    expect(page.get_by_role("heading", name="Bevor es losgeht")).to_be_visible()
    [(_, [response])] = site.store.responses("participant")
    assert response.submission.values["age"] == "34"


@pytest.mark.parametrize("page", ["narrow German"], indirect=True)
def test_the_keyboard_alone_is_enough_on_a_small_german_screen(page: Page, address: str) -> None:
    page.goto(address)
    expect(page.locator("html")).to_have_attribute("lang", "de")
    for button in ("Starten", "Ich stimme zu, weiter", "Weiter", "Weiter"):
        if button.startswith("Ich"):
            page.get_by_role("checkbox").focus()
            page.keyboard.press("Space")
        page.get_by_role("button", name=button, exact=True).focus()
        with page.expect_navigation():
            page.keyboard.press("Enter")
    page.get_by_role("button", name="Abspielen").focus()
    page.keyboard.press("Enter")
    expect(page.get_by_role("status").first).to_have_text("Gesehen")
    page.get_by_role("radio").first.focus()
    for _ in EXPRESSIONS:
        page.keyboard.press("Space")
        page.keyboard.press("ArrowRight")
        page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "continue"
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    for label in page.locator("table.grid td label").all():
        box = label.bounding_box()
        assert box is not None
        assert min(box["width"], box["height"]) >= 44
    with page.expect_navigation():
        page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="Was drückt der Roboter aus?")).to_be_visible()


def test_a_second_tab_and_the_back_button_lead_to_the_page_that_is_due(visit, page: Page) -> None:
    visit.begin()
    tab = page.context.new_page()
    tab.goto(visit.address)
    expect(tab.get_by_role("heading", name="About you")).to_be_visible()
    visit.proceed()
    tab.get_by_role("button", name="Continue", exact=True).click()
    expect(tab.get_by_role("heading", name="Before we start")).to_be_visible()
    visit.proceed()
    page.go_back()
    expect(page.get_by_role("heading", name="Practice")).to_be_visible()


def test_two_devices_with_one_link_are_one_session(browser: Browser, visit, page: Page, site: Site) -> None:
    page.goto(f"{visit.address}/experimenter")
    page.get_by_label("Password").fill("correct horse")
    page.get_by_role("button", name="Log in").click()
    page.get_by_role("button", name="Create links and QR codes").click()
    link = page.get_by_label("All links, one a line").input_value().strip()
    page.goto(link)
    visit.consent()
    other = browser.new_context(locale="de-DE").new_page()
    other.goto(link)
    expect(other.get_by_role("heading", name="About you")).to_be_visible()
    page.get_by_label("How old are you?").fill("34")
    visit.proceed()
    other.get_by_label("How old are you?").fill("43")
    other.get_by_role("button", name="Continue").click()
    expect(other.get_by_role("heading", name="Before we start")).to_be_visible()
    other.context.close()
    [(_, responses)] = site.store.responses("participant")
    assert [response.submission.values["age"] for response in responses] == ["34"], "the first one counts"


def test_who_withdraws_is_deleted_and_can_not_go_on(visit, page: Page, site: Site) -> None:
    visit.begin()
    visit.proceed()
    page.get_by_role("link", name="Withdraw from the study").click()
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="Withdraw and delete").click()
    expect(page.get_by_role("heading", name="Your answers are deleted")).to_be_visible()
    page.goto(f"{visit.address}/study")
    expect(page.get_by_role("heading", name="Welcome")).to_be_visible()
    assert list(site.store.responses("participant")) == []
    [note] = site.store.withdrawals()
    assert note.responses == 1


def test_a_personal_code_is_typed_and_the_code_of_the_end_deletes_from_another_device(
    browser: Browser, visit, page: Page, site: Site
) -> None:
    code = new_personal_code()
    invited = new_participant(token_of_code(code), kind="participant", created_at=site.clock())
    site.store.add_participant(invited)
    page.goto(visit.address)
    page.get_by_text("I have a personal code").click()
    page.get_by_label("Your personal code").fill(code.upper())
    page.get_by_role("button", name="Go on").click()
    visit.consent()
    visit.proceed()
    session = site.store.session(invited.name)
    assert session is not None
    other = browser.new_context(locale="en-GB").new_page()
    other.goto(visit.address)
    other.get_by_role("link", name="Withdraw from the study").click()
    for typed, said in (("AAAAA-AAAAA", "This code is not known"), (session.completion_code, "are deleted")):
        other.get_by_label("Your code").fill(typed.lower())
        other.get_by_role("checkbox").check()
        other.get_by_role("button", name="Withdraw and delete").click()
        expect(other.get_by_role("main")).to_contain_text(said)
    other.context.close()
    visit.press_continue()
    expect(page.get_by_role("heading", name="Welcome")).to_be_visible()
    assert site.store.progress() == []


def test_the_language_is_changed_on_the_first_page_and_kept(visit, page: Page, site: Site) -> None:
    page.goto(visit.address)
    page.get_by_role("link", name="Deutsch").click()
    page.get_by_role("button", name="Starten").click()
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="Ich stimme zu, weiter").click()
    expect(page.get_by_role("heading", name="Über Sie")).to_be_visible()
    [person] = site.store.progress()
    assert person.session is not None
    assert person.session.language == "de"
