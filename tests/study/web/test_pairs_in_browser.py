"""Two clips side by side in a real browser: both are seen before one is chosen; then back to the service."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from study.export import codebook, responses_csv
from study.protocol import Protocol, load_protocol
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("pages")
SIDE_BY_SIDE = {(1280, 800): True, (1024, 768): True, (820, 1180): False, (390, 844): False}

PAIRED = """
study: paired
title: Which looks happier?
contact: lab@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
modulations: {calm: {time: 1.3}, lively: {time: 0.8}}
demographics: [{select: {item: experience, text: Worked with robots?, options: [never, often]}}]
practice: {stimulus: {gesture: wave}, beside: {gesture: wave, modulation: calm}, ask: happier}
parts:
  happier:
    title: Which looks happier?
    stimuli: {gesture: wave, modulations: [calm, lively]}
    pairs: all
    ask: [{prefer: {item: happier, text: Which of the two looks happier?}}]
participants:
  planned: 2
  recruitment: {service: prolific, completion_url: "https://app.prolific.com/submissions/complete?cc=C1A2&id={id}"}
"""


@pytest.fixture
def protocol(tmp_path: Path) -> Protocol:
    folder = tmp_path / "paired"
    folder.mkdir()
    (folder / "protocol.yaml").write_text(PAIRED, encoding="utf-8")
    return load_protocol(folder)


def proceed(page: Page) -> None:
    with page.expect_navigation():
        page.get_by_role("button", name="Continue", exact=True).click()


def test_both_are_seen_before_one_is_chosen_by_keyboard_and_the_link_leads_back(
    page: Page, inspector, address: str, site: Site
) -> None:
    page.goto(f"{address}/?PROLIFIC_PID=person-7")
    page.get_by_role("checkbox").check()
    page.get_by_role("button", name="I agree, continue").click()
    page.get_by_label("never").check()
    proceed(page)
    for practice in (True, False):
        if not practice:
            expect(page.get_by_text("two short videos of the robot, A and B")).to_be_visible()
        proceed(page)  # instructions
        first, second = page.locator("figure.player").all()
        expect(first.locator("figcaption")).to_contain_text("Video A")
        expect(second.get_by_role("button")).to_be_disabled()
        left, _ = page.get_by_role("group", name="Which of the two looks happier?").get_by_role("radio").all()
        expect(left).to_be_disabled()
        first.get_by_role("button", name="Play").press("Enter")
        expect(first.get_by_role("status")).to_have_text("Watched")
        expect(left).to_be_disabled()
        expect(page.get_by_role("button", name="Continue", exact=True)).to_be_disabled()
        second.get_by_role("button", name="Play").press("Enter")
        expect(second.get_by_role("status")).to_have_text("Watched")
        expect(page.get_by_label("Video A", exact=True)).to_be_enabled()
        left.focus()
        page.keyboard.press("Space")
        page.keyboard.press("ArrowRight")  # from A to B
        expect(page.get_by_label("Video B", exact=True)).to_be_checked()
        if practice:
            for (width, height), beside in SIDE_BY_SIDE.items():
                page.set_viewport_size({"width": width, "height": height})
                boxes = [figure.bounding_box() for figure in (first, second)]
                assert (boxes[0]["y"] == boxes[1]["y"]) == beside, "else one above the other"
            inspector.look()  # at the smallest
            assert inspector.faults == []
            proceed(page)
        else:
            page.get_by_role("button", name="Continue", exact=True).click()
    expect(page.get_by_role("heading", name="You have reached the end")).to_be_visible()

    page.route("https://app.prolific.com/**", lambda route: route.fulfill(body="back at the service"))
    page.get_by_role("link", name="Complete the study").click()
    expect(page.get_by_text("back at the service")).to_be_visible()
    assert page.url == "https://app.prolific.com/submissions/complete?cc=C1A2&id=person-7"

    row = next(
        row
        for row in csv.DictReader(
            io.StringIO(
                responses_csv(site.store, clips={site.protocol.sha256: {"calm": "c1", "lively": "c2"}})
            )
        )
        if row["part"] == "happier"
    )
    other = {"calm": "lively", "lively": "calm"}[row["left"]]
    assert (row["stimulus"], row["item"], row["response"]) == ("calm_or_lively", "happier", other)
    assert row["stimulus_sha256"] == {"calm": "c1 c2", "lively": "c2 c1"}[row["left"]]
    assert row["plays"] == "1" and float(row["played_s"]) > 1.1
    part = codebook(site.protocol)["parts"]["happier"]
    assert part["pairs"] == {"calm_or_lively": ["calm", "lively"]}
    assert part["items"][0]["values"] == {"calm": "calm", "lively": "lively"}
