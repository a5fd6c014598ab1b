"""A whole study in a real browser, with real videos, on a real server."""

from __future__ import annotations

import csv
import io
import shutil
from collections import Counter
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect, sync_playwright

from study.export import responses_csv
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("browser")
EXPRESSIONS = ["joy", "sadness", "anger", "fear", "shame", "hurry"]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
        )
        yield chromium
        chromium.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context(locale="en-GB", viewport={"width": 1280, "height": 800})
    page = context.new_page()
    faults: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.set_default_timeout(15_000)
    yield page
    context.close()
    assert faults == []


def begin(page: Page, address: str) -> None:
    page.goto(address)
    page.get_by_role("button", name="Start").click()
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="I agree, continue").click()
    expect(page.get_by_role("heading", name="About you")).to_be_visible()


def proceed(page: Page) -> None:
    before = page_number(page)
    page.get_by_role("button", name="Continue", exact=True).click()
    expect(page.locator(".way label")).not_to_have_text(before)


def page_number(page: Page) -> str:
    return page.locator(".way label").inner_text()


def watch(page: Page) -> None:
    for figure in page.locator("figure.player").all():
        figure.get_by_role("button", name="Play").click()
        expect(figure.get_by_role("status")).to_have_text("Watched")


def rate(page: Page, point: int) -> None:
    for row in page.get_by_role("radiogroup").all():
        row.get_by_role("radio").nth(point - 1).check()


def test_a_whole_study_with_reloads_leaves_every_answer_once(page: Page, address: str, site: Site) -> None:
    begin(page, address)
    page.get_by_label("How old are you?").fill("34")
    proceed(page)
    proceed(page)  # instructions of the practice
    watch(page)
    rate(page, 1)
    proceed(page)
    proceed(page)  # instructions of the first part
    for point in (2, 4):
        number = page_number(page)
        watch(page)
        page.reload()  # in the middle: the same page, to be watched again
        assert page_number(page) == number
        expect(page.get_by_role("radio").first).to_be_disabled()
        watch(page)
        rate(page, point)
        proceed(page)
    page.reload()
    proceed(page)  # instructions of the second part
    for choice in ("lower intensity", "higher intensity"):
        watch(page)
        page.get_by_label(choice).check()
        last = choice == "higher intensity"
        if last:
            page.get_by_role("button", name="Continue", exact=True).click()
        else:
            proceed(page)
    expect(page.get_by_role("heading", name="You have reached the end")).to_be_visible()

    rows = list(csv.DictReader(io.StringIO(responses_csv(site.store, site.protocol))))
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
    for view in (view for response in responses for view in response.submission.views):
        assert view.frames > 0.5 * 18, "requestVideoFrameCallback counted the frames shown"
        assert {"playing", "ended"} <= {happening.name for happening in view.happenings}


def test_neither_keys_nor_scripts_can_skip_the_video(page: Page, address: str) -> None:
    begin(page, address)
    proceed(page)
    proceed(page)
    page.get_by_role("button", name="Play").click()
    page.evaluate("document.querySelector('video').currentTime = 0.59")
    page.evaluate("document.querySelector('video').playbackRate = 8")
    page.keyboard.press("End")
    expect(page.locator("figure [role=status]")).not_to_have_text("")
    watched = page.locator("figure [role=status]").inner_text()
    played_s = page.evaluate("document.querySelector('video').played.end(0)")
    if watched == "Watched":
        assert played_s == pytest.approx(0.6, abs=0.02), "it went back and played the rest"
    else:
        expect(page.get_by_role("radio").first).to_be_disabled()


def test_answers_given_without_a_network_arrive_when_it_is_back(page: Page, address: str, site: Site) -> None:
    begin(page, address)
    page.context.set_offline(True)
    page.get_by_label("How old are you?").fill("34")
    page.get_by_role("button", name="Continue", exact=True).dblclick()
    expect(page.locator("#notice")).to_contain_text("There is no connection")
    page.context.set_offline(False)
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible(timeout=15_000)
    [(_, responses)] = site.store.responses("participant")
    assert [response.submission.values for response in responses] == [{"age": "34", "gender": ""}]


def test_answers_survive_closing_the_browser_before_they_were_sent(
    page: Page, address: str, site: Site
) -> None:
    begin(page, address)
    page.context.route("**/study/answers", lambda route: route.abort())
    page.get_by_label("How old are you?").fill("51")
    page.get_by_role("button", name="Continue", exact=True).click()
    expect(page.locator("#notice")).to_contain_text("There is no connection")
    page.close()
    page.context.unroute("**/study/answers")
    later = page.context.new_page()
    later.goto(f"{address}/study")
    expect(later.get_by_role("heading", name="Before we start")).to_be_visible()
    [(_, responses)] = site.store.responses("participant")
    assert [response.submission.values["age"] for response in responses] == ["51"]


def test_a_second_tab_and_the_back_button_lead_to_the_page_that_is_due(page: Page, address: str) -> None:
    begin(page, address)
    tab = page.context.new_page()
    tab.goto(address)
    expect(tab.get_by_role("heading", name="About you")).to_be_visible()
    proceed(page)
    tab.get_by_role("button", name="Continue", exact=True).click()
    expect(tab.get_by_role("heading", name="Before we start")).to_be_visible()
    proceed(page)
    page.go_back()
    page.goto(f"{address}/study")
    expect(page.get_by_role("heading", name="Practice")).to_be_visible()


def test_a_video_that_fails_is_said_noted_and_can_be_tried_again(
    page: Page, address: str, site: Site
) -> None:
    begin(page, address)
    proceed(page)
    page.context.route("**/clips/*", lambda route: route.fulfill(status=503))
    page.reload()
    proceed(page)
    expect(page.locator("#notice")).to_contain_text("could not be played", timeout=20_000)
    page.context.unroute("**/clips/*")
    page.get_by_role("button", name="Try again").click()
    watch(page)
    expect(page.get_by_role("radio").first).to_be_enabled()
    assert sum(site.store.event_counts("video_failed").values()) >= 1


def test_the_keyboard_alone_is_enough_on_a_small_german_screen(browser: Browser, address: str) -> None:
    context = browser.new_context(locale="de-DE", viewport={"width": 390, "height": 844})
    page = context.new_page()
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
    context.close()
