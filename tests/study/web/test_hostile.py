"""A participant who sends what no page of ours sends: nothing wrong is stored, nothing right is lost."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import timedelta
from typing import Any
from uuid import uuid4

import httpx
import pytest

from study.responses import playback_fault
from study.web.app import create_app
from study.web.server import running
from study.web.site import Site

JSON = {"Content-Type": "application/json"}


@pytest.fixture
def visitor(address: str) -> Iterator[httpx.Client]:
    """Somebody before the first page."""
    with httpx.Client(base_url=address, follow_redirects=True) as client:
        begin(client)
        yield client


def begin(client: httpx.Client) -> None:
    client.post("/start")
    client.post("/consent", data={"agreed": "yes", "language": "en"})


def sent(step: str = "demographics", age: str = "34", **more: Any) -> dict[str, Any]:
    answers = [{"item": "age", "value": age}] if step == "demographics" else []
    return {"id": str(uuid4()), "step": step, "answers": answers, "on_page_ms": 1.0} | more


def stored(site: Site) -> list[dict[str, str]]:
    return [
        response.submission.values
        for _, responses in site.store.responses("participant")
        for response in responses
    ]


def view(role: str, **more: Any) -> dict[str, Any]:
    return {"role": role, "plays": 1, "played_s": 1, "duration_s": 1, "frames": 1, "dropped": 0} | more


def test_of_answers_with_one_id_the_first_counts_whatever_comes_later(
    visitor: httpx.Client, site: Site
) -> None:
    first = sent(age="34")
    for again in (first, first | {"answers": [{"item": "age", "value": "43"}]}):
        assert visitor.post("/study/answers", json=again).status_code == 200
    moved = visitor.post("/study/answers", json=first | {"step": "instructions:practice", "answers": []})
    assert (moved.status_code, moved.json()["reason"]) == (409, "not yet")
    assert stored(site) == [{"age": "34"}]


def test_of_many_tabs_that_answer_at_once_one_is_stored(visitor: httpx.Client, site: Site) -> None:
    with ThreadPoolExecutor(8) as tabs:
        answers = tabs.map(lambda age: visitor.post("/study/answers", json=sent(age=str(age))), range(20, 36))
        statuses = [answer.status_code for answer in answers]
    assert sorted(statuses) == [200] + [409] * 15
    assert stored(site) == [{"age": str(20 + statuses.index(200))}]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"null",
        b"[]",
        b'{"id":"\xff"}',
        b"[" * 100_000,
        b'{"a":' * 40_000,
        json.dumps(sent(on_page_ms=float("nan"))).encode(),
        json.dumps(sent(on_page_ms=float("inf"))).encode(),
        json.dumps(sent()).replace("1.0", "9" * 5000).encode(),
        json.dumps(sent(age="\ud800")).encode(),
        json.dumps(sent(age="3" * 20_000)).encode(),
        json.dumps(sent(answers=[{"item": "age", "value": value} for value in ("evil", "34")])).encode(),
        json.dumps(sent(answers=[{"item": "age", "value": "34", "rt_ms": -1}])).encode(),
        json.dumps(sent(answers=[{"item": "age", "value": 34}])).encode(),
        json.dumps(sent(views=[view("clip")])).encode(),
        json.dumps(sent(views=[view("clip"), view("clip")])).encode(),
        json.dumps(sent(views=[view("clip", frames=10**30)])).encode(),
    ],
)
def test_what_is_no_answer_is_refused_and_the_page_can_still_be_answered(
    visitor: httpx.Client, site: Site, content: bytes
) -> None:
    refused = visitor.post("/study/answers", content=content, headers=JSON)
    assert refused.status_code in {400, 422}
    assert refused.json()["reason"]
    assert visitor.post("/study/answers", json=sent()).status_code == 200
    assert stored(site) == [{"age": "34"}]


@pytest.mark.parametrize(
    "kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""]
)
def test_answers_come_as_json_which_no_form_of_another_site_can_send(
    visitor: httpx.Client, site: Site, kind: str
) -> None:
    refused = visitor.post("/study/answers", content=json.dumps(sent()), headers={"Content-Type": kind})
    assert refused.status_code == 422
    assert stored(site) == []


def test_a_cookie_of_somebody_who_withdrew_opens_nothing(visitor: httpx.Client, site: Site) -> None:
    other_tab = httpx.Client(base_url=visitor.base_url, cookies=visitor.cookies)
    assert visitor.post("/withdraw", data={"sure": "yes"}).status_code == 200
    with other_tab:
        assert other_tab.post("/study/answers", json=sent()).status_code == 409
        assert other_tab.post("/study/events", json={"name": "video_failed"}).status_code == 409
        consented = other_tab.post("/consent", data={"agreed": "yes", "language": "en"})
        assert consented.headers["location"] == "/"
        assert other_tab.get("/study").headers["location"] == "/"
        assert other_tab.get("/").status_code == 200
    assert (stored(site), len(site.store.withdrawals())) == ([], 1)


def test_a_double_click_withdraws_once_and_both_are_told_so(visitor: httpx.Client, site: Site) -> None:
    with httpx.Client(base_url=visitor.base_url, cookies=visitor.cookies) as second:
        for click in (visitor, second):
            told = click.post("/withdraw", data={"sure": "yes"})
            assert (told.status_code, "Your answers are deleted" in told.text) == (200, True)
    [note] = site.store.withdrawals()
    site.store.withdraw(note.participant, now=site.clock())  # both at the same moment
    assert len(site.store.withdrawals()) == 1


def test_withdrawing_while_answers_are_under_way_leaves_none(site: Site) -> None:
    with running(create_app(site)) as address, ThreadPoolExecutor(4) as tabs:
        for _ in range(5):
            with httpx.Client(base_url=address, follow_redirects=True) as client:
                begin(client)
                steps = ("demographics", "instructions:practice") * 3
                answering = [tabs.submit(client.post, "/study/answers", json=sent(step)) for step in steps]
                leaving = tabs.submit(client.post, "/withdraw", data={"sure": "yes"})
                assert leaving.result().status_code == 200
                assert {answer.result().status_code for answer in answering} <= {200, 409}
    assert list(site.store.responses("participant")) == []
    assert len(site.store.withdrawals()) == 5


def test_who_takes_part_may_withdraw_though_somebody_beside_them_guessed_codes(
    visitor: httpx.Client, site: Site
) -> None:
    for _ in range(11):
        visitor.post("/code", data={"code": "guess"})
    assert visitor.post("/code", data={"code": "guess"}).status_code == 429
    assert visitor.post("/withdraw", data={"sure": "yes"}).status_code == 200
    assert len(site.store.withdrawals()) == 1


def test_who_is_gone_while_they_send_leaves_no_trace_in_the_log(
    capfd: pytest.CaptureFixture[str], visitor: httpx.Client, site: Site
) -> None:
    token, address = visitor.cookies["participant"], (visitor.base_url.host, visitor.base_url.port)
    head = f"Host: x\r\nCookie: participant={token}\r\nContent-Type: application/json\r\n"
    with socket.create_connection(address) as connection:
        connection.sendall(f"POST /study/answers HTTP/1.1\r\n{head}Content-Length: 99\r\n\r\n{{".encode())
    assert visitor.post("/study/answers", json=sent()).status_code == 200
    assert "Traceback" not in "".join(capfd.readouterr())
    assert stored(site) == [{"age": "34"}]


@pytest.mark.parametrize("origin", ["null", "http://elsewhere.example", "http://[", "//"])
def test_an_origin_that_is_not_ours_is_refused_however_it_is_written(
    visitor: httpx.Client, site: Site, origin: str
) -> None:
    refused = visitor.post("/study/answers", json=sent(), headers={"Origin": origin})
    assert refused.status_code == 403
    assert stored(site) == []


@pytest.mark.parametrize("kind", ["Application/JSON", "application/json ; charset=utf-8"])
def test_json_may_be_called_so_in_any_spelling(visitor: httpx.Client, kind: str) -> None:
    sent_so = visitor.post("/study/answers", content=json.dumps(sent()), headers={"Content-Type": kind})
    assert sent_so.status_code == 200


def test_withdrawing_is_never_taken_for_granted(visitor: httpx.Client, site: Site) -> None:
    assert visitor.post("/withdraw", data={"sure": "no"}).status_code == 400
    assert visitor.post("/withdraw").status_code == 422
    assert site.store.withdrawals() == []


def test_a_clock_that_is_set_back_costs_nobody_an_answer(site: Site) -> None:
    ahead = [timedelta(hours=1)]
    wandering = replace(site, clock=lambda: site.clock() + ahead[0])
    with (
        running(create_app(wandering)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        begin(client)
        ahead[0] = timedelta()
        for step in ("demographics", "instructions:practice"):
            assert client.post("/study/answers", json=sent(step)).status_code == 200
            assert client.get("/study").status_code == 200
    assert len(stored(site)) == 2
    assert playback_fault([], {}, elapsed_s=-3600.0) is None
