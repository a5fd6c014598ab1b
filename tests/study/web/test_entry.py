"""The ways in: links, codes, recruitment services, a kiosk; and what keeps the door."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import httpx
import pytest

from study.export import responses_csv, responses_json
from study.participants import Contact, new_participant, new_personal_code, new_token, token_of_code
from study.protocol import load_protocol
from study.web.app import create_app
from study.web.limits import Limit
from study.web.server import running
from study.web.site import Door, Site

RECRUITED = """
participants:
  planned: 4
  recruitment: {service: prolific, completion_url: "https://app.prolific.com/submissions/complete?cc=C1A2"}
"""


@pytest.fixture
def visitor(address: str) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=address, follow_redirects=True) as client:
        yield client


@pytest.fixture
def online(site: Site) -> Site:
    """The same study with participants from Prolific, and nobody else."""
    file = site.protocol.path
    written = file.read_text("utf-8").replace("participants: {planned: 4}", RECRUITED)
    file.write_text(written, encoding="utf-8")
    return replace(site, protocol=load_protocol(file), door="link")


def agree(client: httpx.Client) -> httpx.Response:
    return client.post("/consent", data={"agreed": "yes", "language": "en"})


def test_who_comes_from_a_service_is_the_same_participant_on_every_device(online: Site) -> None:
    way_in = "/?PROLIFIC_PID=5f0c1d&STUDY_ID=1&SESSION_ID=2"
    with running(create_app(online)) as address:
        for _ in range(2):
            with httpx.Client(base_url=address, follow_redirects=True) as client:
                page = client.get(way_in)
                assert "PROLIFIC" not in str(page.url)
                agree(client)
        assert httpx.post(f"{address}/start").status_code == 403, "nobody else may just come in"
        assert httpx.get(f"{address}/?PROLIFIC_PID=<script>").status_code == 404
    [row] = online.store.progress()
    assert row.session is not None
    assert row.contact == Contact(source="prolific", external_id="5f0c1d")


def test_no_export_says_who_anybody_is(online: Site) -> None:
    with (
        running(create_app(online)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        client.get("/?PROLIFIC_PID=5f0c1d")
        agree(client)
        client.post(
            "/study/answers",
            json={
                "id": "4a4ad5a3-73e1-4b3f-b2c8-6d3d8c2f6f5d",
                "step": "demographics",
                "answers": [{"item": "age", "value": "34"}],
                "on_page_ms": 1,
            },
        )
    for content in (responses_csv(online.store), responses_json(online.store)):
        assert "34" in content
        assert "5f0c1d" not in content
        assert "prolific" not in content


def test_a_personal_code_opens_the_session_however_it_is_typed(visitor: httpx.Client, site: Site) -> None:
    code = new_personal_code()
    participant = new_participant(token_of_code(code), kind="participant", created_at=site.clock())
    site.store.add_participant(participant)
    assert visitor.post("/code", data={"code": "aaaaa-aaaaa"}).status_code == 404
    for typed in (code, code.upper(), code.replace("-", ""), f" {code.replace('-', ' ')} "):
        assert "Information and consent" in visitor.post("/code", data={"code": typed}).text


def test_an_invitation_not_followed_in_time_opens_nothing_and_whoever_began_goes_on(site: Site) -> None:
    codes = [new_personal_code() for _ in range(2)]
    for code in codes:
        invited = new_participant(token_of_code(code), kind="participant", created_at=site.clock())
        site.store.add_participant(invited)
    days = [0.0]
    later = replace(site, clock=lambda: site.clock() + timedelta(days=days[0]))
    with running(create_app(later)) as address:

        def tries(code: str) -> tuple[int, int]:
            with httpx.Client(base_url=address, follow_redirects=True) as client:
                by_link = client.get(f"/p/{token_of_code(code)}")
                by_code = client.post("/code", data={"code": code})
                if by_code.status_code == 200 and code == codes[0]:
                    agree(client)
                return by_link.status_code, by_code.status_code

        assert [tries(code) for code in codes] == [(200, 200)] * 2
        days[0] = 91
        assert [tries(code) for code in codes] == [(200, 200), (410, 410)]


def test_a_link_may_ask_for_a_language(visitor: httpx.Client, site: Site) -> None:
    assert '<html lang="de">' in visitor.get("/?lang=de").text
    assert '<html lang="de">' in visitor.get("/withdraw").text, "and it is kept"
    token = new_token()
    site.store.add_participant(new_participant(token, kind="participant", created_at=site.clock()))
    assert "Information and consent" in visitor.get(f"/p/{token}?lang=en").text


def test_a_browser_that_keeps_no_cookie_is_told_so(visitor: httpx.Client) -> None:
    began = visitor.post("/start", follow_redirects=False)
    visitor.cookies.clear()
    told = visitor.get(began.headers["location"])
    assert told.status_code == 428 and "keeps no cookies" in told.text


def test_guessing_is_slowed_down_and_nobody_is_locked_out_for_good(site: Site) -> None:
    app = create_app(site)
    app.state.limits.guesses.clock = lambda: 0.0  # however slow this machine is
    with running(app) as address, httpx.Client(base_url=address, follow_redirects=True) as visitor:
        answers = [visitor.post("/code", data={"code": f"guess{n}"}) for n in range(12)]
        assert [answer.status_code for answer in answers] == [404] * 10 + [429] * 2
        assert int(answers[-1].headers["retry-after"]) <= 10
        assert visitor.post("/experimenter/login", data={"password": "wrong"}).status_code == 401
        assert visitor.post("/start").status_code == 200, "who does not guess is not kept out"
        code = new_personal_code()
        invited = new_participant(token_of_code(code), kind="participant", created_at=site.clock())
        site.store.add_participant(invited)
        assert visitor.post("/code", data={"code": code}).status_code == 200, "nor who need not guess"
        guesses = [visitor.get(f"/p/guess{n}").status_code for n in range(12)]
        assert guesses == [404] * 10 + [429] * 2
        assert visitor.get(f"/p/{token_of_code(code)}").status_code == 200


def test_an_allowance_fills_up_again() -> None:
    now = [100.0]
    limit = Limit(most=2, per_s=0.5, clock=lambda: now[0])
    assert [limit.take("a") for _ in range(3)] == [True, True, False]
    assert limit.take("b"), "everybody has an allowance of their own"
    now[0] += 2
    assert [limit.take("a") for _ in range(2)] == [True, False]
    now[0] += 1e6
    assert limit.left("a") == 2


def test_in_a_kiosk_only_the_experimenter_lets_the_next_one_in(site: Site) -> None:
    kiosk = replace(site, door="kiosk")
    with (
        running(create_app(kiosk)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        client.post("/start")
        agree(client)
        assert client.post("/next", data={"key": "000000"}).status_code == 403
        assert "About you" in client.get("/study").text
        left = client.post("/next", data={"key": kiosk.credentials.kiosk_key})
        assert "Welcome" in left.text
        assert left.history[0].headers["clear-site-data"] == '"cookies", "storage"'
        assert "Welcome" in client.get("/study").text
    assert len(site.store.progress()) == 1


@pytest.mark.parametrize(("door", "status"), [("open", 200), ("kiosk", 200), ("link", 403)])
def test_the_door_decides_who_may_start(site: Site, door: Door, status: int) -> None:
    with running(create_app(replace(site, door=door))) as address:
        assert httpx.post(f"{address}/start", follow_redirects=True).status_code == status


def test_paused_and_closed_studies_lose_no_answer_and_begin_no_session(
    visitor: httpx.Client, site: Site
) -> None:
    visitor.post("/start")
    agree(visitor)
    sent = {"id": "4a4ad5a3-73e1-4b3f-b2c8-6d3d8c2f6f5d", "step": "demographics", "on_page_ms": 1}
    site.store.enter_phase("paused", now=site.clock())
    assert visitor.post("/study/answers", json=sent).status_code == 200, "an answer under way is stored"
    assert "The study is paused" in visitor.get("/study").text
    with httpx.Client(base_url=visitor.base_url, follow_redirects=True) as late:
        assert "The study is paused. Please come back" in late.post("/start").text
    assert len(site.store.progress()) == 1
    site.store.enter_phase("closed", now=site.clock())
    assert "Before we start" in visitor.get("/study").text, "who has begun may finish"
    assert "nobody can begin any more" in httpx.get(visitor.base_url).text
    site.store.enter_phase("open", now=site.clock())
    assert "Start" in httpx.get(visitor.base_url).text


def test_the_end_leads_back_to_the_service(online: Site) -> None:
    recruitment = online.protocol.participants.recruitment
    address = recruitment.completion_address(external_id="5f0c1d", code="K3-M")
    assert address == "https://app.prolific.com/submissions/complete?cc=C1A2"


def test_a_hostile_protocol_sends_nobody_away(site: Site) -> None:
    hostile = RECRUITED.replace("app.prolific.com", "evil.example")
    file: Path = site.protocol.path
    written = file.read_text("utf-8").replace("participants: {planned: 4}", hostile)
    file.write_text(written, encoding="utf-8")
    with pytest.raises(Exception, match=r"completion_url.*evil\.example"):
        load_protocol(file)
