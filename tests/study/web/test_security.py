"""What the checklist for security asks for, where no other test holds it already."""

from __future__ import annotations

import re
import sqlite3
import stat
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from uuid import uuid4

import httpx
import pytest

from study.export import guarded
from study.participants import new_participant, new_token, token_sha256
from study.web.app import create_app
from study.web.credentials import open_credentials
from study.web.limits import Limits
from study.web.pages import prose
from study.web.server import running
from study.web.site import Site

FORWARDED = {"X-Forwarded-Proto": "https", "X-Forwarded-For": "203.0.113.7"}


@pytest.mark.parametrize(
    "markdown",
    [
        "<script>alert(1)</script>",
        "<img src=x onerror=alert(1)>",
        "![picture](https://elsewhere.example/pixel.png)",
        "[click](javascript:alert(1))",
        "<a href='data:text/html,<script>alert(1)</script>'>click</a>",
        "<iframe src=https://elsewhere.example></iframe>",
        "<p style='position:fixed' onclick=alert(1)>text</p>",
        "<form action=https://elsewhere.example><input name=password></form>",
    ],
)
def test_texts_of_a_protocol_can_neither_run_nor_load_anything(markdown: str) -> None:
    shown = prose(markdown)
    assert not re.search(
        r"<(script|img|iframe|form|input|style)|\son\w+=|style=|(href|src)=.?(javascript|data):", shown
    ), shown


def test_markdown_itself_is_kept() -> None:
    assert prose("**Yes** [link](https://example.org)") == (
        '<p><strong>Yes</strong> <a href="https://example.org" rel="noopener">link</a></p>\n'
    )


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_no_cell_is_a_formula(start: str) -> None:
    assert guarded(f"{start}cmd|' /C calc'!A0").startswith(f"'{start}")


def test_tokens_have_128_bits_and_are_nowhere_on_the_disk(site: Site) -> None:
    tokens = [new_token() for _ in range(50)]
    assert len(set(tokens)) == 50
    assert all(re.fullmatch(r"[\w-]{22}", token) for token in tokens)
    for token in tokens:
        site.store.add_participant(new_participant(token, kind="participant", created_at=site.clock()))
    file = site.store.file
    assert file
    written = b"".join(path.read_bytes() for path in file.parent.iterdir())
    assert token_sha256(tokens[0]).encode() in written
    assert not any(token.encode() in written for token in tokens)


def test_the_password_is_kept_as_a_hash_for_our_eyes_only(tmp_path: Path) -> None:
    credentials, passwords = open_credentials(tmp_path)
    file = tmp_path / "experimenter.json"
    assert passwords
    assert passwords.edit not in file.read_text()
    assert passwords.view not in file.read_text()
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    again, shown = open_credentials(tmp_path)
    assert (again, shown) == (credentials, None)
    assert again.role_of(passwords.edit) == "edit"
    assert again.role_of(passwords.view) == "view"
    assert replace(again, viewer_hash=b"").role_of("") is None


def test_behind_a_proxy_cookies_are_secure_and_allowances_are_each_visitor_s(site: Site) -> None:
    with running(create_app(site)) as address:
        started = httpx.post(f"{address}/start", headers=FORWARDED | {"Host": "study.example"})
        assert "secure" in started.headers["set-cookie"].lower()
        assert "secure" not in httpx.post(f"{address}/start").headers["set-cookie"].lower()
        guesses = (
            httpx.post(f"{address}/code", data={"code": "wrong"}, headers=FORWARDED) for _ in range(30)
        )
        assert 429 in (guess.status_code for guess in guesses)
        assert httpx.post(f"{address}/code", data={"code": "wrong"}).status_code == 404


def test_behind_a_proxy_invitations_name_the_host_that_participants_use(site: Site) -> None:
    proxied = FORWARDED | {"Host": "study.example.org"}
    with running(create_app(site), host="0.0.0.0") as address:
        port = address.rpartition(":")[2]
        for base, headers, expected in (
            (f"http://127.0.0.1:{port}", proxied, "https://study.example.org/p/"),
            (f"http://localhost:{port}", {}, f"http://localhost:{port}/p/"),
        ):
            entered = httpx.post(
                f"{base}/experimenter/login", data={"password": "correct horse"}, headers=headers
            )
            login = headers | {"Cookie": entered.headers["set-cookie"].partition(";")[0]}
            page = httpx.get(f"{base}/experimenter", headers=login).text
            token = re.findall(r'name="form_token" value="(\w+)"', page)[0]
            sheet = httpx.post(
                f"{base}/experimenter/links",
                data={"form_token": token, "count": 1},
                headers=login | {"Origin": expected.removesuffix("/p/")},
            )
            assert f'href="{expected}' in sheet.text


def test_one_participant_cannot_flood_the_study(site: Site) -> None:
    app = create_app(site)
    app.state.limits = replace(Limits(), sendings=replace(Limits().sendings, most=3, per_s=0.001))
    with running(app) as address, httpx.Client(base_url=address, follow_redirects=True) as visitor:
        visitor.post("/start")
        visitor.post("/consent", data={"agreed": "yes", "language": "en"})
        event = {"name": "video_retried", "detail": "503"}
        sent = [visitor.post("/study/events", json=event).status_code for _ in range(4)]
        answer = {"id": str(uuid4()), "step": "demographics", "on_page_ms": 1}
        refused = visitor.post("/study/answers", json=answer)
        assert visitor.get("/study").status_code == 429  # opened again, which would be noted
    assert sent == [204, 204, 204, 429]
    assert (refused.status_code, int(refused.headers["retry-after"]) > 0) == (429, True)


def test_an_id_of_somebody_else_s_answer_is_refused_and_harms_nobody(site: Site) -> None:
    sent = {"id": str(uuid4()), "step": "demographics", "on_page_ms": 1}
    statuses = []
    with running(create_app(site)) as address:
        for _ in range(2):
            with httpx.Client(base_url=address, follow_redirects=True) as visitor:
                visitor.post("/start")
                visitor.post("/consent", data={"agreed": "yes", "language": "en"})
                statuses.append(visitor.post("/study/answers", json=sent).status_code)
                mine = sent | {"id": str(uuid4())}
                statuses.append(visitor.post("/study/answers", json=mine).status_code)
    assert statuses == [200, 409, 409, 200]


def test_no_secret_is_logged(site: Site, capfd: pytest.CaptureFixture[str]) -> None:
    token = new_token()
    site.store.add_participant(new_participant(token, kind="participant", created_at=site.clock()))
    with running(create_app(site)) as address:
        httpx.get(f"{address}/p/{token}")
        httpx.get(f"{address}/p/{token}x")
        httpx.post(f"{address}/experimenter/login", data={"password": "not the password"})
        httpx.post(f"{address}/code", data={"code": "abcde-fghjk"})
    assert capfd.readouterr() == ("", "")


def test_contacts_are_apart_from_answers(site: Site) -> None:
    """Whoever is given the tables of answers alone learns nobody's name."""
    file = site.store.file
    assert file
    with closing(sqlite3.connect(file)) as db:
        tables = {name for (name,) in db.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        columns = {table: {row[1] for row in db.execute(f"PRAGMA table_info({table})")} for table in tables}
    telling = {"note", "source", "external_id"}
    assert {table for table, found in columns.items() if found & telling} == {"contacts"}
