"""The application as programs see it: outcomes of doubtful requests, and what guards it."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any
from uuid import uuid4

import httpx
import pytest

from study.export import COLUMNS, responses_json
from study.text import Text
from study.web.app import create_app
from study.web.participant import questions_of, steps_of
from study.web.security import HEADERS
from study.web.server import running
from study.web.site import Site

PASSWORD = "correct horse"  # as in the fixture `site`


@pytest.fixture
def visitor(address: str) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=address, follow_redirects=True) as client:
        yield client


@pytest.fixture
def experimenter(address: str) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=address, follow_redirects=True) as client:
        assert client.post("/experimenter/login", data={"password": PASSWORD}).status_code == 200
        yield client


def page_of(response: httpx.Response) -> dict[str, Any]:
    found = re.search(r'id="page">(.*?)</script>', response.text, re.DOTALL)
    assert found
    page: dict[str, Any] = json.loads(found[1])
    return page


def begin(visitor: httpx.Client) -> dict[str, Any]:
    visitor.post("/start")
    return page_of(visitor.post("/consent", data={"agreed": "yes", "language": "en"}))


def test_a_strange_title_leaves_the_page_whole(site: Site) -> None:
    title = Text("\0 <facts> </script>")
    strange = replace(site, protocol=site.protocol.model_copy(update={"title": title}))
    with (
        running(create_app(strange)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as visitor,
    ):
        assert begin(visitor)["step"] == "demographics"


def submission(step: str, answers: dict[str, str] | None = None, **more: Any) -> dict[str, Any]:
    given = [{"item": item, "value": value} for item, value in (answers or {}).items()]
    return {"id": str(uuid4()), "step": step, "answers": given, "on_page_ms": 1.0} | more


def form_token(page: httpx.Response) -> str:
    found = re.search(r'name="form_token" value="(\w+)"', page.text)
    assert found
    return found[1]


def test_consent_is_recorded_with_the_hash_of_its_text(visitor: httpx.Client, site: Site) -> None:
    session = site.store.session(begin(visitor)["participant"])
    assert session is not None
    text = site.protocol.texts.consent.in_("en")
    assert session.consent_sha256 == hashlib.sha256(text.encode()).hexdigest()


def test_an_answer_may_be_sent_again(visitor: httpx.Client) -> None:
    page = begin(visitor)
    sent = submission(page["step"], {"age": "34", "gender": ""})
    assert [visitor.post("/study/answers", json=sent).status_code for _ in range(3)] == [200, 200, 200]


def test_a_second_tab_is_told_that_another_page_is_due(visitor: httpx.Client) -> None:
    page = begin(visitor)
    visitor.post("/study/answers", json=submission(page["step"]))
    second = visitor.post("/study/answers", json=submission(page["step"]))
    assert (second.status_code, second.json()["reason"]) == (409, "elsewhere")
    assert page_of(visitor.get("/study"))["step"] == "instructions:practice"


def test_two_devices_with_one_link_share_one_session(
    experimenter: httpx.Client, visitor: httpx.Client, address: str
) -> None:
    page = experimenter.get("/experimenter")
    made = experimenter.post("/experimenter/links", data={"form_token": form_token(page), "count": 1})
    [link] = re.findall(r'href="(http://\S+/p/[\w-]{24})"', made.text)
    visitor.get(link)
    first = page_of(visitor.post("/consent", data={"agreed": "yes", "language": "de"}))
    with httpx.Client(base_url=address, follow_redirects=True) as other:
        assert page_of(other.get(link)) == first
        assert "/p/" not in str(other.get(link).url), "the token does not stay in the address"


@pytest.mark.parametrize(
    ("sent", "status"),
    [
        (submission("recognition:1"), 409),
        (submission("nowhere"), 409),
        (submission("demographics", {"age": "old"}), 422),
        (submission("demographics", {"shoe": "43"}), 422),
        (submission("demographics") | {"id": "1"}, 422),
        (submission("demographics") | {"extra": 1}, 422),
        (submission("demographics", on_page_ms=-1), 422),
    ],
)
def test_what_cannot_be_an_answer_is_refused_and_nothing_stored(
    visitor: httpx.Client, site: Site, sent: dict[str, Any], status: int
) -> None:
    begin(visitor)
    answer = visitor.post("/study/answers", json=sent)
    assert answer.status_code == status
    assert answer.json()["reason"]
    assert [responses for _, responses in site.store.responses("participant")] == [[]]


def test_a_video_that_was_not_watched_cannot_be_rated(visitor: httpx.Client, site: Site) -> None:
    page = begin(visitor)
    for _ in range(2):
        visitor.post("/study/answers", json=submission(page["step"]))
        page = page_of(visitor.get("/study"))
    session = site.store.session(page["participant"])
    assert session is not None
    step = next(step for step in steps_of(site, session) if step.key == page["step"])
    ratings = {item: "3" for question in questions_of(site, step) for item in question.items}
    view = {"role": "clip", "plays": 1, "played_s": 0.6, "duration_s": 0.6, "frames": 0, "dropped": 0}
    unseen = visitor.post("/study/answers", json=submission(step.key, ratings))
    assert (unseen.status_code, unseen.json()["reason"]) == (422, "the clip was not played to its end")
    hasty = visitor.post("/study/answers", json=submission(step.key, ratings, views=[view]))
    assert hasty.status_code == 422
    assert "its clips take 0.59 s" in hasty.json()["reason"]


def test_no_address_tells_the_condition(visitor: httpx.Client, site: Site) -> None:
    page = begin(visitor)
    for _ in range(2):
        visitor.post("/study/answers", json=submission(page["step"]))
        shown = visitor.get("/study")
        page = page_of(shown)
    assert page["clips"]
    for name in ("practice.mp4", "time_low", "time_high", '"stimulus"'):
        assert name not in shown.text


def test_videos_come_in_ranges_and_may_be_kept_for_ever(visitor: httpx.Client, site: Site) -> None:
    clip = site.clips["joy"]
    part = visitor.get(f"/clips/{clip.name}", headers={"Range": "bytes=100-199"})
    assert (part.status_code, len(part.content)) == (206, 100)
    assert part.headers["content-type"] == "video/mp4"
    assert "immutable" in part.headers["cache-control"]
    assert part.content == clip.path.read_bytes()[100:200]


@pytest.mark.parametrize("name", ["..%2f..%2fstudy.db", "joy.mp4", "%2e%2e/data/study.db", "x"])
def test_nothing_but_clips_is_served_as_a_clip(visitor: httpx.Client, name: str) -> None:
    assert visitor.get(f"/clips/{name}").status_code == 404
    assert visitor.get(f"/static/x/{name}").status_code == 404


@pytest.mark.parametrize("path", ["/", "/study", "/withdraw", "/experimenter", "/nowhere", "/p/guess"])
def test_every_page_has_the_headers_that_guard_it(visitor: httpx.Client, path: str) -> None:
    page = visitor.get(path)
    assert {name: page.headers[name] for name in HEADERS} == HEADERS
    assert "unsafe" not in page.headers["content-security-policy"]
    assert not re.search(r"<script(?![^>]*(src=|application/json))|\son\w+=|style=", page.text)
    head = visitor.head(path)
    assert (head.status_code, head.content) == (page.status_code, b"")
    assert head.headers["content-length"] == page.headers["content-length"]


@pytest.mark.parametrize(
    "headers", [{"Origin": "https://evil.example"}, {"Sec-Fetch-Site": "cross-site"}, {"Origin": "null"}]
)
def test_other_sites_cannot_send_anything(visitor: httpx.Client, headers: dict[str, str]) -> None:
    assert visitor.post("/start", headers=headers).status_code == 403


def test_who_takes_part_finds_the_way_back_from_a_page_that_is_not_there(visitor: httpx.Client) -> None:
    assert "Back to the study" not in visitor.get("/nowhere").text
    begin(visitor)
    for path in ("/nowhere", "/consent", "/p/nobody"):  # mistyped, or opened again by the browser
        assert 'href="/study">Back to the study' in visitor.get(path).text


def test_the_most_that_an_honest_page_sends_is_read(visitor: httpx.Client) -> None:
    begin(visitor)
    happening = {"at_ms": 123456.70000000298, "name": "seek refused", "media_s": 12.345678}
    view = {
        "plays": 1,
        "played_s": 1,
        "duration_s": 1,
        "frames": 1,
        "dropped": 0,
        "happenings": [happening] * 400,
    }
    sent = {
        "id": str(uuid4()),
        "step": "demographics",
        "answers": [{"item": f"remark{n}", "value": "語" * 10_000} for n in range(5)],
        "views": [view | {"role": role} for role in ("left", "right")],
        "on_page_ms": 1,
    }
    refused = visitor.post("/study/answers", json=sent)
    assert (refused.status_code, refused.json()["reason"]) == (422, "remark0 is not asked here")


def test_more_than_any_page_sends_is_refused(visitor: httpx.Client) -> None:
    begin(visitor)
    assert visitor.post("/study/answers", content=b"x" * 300_000).status_code == 413
    assert visitor.post("/study/answers", content=iter([b"x" * 100_000] * 3)).status_code == 413


def test_cookies_cannot_be_read_by_scripts_nor_sent_by_other_sites(address: str) -> None:
    with httpx.Client(base_url=address) as client:
        participant = client.post("/start").headers["set-cookie"].lower()
        assert "httponly" in participant
        assert "samesite=lax" in participant
        login = client.post("/experimenter/login", data={"password": PASSWORD}).headers["set-cookie"].lower()
        assert "httponly" in login
        assert "samesite=strict" in login


def test_the_data_are_behind_the_password(visitor: httpx.Client) -> None:
    names = ("responses.csv", "responses.codebook.json", "responses.json", "study.db", "report.html", "live")
    for name in names:
        refused = visitor.get(f"/experimenter/{name}")
        assert refused.status_code == 401
        assert "Password" in refused.text, "whoever comes without a login is shown the way in"
    assert visitor.post("/experimenter/login", data={"password": "wrong"}).status_code == 401
    visitor.cookies.set("experimenter", f"9999999999.nonce.{'0' * 64}", path="/experimenter")
    assert visitor.get("/experimenter/responses.csv").status_code == 401


def test_the_experimenter_s_forms_need_their_token(experimenter: httpx.Client) -> None:
    assert experimenter.post("/experimenter/links", data={"count": 1}).status_code == 422
    sent = {"form_token": "0" * 64, "count": 1}
    assert experimenter.post("/experimenter/links", data=sent).status_code == 403


def test_a_note_is_shown_as_text_whatever_is_in_it(experimenter: httpx.Client) -> None:
    token = form_token(experimenter.get("/experimenter"))
    note = "<img src=x onerror=alert(1)>"
    made = experimenter.post("/experimenter/links", data={"form_token": token, "count": 1, "note": note})
    assert note not in made.text
    assert "&lt;img" in made.text


def test_a_test_run_is_no_data(experimenter: httpx.Client, visitor: httpx.Client) -> None:
    token = form_token(experimenter.get("/experimenter"))
    made = experimenter.post("/experimenter/links", data={"form_token": token, "count": 1, "test": "true"})
    visitor.get(re.findall(r'href="(http://\S+/p/[\w-]{24})"', made.text)[0])
    page = visitor.post("/consent", data={"agreed": "yes", "language": "en"})
    assert "Test run" in page.text
    assert visitor.post("/study/answers", json=submission("demographics", {"age": "34"})).status_code == 200
    table = experimenter.get("/experimenter/responses.csv").text
    assert list(csv.reader(io.StringIO(table))) == [list(COLUMNS)]


def test_withdrawing_by_code_deletes_and_an_unknown_code_does_not(
    visitor: httpx.Client, site: Site, address: str
) -> None:
    page = begin(visitor)
    session = site.store.session(page["participant"])
    assert session is not None
    with httpx.Client(base_url=address) as elsewhere:
        assert elsewhere.post("/withdraw", data={"sure": "yes", "code": "AAAAA-AAAAA"}).status_code == 404
        code = session.completion_code.lower()
        assert elsewhere.post("/withdraw", data={"sure": "yes", "code": code}).status_code == 200
    assert site.store.session(page["participant"]) is None
    records = json.loads(responses_json(site.store))
    assert [(note["participant"], note["responses"]) for note in records["withdrawals"]] == [
        (page["participant"], 0)
    ]
    assert json.loads(responses_json(site.store, kind="test"))["withdrawals"] == []
