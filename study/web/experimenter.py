"""The experimenter's pages, behind a password: the running study, links for participants, and the data."""

from __future__ import annotations

import asyncio
import json
import tempfile
import threading
from collections.abc import AsyncIterator
from datetime import datetime
from pathlib import Path
from typing import Annotated

import segno
from babel.dates import format_skeleton, format_time
from fastapi import APIRouter, Form, Request
from fastapi.responses import RedirectResponse, Response, StreamingResponse
from markupsafe import Markup
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException

from stimuli.errors import InputError
from study.export import codebook, responses_csv, responses_json
from study.participants import Contact, new_participant, new_personal_code, token_of_code
from study.storage.backups import copy_database
from study.storage.store import Phase
from study.web.credentials import LOGIN_LASTS, Role
from study.web.language import load_language
from study.web.limits import count_wrong_guess, require_guesses_left
from study.web.overview import TROUBLES, may_see_report, overview
from study.web.pages import fill, render
from study.web.site import site_of
from study.web.visitor import language_of, speaking, to

COOKIE = "experimenter"
MOST_LINKS = 200  # made at once
LOOK_AGAIN_S = 2.0

router = APIRouter(prefix="/experimenter")
_one_try_at_a_time = threading.Lock()  # passwords are slow to check; guessing in parallel gains nothing


def role_of(request: Request) -> Role | None:
    """What somebody logged in may do."""
    site = site_of(request)
    return site.credentials.role_in(request.cookies.get(COOKIE, ""), site.clock())


def require_login(request: Request) -> str:
    """The cookie of somebody logged in."""
    if role_of(request) is None:
        raise HTTPException(401)
    return request.cookies[COOKIE]


def require_own_form(request: Request, form_token: str) -> None:
    """Whoever sends something must be logged in and have got the form from us."""
    if not site_of(request).credentials.is_form_token(form_token, require_login(request)):
        raise HTTPException(403)


def require_editor(request: Request) -> None:
    """Whoever only looks on may not do this."""
    require_login(request)
    if role_of(request) != "edit":
        raise HTTPException(403)


# In and out


@router.get("", name="experimenter")
def experimenter(request: Request) -> Response:
    """The page itself, or the way in."""
    language = language_of(request)
    if role_of(request) is None:
        return speaking(render(request, "login.html", language=language, fault=None), language)
    return _page(request, "experimenter.html")


@router.post("/login", name="login")
def login(request: Request, password: Annotated[str, Form(max_length=200)]) -> Response:
    """Give a cookie for the password."""
    site, language = site_of(request), language_of(request)
    require_guesses_left(request)
    with _one_try_at_a_time:
        role = site.credentials.role_of(password)
    if role is None:
        count_wrong_guess(request)
        say = load_language(language).text
        fault = say("This is not the password.")
        return render(request, "login.html", language=language, fault=fault, status=401)
    answer = to(request, "experimenter")
    answer.set_cookie(
        COOKIE,
        site.credentials.cookie(role, site.clock()),
        max_age=int(LOGIN_LASTS.total_seconds()),
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
        path="/experimenter",
    )
    return answer


@router.post("/logout", name="logout")
def logout(request: Request, form_token: Annotated[str, Form()]) -> Response:
    """Take the cookie back."""
    require_own_form(request, form_token)
    answer: RedirectResponse = to(request, "experimenter")
    answer.delete_cookie(COOKIE, path="/experimenter")
    return answer


# The running study


@router.get("/live", name="live")
async def live(request: Request) -> Response:
    """The study as it runs, by server-sent events: the page's live part, whenever it has changed."""
    require_login(request)

    async def changes() -> AsyncIterator[str]:
        shown = ""
        while role_of(request) and not (request.app.state.is_stopping() or await request.is_disconnected()):
            now = await run_in_threadpool(_live_part, request)
            if now != shown:
                yield "".join(f"data: {line}\n" for line in now.splitlines()) + "\n"
                shown = now
            await asyncio.sleep(LOOK_AGAIN_S)

    return StreamingResponse(changes(), media_type="text/event-stream")


@router.post("/phase", name="phase")
def enter_phase(
    request: Request, form_token: Annotated[str, Form()], phase: Annotated[Phase, Form()]
) -> Response:
    """Pause, resume or close the study."""
    require_editor(request)
    require_own_form(request, form_token)
    site = site_of(request)
    site.store.enter_phase(phase, now=site.clock())
    return to(request, "experimenter")


