"""The experimenter's pages: what is seen live, what can be downloaded, and what is sealed."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import httpx
import pytest
import segno

from stimuli.errors import InputError
from study.simulation import take_part
from study.storage import open_store
from study.web.app import create_app
from study.web.overview import may_see_report, overview
from study.web.server import running
from study.web.site import Site

PASSWORD, VIEWER = "correct horse", "battery staple"  # as in the fixture `site`


@pytest.fixture
def rehearsed(site: Site) -> Site:
    """The study with two simulated participants who completed it and one who did not."""
    rehearsal = replace(site, kind="simulated", analyse=write_report)
    with running(create_app(rehearsal)) as address:
        for number in range(2):
            take_part(rehearsal, address, number, {"attentive": 1.0})
        with httpx.Client(base_url=address, follow_redirects=True) as client:
            client.post("/start")
            client.post("/consent", data={"agreed": "yes", "language": "en"})
            client.post("/study/events", json={"name": "video_failed", "detail": "practice:1 <b>503</b>"})
    return rehearsal


def write_report(responses: Path, out: Path) -> None:
    """Stand where the command line puts the analysis, which the web application does not know."""
    out.mkdir()
    (out / "report.html").write_text(f"{len(responses.read_text().splitlines())} lines")


@pytest.fixture
def experimenter(rehearsed: Site) -> Iterator[httpx.Client]:
    with (
        running(create_app(rehearsed)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        assert client.post("/experimenter/login", data={"password": PASSWORD}).status_code == 200
        yield client


def form_token(client: httpx.Client) -> str:
    found = re.search(r'name="form_token" value="(\w+)"', client.get("/experimenter").text)
    assert found
    return found[1]


def test_the_overview_says_who_is_where(rehearsed: Site) -> None:
    seen = overview(rehearsed)
    assert dict(seen.counts) == {"completed": 2, "active": 1}
    assert seen.places == ("completed", "completed", "active", "free")
    assert sum(seen.hours) == seen.hours[-1] == 2 * 9
    assert [event.name for event in seen.troubles] == ["video_failed"]
    assert [counted.position_range for counted in seen.balances] == [(1, 1), (2, 2)]


def test_who_goes_quiet_is_stalled_and_then_has_dropped_out(rehearsed: Site) -> None:
    def later(minutes: float) -> Site:
        return replace(rehearsed, clock=lambda: rehearsed.clock() + timedelta(minutes=minutes))

    assert overview(later(6)).counts["stalled"] == 1
    assert overview(later(6)).dropouts == 0
    assert overview(later(61)).dropouts == 1
    assert overview(later(61)).places == ("completed", "completed", "free", "free")


def test_the_page_is_told_of_changes_as_they_happen(experimenter: httpx.Client, rehearsed: Site) -> None:
    with experimenter.stream("GET", "/experimenter/live") as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        parts = events(stream)
        first = next(parts)
        assert "&lt;b&gt;503" in first
        assert first.count('<span class="state completed">') == 2
        rehearsed.store.withdraw(rehearsed.store.progress()[0].participant.name, now=rehearsed.clock())
        assert next(parts) != first
    assert overview(rehearsed).withdrawn == 1


def test_the_live_page_ends_in_peace_when_the_login_does(
    rehearsed: Site, capfd: pytest.CaptureFixture[str]
) -> None:
    later = [timedelta()]
    site = replace(rehearsed, clock=lambda: rehearsed.clock() + later[0])
    cookies = {"experimenter": site.credentials.cookie("edit", site.clock())}
    with running(create_app(site)) as address, httpx.Client(base_url=address, cookies=cookies) as client:
        with client.stream("GET", "/experimenter/live") as stream:
            parts = events(stream)
            next(parts)
            later[0] = timedelta(days=1)
            assert list(parts) == []
        assert client.get("/experimenter/live").status_code == 401
    assert "Traceback" not in "".join(capfd.readouterr())


def events(stream: httpx.Response) -> Iterator[str]:
    lines: list[str] = []
    for line in stream.iter_lines():
        if line:
            lines.append(line.removeprefix("data: "))
        else:
            yield "\n".join(lines)
            lines = []


def test_an_open_live_page_does_not_keep_the_server_from_stopping(rehearsed: Site) -> None:
    with running(create_app(rehearsed)) as address, httpx.Client(base_url=address) as client:
        client.post("/experimenter/login", data={"password": PASSWORD})
        stream = client.send(client.build_request("GET", "/experimenter/live"), stream=True)
        assert stream.status_code == 200
    stream.close()


def test_everything_can_be_downloaded(experimenter: httpx.Client, tmp_path: Path) -> None:
    table = experimenter.get("/experimenter/responses.csv")
    assert "attachment" in table.headers["content-disposition"]
    records = json.loads(experimenter.get("/experimenter/responses.json").text)
    assert [len(session["pages"]) for session in records["sessions"]] == [9, 9, 0]
    assert all("completion_code" not in session for session in records["sessions"])
    assert experimenter.get("/experimenter/responses.codebook.json").json()["study"] == "small"
    (tmp_path / "copy.db").write_bytes(experimenter.get("/experimenter/study.db").content)
    copy = open_store(f"sqlite:///{tmp_path}/copy.db")
    assert [len(responses) for _, responses in copy.responses("simulated")] == [9, 9, 0]
    copy.close()


def test_the_report_is_sealed_until_as_many_as_planned_have_completed(
    experimenter: httpx.Client, rehearsed: Site
) -> None:
    assert "The report is sealed" in experimenter.get("/experimenter").text
    assert experimenter.get("/experimenter/report.html").status_code == 403
    participants = rehearsed.protocol.participants
    for change, seen in (({"planned": 2}, True), ({"planned": 3}, False), ({"peeking": True}, True)):
        protocol = rehearsed.protocol.model_copy(
            update={"participants": participants.model_copy(update=change)}
        )
        site = replace(rehearsed, protocol=protocol)
        assert may_see_report(site, overview(site)) is seen


def test_a_report_that_may_be_seen_is_made_of_the_answers_so_far(rehearsed: Site) -> None:
    allowed = rehearsed.protocol.participants.model_copy(update={"peeking": True})
    protocol = rehearsed.protocol.model_copy(update={"participants": allowed})
    with (
        running(create_app(replace(rehearsed, protocol=protocol))) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        client.post("/experimenter/login", data={"password": PASSWORD})
        assert client.get("/experimenter/report.html").text == "33 lines", "a header, and 16 answers of each"


def test_a_report_of_no_answers_is_not_there_yet(site: Site) -> None:
    def analyse(table: Path, _: Path) -> None:
        raise InputError(f"{table}: no answers")

    allowed = site.protocol.participants.model_copy(update={"peeking": True})
    protocol = site.protocol.model_copy(update={"participants": allowed})
    with (
        running(create_app(replace(site, protocol=protocol, analyse=analyse))) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        client.post("/experimenter/login", data={"password": PASSWORD})
        told = client.get("/experimenter/report.html")
    assert told.status_code == 404
    assert "There is no report yet" in told.text and "<p>responses.csv: no answers</p>" in told.text


def test_a_study_is_paused_from_the_page(experimenter: httpx.Client, rehearsed: Site) -> None:
    token = form_token(experimenter)
    for phase, said in (("paused", "The study is paused"), ("open", "The study is open")):
        sent = {"form_token": token, "phase": phase}
        assert said in experimenter.post("/experimenter/phase", data=sent).text
        assert rehearsed.store.phase == phase
    assert (
        experimenter.post("/experimenter/phase", data={"form_token": "0", "phase": "closed"}).status_code
        == 403
    )
    assert (
        experimenter.post("/experimenter/phase", data={"form_token": token, "phase": "x"}).status_code == 422
    )


def modules_of(picture: str) -> list[list[int]]:
    """The dark (1) and light (0) modules of a QR code drawn as one path of horizontal strokes."""
    width, scale = (
        int(re.findall(known, picture)[0]) for known in (r'viewBox="0 0 (\d+)', r"scale\((\d+)\)")
    )
    border, x, y = 2, 0.0, 0.0
    dark = set()
    for command, numbers in re.findall(r"([Mmh])([-\d. ]+)", re.findall(r' d="([^"]+)"', picture)[0]):
        values = [float(number) for number in re.findall(r"-?[\d.]+", numbers)]
        if command == "h":
            dark |= {(int(y), int(x) + step) for step in range(int(values[0]))}
            x += values[0]
        else:
            x, y = (values[0], values[1]) if command == "M" else (x + values[0], y + values[1])
    inside = range(border, width // scale - border)
    return [[int((row, column) in dark) for column in inside] for row in inside]


def test_invitations_are_cards_with_pictures_of_their_links(
    experimenter: httpx.Client, rehearsed: Site
) -> None:
    sent = {"form_token": form_token(experimenter), "count": 3, "note": "Tuesday"}
    sheet = experimenter.post("/experimenter/links", data=sent).text
    links = re.findall(r'href="(http://\S+/p/[\w-]{24})"', sheet)
    codes = re.findall(r'class="code">([a-z0-9-]{11})<', sheet)
    assert len(set(links)) == len(set(codes)) == sheet.count("<svg") == 3
    for link, picture in zip(links, re.findall(r"<svg.*?</svg>", sheet, re.DOTALL), strict=True):
        assert modules_of(picture) == [list(row) for row in segno.make(link, error="m", micro=False).matrix]
    for link, code in zip(links, codes, strict=True):
        for answer in (httpx.get(link), httpx.post(f"{experimenter.base_url}/code", data={"code": code})):
            assert answer.headers["location"] == "/entered"
    assert [row.contact.note for row in rehearsed.store.progress()[:3]] == ["Tuesday"] * 3


def test_who_looks_on_sees_the_study_and_takes_the_answers_but_changes_nothing(site: Site) -> None:
    failing = replace(site, backup_fault=lambda: "No space left on device")
    with running(create_app(failing)) as address:
        editor, viewer = (httpx.Client(base_url=address, follow_redirects=True) for _ in range(2))
        with editor, viewer:
            editor.post("/experimenter/login", data={"password": PASSWORD})
            invitation = {"form_token": form_token(editor), "count": "1", "note": "Ada of room 3"}
            assert editor.post("/experimenter/links", data=invitation).status_code == 200
            viewer.post("/experimenter/login", data={"password": VIEWER})
            seen, whole = viewer.get("/experimenter").text, editor.get("/experimenter").text
            for page in (seen, whole):
                assert "The latest backup failed (No space left on device)." in page
            assert re.findall(r'action="/experimenter/(\w+)"', seen) == ["logout"]
            assert ("Ada of room 3" in whole, "Ada of room 3" in seen) == (True, False)
            assert viewer.get("/experimenter/responses.csv").status_code == 200
            own = form_token(viewer)
            for refused in (
                viewer.get("/experimenter/study.db"),
                viewer.post("/experimenter/links", data=invitation | {"form_token": own}),
                viewer.post("/experimenter/phase", data={"form_token": own, "phase": "closed"}),
            ):
                assert refused.status_code == 403
            promoted = viewer.cookies["experimenter"].replace("view", "edit", 1)
            forged = httpx.get(f"{address}/experimenter/responses.csv", cookies={"experimenter": promoted})
            assert forged.status_code == 401, "a role is signed"
    assert failing.store.phase == "open"
