"""Whoever a recruitment service sends comes in, takes part and goes back to it, in a real browser."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from playwright.sync_api import Page, expect

from study.participants import Contact
from study.protocol import load_protocol
from study.web.app import create_app
from study.web.server import running
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("pages")

CREDIT = "https://lab.sona-systems.com/webstudy_credit.aspx?experiment_id=7&credit_token=t1&survey_code="


@pytest.mark.parametrize(
    ("service", "sent", "known_as", "completion", "back"),
    [
        ("sona", "survey_code=4711", "4711", f"{CREDIT}{{id}}", f"{CREDIT}4711"),
        ("mturk", "assignmentId=3X&hitId=2Y&workerId=A1B2C3", "A1B2C3", None, None),
    ],
    ids=["sona", "mturk"],
)
def test_from_the_service_and_back(
    page: Page,
    site: Site,
    answer: Callable[[str], None],
    service: str,
    sent: str,
    known_as: str,
    completion: str | None,
    back: str | None,
) -> None:
    goes_back = f', completion_url: "{completion}"' if completion else ""
    recruits = f"participants: {{planned: 4, recruitment: {{service: {service}{goes_back}}}}}"
    file = site.protocol.path
    written = file.read_text(encoding="utf-8").replace("participants: {planned: 4}", recruits)
    file.write_text(written, encoding="utf-8")
    with running(create_app(replace(site, protocol=load_protocol(file), kind="simulated"))) as address:
        page.goto(f"{address}/?{sent}")
        assert page.url == f"{address}/study"
        page.get_by_role("checkbox").check()
        page.get_by_role("button", name="I agree, continue").click()
        expect(page.get_by_role("heading", name="About you")).to_be_visible()
        for _ in range(9):
            answer(address)
        [person] = site.store.progress()
        assert person.contact == Contact(source=service, external_id=known_as)
        assert person.session is not None
        expect(page.get_by_text(person.session.completion_code)).to_be_visible()
        link = page.get_by_role("link", name="Complete the study")
        if back:
            expect(link).to_have_attribute("href", back)
        else:
            expect(link).to_have_count(0)
            expect(page.get_by_text("Please enter it at MTurk too")).to_be_visible()
            expect(page.get_by_role("button", name="Next participant")).to_have_count(0)