@router.post("/links", name="links")
def make_links(
    request: Request,
    form_token: Annotated[str, Form()],
    count: Annotated[int, Form(ge=1, le=MOST_LINKS)],
    note: Annotated[str, Form(max_length=100)] = "",
    test: Annotated[bool, Form()] = False,
) -> Response:
    """Invite participants: a sheet with links, codes and QR codes, shown this once. Only hashes are kept."""
    require_editor(request)
    require_own_form(request, form_token)
    site = site_of(request)
    invitations = []
    for _ in range(count):
        code = new_personal_code()
        token = token_of_code(code)
        kind = "test" if test else site.kind
        participant = new_participant(token, kind=kind, created_at=site.clock())
        site.store.add_participant(participant, Contact(note=note) if note else None)
        link = str(request.url_for("link", token=token))
        invitations.append({"name": participant.name, "code": code, "link": link, "picture": _qr(link)})
    return render(
        request,
        "invitations.html",
        language=language_of(request),
        invitations=invitations,
        note=note,
        door_url=str(request.url_for("entry")),
    )


# The data


@router.get("/responses.csv", name="responses")
def download_responses(request: Request) -> Response:
    """All answers as a table."""
    require_login(request)
    site = site_of(request)
    table = responses_csv(site.store, kind=site.kind, clips=site.clip_hashes)
    return _download(table, "text/csv; charset=utf-8", "responses.csv")


@router.get("/responses.codebook.json", name="codebook")
def download_codebook(request: Request) -> Response:
    """What the table's columns and values mean."""
    require_login(request)
    site = site_of(request)
    earlier = {sha256: before.protocol for sha256, before in site.earlier.items()}
    book = codebook(site.protocol, kind=site.kind, earlier=earlier)
    content = json.dumps(book, indent=2, ensure_ascii=False)
    return _download(content, "application/json", "responses.codebook.json")


@router.get("/responses.json", name="responses_json")
def download_json(request: Request) -> Response:
    """Everything about every session, with all that happened to its videos."""
    require_login(request)
    site = site_of(request)
    return _download(responses_json(site.store, kind=site.kind), "application/json", "responses.json")


@router.get("/study.db", name="backup")
def download_backup(request: Request) -> Response:
    """A copy of the whole database; it holds the participants' contacts too."""
    require_editor(request)
    database = site_of(request).store.file
    if database is None:
        raise HTTPException(404)
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / "study.db"
        copy_database(database, copy)
        return _download(copy.read_bytes(), "application/vnd.sqlite3", "study.db")


@router.get("/report.html", name="report")
def download_report(request: Request) -> Response:
    """The report of the data so far, unless it is sealed."""
    require_login(request)
    site = site_of(request)
    if site.analyse is None:
        raise HTTPException(404)
    if not may_see_report(site, overview(site)):
        raise HTTPException(403)
    with tempfile.TemporaryDirectory() as scratch:
        table, out = Path(scratch) / "responses.csv", Path(scratch) / "report"
        content = responses_csv(site.store, kind=site.kind, clips=site.clip_hashes)
        table.write_text(content, encoding="utf-8", newline="")
        try:
            site.analyse(table, out)
        except InputError as fault:  # nobody has answered yet
            return _no_report(request, str(fault).replace(f"{scratch}/", ""))
        return _download((out / "report.html").read_bytes(), "text/html; charset=utf-8", "report.html")


def _no_report(request: Request, why: str) -> Response:
    language = language_of(request)
    say = load_language(language).text
    heading = say("There is no report yet")
    return render(request, "message.html", language=language, heading=heading, message=why, status=404)


def _download(content: str | bytes, kind: str, name: str) -> Response:
    return Response(
        content, media_type=kind, headers={"Content-Disposition": f'attachment; filename="{name}"'}
    )


def _qr(link: str) -> Markup:
    return Markup(segno.make(link, error="m", micro=False).svg_inline(scale=3, border=2, omitsize=True))


def _page(request: Request, template: str) -> Response:
    site = site_of(request)
    return render(
        request,
        template,
        language=language_of(request),
        live=Markup(_live_part(request)),
        may_edit=role_of(request) == "edit",
        most_links=MOST_LINKS,
        kiosk_key=site.credentials.kiosk_key,
        form_token=site.credentials.form_token(require_login(request)),
    )


def _live_part(request: Request) -> str:
    site, language = site_of(request), language_of(request)
    seen = overview(site)
    locale = language.replace("-", "_")

    def moment(when: datetime) -> str:
        here = when.astimezone()
        return f"{format_skeleton('MMMd', here, locale=locale)}, {format_time(here, 'short', locale=locale)}"

    return fill(
        request.app,
        "overview.html",
        language=language,
        seen=seen,
        troubles=TROUBLES,
        moment=moment,
        may_edit=role_of(request) == "edit",
        has_backup=site.store.file is not None,
        has_report=site.analyse is not None,
        report_sealed=not may_see_report(site, seen),
        form_token=site.credentials.form_token(require_login(request)),
    )
