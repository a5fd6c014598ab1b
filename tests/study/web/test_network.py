"""A poor network and impatient hands: every answer arrives, once."""

from __future__ import annotations

import pytest
from playwright.sync_api import Error, Page, Route, expect

from study.web.site import Site

pytestmark = pytest.mark.xdist_group("pages")


def stored(site: Site) -> list[dict[str, str]]:
    """The answers of the one session, page by page."""
    [(_, responses)] = site.store.responses("participant")
    return [response.submission.values for response in responses]


def test_answers_given_without_a_network_arrive_when_it_is_back(visit, page: Page, site: Site) -> None:
    visit.skip_to(1)
    page.context.set_offline(True)
    page.get_by_label("How old are you?").fill("34")
    visit.press_continue()
    expect(page.locator("#notice")).to_contain_text("There is no connection")
    page.context.set_offline(False)
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible()
    assert stored(site) == [{"age": "34", "gender": ""}]


def test_a_server_that_fails_for_a_while_is_asked_again(visit, page: Page, site: Site) -> None:
    visit.skip_to(1)
    failures = [503, 429]
    page.context.route(
        "**/study/answers",
        lambda route: route.fulfill(status=failures.pop()) if failures else route.continue_(),
    )
    visit.press_continue()
    expect(page.locator("#notice")).to_contain_text("There is no connection")
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible()
    assert len(stored(site)) == 1


def test_what_refuses_answers_on_their_way_is_said_and_loses_none(visit, page: Page, site: Site) -> None:
    visit.skip_to(1)
    faults = [(200, "Log in to the hotel's network"), (413, "Too large for this proxy")]

    def in_between(route: Route) -> None:
        if faults:
            status, body = faults.pop()
            route.fulfill(status=status, content_type="text/html", body=body)
        else:
            route.continue_()

    page.context.route("**/study/answers", in_between)
    visit.press_continue()
    expect(page.locator("#notice")).to_contain_text("Something between this device and the study refuses")
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible()
    assert len(stored(site)) == 1


@pytest.mark.parametrize(
    "fault",
    [
        "Object.defineProperty(window, 'localStorage', { value: null })",
        "Storage.prototype.setItem = () => { throw new DOMException('full', 'QuotaExceededError'); }",
    ],
)
def test_a_browser_that_stores_nothing_sends_answers_all_the_same(
    visit, page: Page, site: Site, fault: str
) -> None:
    page.context.add_init_script(fault)
    visit.skip_to(1)
    page.get_by_label("How old are you?").fill("34")
    visit.proceed()
    assert stored(site) == [{"age": "34", "gender": ""}]


def test_a_double_click_answers_once(visit, page: Page, site: Site) -> None:
    visit.skip_to(1)
    page.get_by_role("button", name="Continue", exact=True).dblclick()
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible()
    assert len(stored(site)) == 1


def test_answers_survive_closing_the_browser_and_opening_it_again_without_a_network(
    visit, page: Page, site: Site
) -> None:
    visit.skip_to(1)
    page.context.set_offline(True)
    page.get_by_label("How old are you?").fill("51")
    visit.press_continue()
    expect(page.locator("#notice")).to_contain_text("There is no connection")
    page.close()
    later = page.context.new_page()
    with pytest.raises(Error, match="ERR_INTERNET_DISCONNECTED"):
        later.goto(f"{visit.address}/study")
    page.context.set_offline(False)
    later.goto(f"{visit.address}/study")
    expect(later.get_by_role("heading", name="Before we start")).to_be_visible()
    assert [values["age"] for values in stored(site)] == ["51"]


def test_an_acknowledgement_that_got_lost_does_no_harm(visit, page: Page, site: Site) -> None:
    visit.skip_to(1)
    lost = [True]

    def lose_the_first(route) -> None:
        if lost:
            lost.clear()
            route.fetch()
            route.abort()
        else:
            route.continue_()

    page.context.route("**/study/answers", lose_the_first)
    visit.press_continue()
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible()
    assert len(stored(site)) == 1


def test_a_page_whose_script_does_not_come_says_so(visit, page: Page, site: Site) -> None:
    visit.skip_to(1)
    late = page.get_by_text("This page has not loaded completely")
    expect(late).to_have_count(0)
    page.context.route("**/page.js", lambda route: route.abort())
    visit.press_continue()
    expect(page.get_by_role("heading", name="Before we start")).to_be_visible()
    expect(late).to_be_hidden()
    page.evaluate("document.getAnimations().forEach((wait) => wait.finish())")  # as some seconds later
    expect(late).to_be_visible()
    page.context.unroute("**/page.js")
    page.reload()
    expect(page.locator("#continue")).to_be_enabled()
