"""Kinds of questions that need more than HTML, answered by keyboard in a real browser."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from study.export import responses_csv
from study.protocol import Protocol, load_protocol
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("pages")

ASKING = """
study: asking
title: Kinds of questions
contact: lab@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
demographics:
  - select: {item: experience, text: Have you worked with robots?, options: [never, often]}
parts:
  one:
    title: How does the robot move?
    stimuli: {gesture: wave, modulations: [neutral]}
    order: fixed
    ask:
      - slider:
          text: The robot is …
          items: {hurried: in a hurry, calm: calm}
          ends: [not at all, extremely]
      - rank: {text: What matters most?, items: [speed, size, smoothness]}
      - attention: {text: Please choose “green”., options: [red, green], expected: green}
      - differential: {set: godspeed animacy, points: 7}
      - text: {item: impression, text: What did you think?}
  experts:
    if: {experience: often}
    title: For experts
    stimuli: {gesture: wave, modulations: [neutral], prefix: again_}
    order: fixed
    ask: [{text: {item: remark, text: Remarks?}}]
participants: {planned: 2}
"""


@pytest.fixture
def protocol(tmp_path: Path) -> Protocol:
    folder = tmp_path / "asking"
    folder.mkdir()
    (folder / "protocol.yaml").write_text(ASKING, encoding="utf-8")
    return load_protocol(folder)


def proceed(page: Page) -> None:
    with page.expect_navigation():
        page.get_by_role("button", name="Continue", exact=True).click()


def begin(page: Page, address: str, experience: str) -> None:
    page.goto(address)
    page.get_by_role("button", name="Start").click()
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="I agree, continue").click()
    page.get_by_label(experience).check()
    proceed(page)
    proceed(page)  # instructions
    page.get_by_role("button", name="Play").click()
    expect(page.get_by_label("in a hurry")).to_be_enabled()


def test_sliders_ranks_and_checks_by_keyboard(page: Page, inspector, address: str, site: Site) -> None:
    begin(page, address, "never")
    page.get_by_role("button", name="Continue", exact=True).click()
    expect(page.locator("#notice")).to_have_text("Please answer every question.")
    expect(page.get_by_label("in a hurry")).to_be_focused()
    inspector.look()  # with something missing

    for _ in range(2):
        page.keyboard.press("ArrowRight")  # from the middle, where no mark was
    page.get_by_label("calm", exact=True).focus()
    page.keyboard.press("Space")  # the middle itself
    ranking = page.locator(".rank")
    for item in ("speed", "size", "smoothness"):
        ranking.get_by_role("radiogroup", name=item).get_by_role("radio", name="1").focus()
        page.keyboard.press("Space")
    assert ranking.locator("input:checked").count() == 1, "a rank has one holder"
    for item, rank in (("smoothness", "2"), ("speed", "3"), ("size", "1")):
        ranking.get_by_role("radiogroup", name=item).get_by_role("radio", name=rank).check()
    page.get_by_label("green").check()
    for row in page.get_by_role("radiogroup", name="Please rate").all():
        row.get_by_role("radio").nth(4).check()
    page.get_by_label("What did you think?").fill(" \n")
    page.get_by_role("button", name="Continue", exact=True).click()
    expect(page.locator("#notice")).to_have_text("Please answer every question.")
    expect(page.get_by_label("What did you think?")).to_be_focused()
    page.get_by_label("What did you think?").press_sequentially("=1+1")
    for width in inspector.WIDTHS:
        page.set_viewport_size({"width": width, "height": 844})
        inspector.look()
    assert inspector.faults == []
    proceed(page)
    expect(page.get_by_role("heading", name="You have reached the end")).to_be_visible()

    rows = csv.DictReader(io.StringIO(responses_csv(site.store)))
    given = {row["item"]: row["response"] for row in rows}
    assert given["hurried"] == "52" and given["calm"] == "50"
    assert (given["size"], given["smoothness"], given["speed"]) == ("1", "2", "3")
    assert given["attention"] == "green" and given["lively"] == "5"
    assert given["impression"] == "'=1+1", "no formula in a spreadsheet"
    [(_, responses)] = site.store.responses("participant")
    changes = {answer.item: answer.changes for answer in responses[-1].submission.answers}
    kept = {item: changes[item] for item in ("hurried", "calm", "speed", "impression")}
    assert kept == {"hurried": 1, "calm": 0, "speed": 1, "impression": 0}, "letters typed replace no answer"
    assert site.store.session(next(iter(site.store.progress())).participant.name).completed_at is not None


def test_a_part_for_some_is_shown_to_those(page: Page, address: str) -> None:
    begin(page, address, "often")
    expect(page.locator(".way label")).to_have_text("Page 3 of 5")
