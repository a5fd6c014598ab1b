"""What a screen reader is told: the accessibility tree that the browser makes of each kind of page."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.xdist_group("pages")

CONSENT = """
- banner:
  - navigation "Language":
    - link "English"
    - link "Deutsch"
- main:
  - article:
    - heading "Information and consent" [level=1]
    - checkbox /I have read this information/
    - button "I agree, continue"
- contentinfo:
  - link "lab@example.org"
"""
DEMOGRAPHICS = """
- banner:
  - progressbar "Page 1 of 9"
- main:
  - article:
    - heading "About you" [level=1]
    - spinbutton "How old are you?"
    - group "What is your gender?":
      - radio "Female"
      - radio "I prefer not to say"
    - status
    - button "Continue"
- contentinfo:
  - link "Withdraw from the study"
"""
UNSEEN = """
- banner:
  - progressbar "Page 3 of 9"
- main:
  - article:
    - heading "Practice" [level=1]
    - figure "Video":
      - status
      - button "Play"
      - progressbar "Played so far"
    - group "Your answer":
      - radiogroup "To which extent does the robot express … Joy":
        - radio "1, not at all" [disabled]
    - status
    - button "Continue" [disabled]
    - text: Watch the video to its end, then answer.
"""
SEEN = """
- main:
  - article:
    - figure "Video Watched":
      - status: Watched
      - button "Watch again"
    - group "Your answer":
      - radiogroup "To which extent does the robot express … Joy":
        - radio "1, not at all"
        - radio "2"
        - radio "5, very strongly"
      - radiogroup "To which extent does the robot express … Hurry":
        - radio "1, not at all"
    - status: Please answer every question.
    - button "Continue"
"""
WITHDRAWAL = """
- main:
  - article:
    - heading "Withdraw from the study" [level=1]
    - checkbox "Yes, delete all my answers."
    - button "Withdraw and delete"
    - link "Back to the study"
"""


def test_every_kind_of_page_says_what_is_on_it(visit, page: Page) -> None:
    def said(title: str, tree: str) -> None:
        expect(page).to_have_title(f"{title} · How does the robot move?")
        expect(page.locator("body")).to_match_aria_snapshot(tree)

    page.goto(visit.address)
    page.get_by_role("button", name="Start").click()
    said("Information and consent", CONSENT)
    visit.skip_to(1)
    said("Page 1 of 9", DEMOGRAPHICS)
    visit.skip_to(3)
    said("Page 3 of 9", UNSEEN)
    expect(page.get_by_label("A robot makes a gesture. The video has no sound.")).to_be_visible()
    visit.watch()
    visit.press_continue()
    said("Page 3 of 9", SEEN)
    page.goto(f"{visit.address}/withdraw")
    said("Withdraw from the study", WITHDRAWAL)


def test_tab_goes_through_a_page_in_the_order_it_is_read(visit, page: Page) -> None:
    visit.skip_to(3)
    expect(page.get_by_role("button", name="Play")).to_be_enabled()
    page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Play")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.get_by_role("status").first).to_have_text("Watched")
    page.keyboard.press("Tab")
    if page.get_by_role("button", name="Watch again").evaluate("(it) => it === document.activeElement"):
        page.keyboard.press("Tab")
    for row in page.get_by_role("radiogroup").all():
        expect(row.get_by_role("radio").first).to_be_focused()
        page.keyboard.press("Space")
        page.keyboard.press("Tab")
    expect(page.get_by_role("button", name="Continue")).to_be_focused()
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    expect(page.get_by_role("link", name="Withdraw")).to_be_focused()


def test_nothing_moves_but_the_video_for_who_asks_for_less_motion(visit, page: Page) -> None:
    moving = """() => [...document.querySelectorAll("*")].filter((element) => {
        const style = getComputedStyle(element);
        const moved = `${style.transitionDuration}, ${style.animationDuration}`.split(", ");
        return style.scrollBehavior === "smooth" || moved.some((duration) => parseFloat(duration) > 0);
    }).map((element) => element.outerHTML)"""
    visit.skip_to(3)
    assert page.evaluate(moving), "buttons change their colour gently"
    page.emulate_media(reduced_motion="reduce")
    assert page.evaluate(moving) == []
