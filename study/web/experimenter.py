"""The experimenter's page: who is where, links for participants, and the data, behind a password."""

from __future__ import annotations

import json
import threading
from typing import Annotated

from babel.dates import format_datetime
from fastapi import APIRouter, Form, Request
from fastapi.responses import RedirectResponse, Response
from starlette.exceptions import HTTPException

from study.export import codebook, responses_csv
from study.participants import Contact, new_participant, new_token
from study.sessions import next_step
from study.web.credentials import LOGIN_LASTS
from study.web.language import load_language
from study.web.pages import render
from study.web.participant import steps_of
from study.web.site import Site, hashes, site_of
from study.web.visitor import language_of

COOKIE = "experimenter"
MOST_LINKS = 200  # made at once

router = APIRouter(prefix="/experimenter")
_one_try_at_a_time = (
    threading.Lock()
)  # passwords are slow to check on purpose; guessing in parallel gains nothing


def cookie_of(request: Request) -> str | None:
    """The cookie of somebody logged in."""
    site, cookie = site_of(request), request.cookies.get(COOKIE, "")
    return cookie if site.credentials.is_cookie(cookie, site.clock()) else None


def require_login(request: Request, form_token: str | None = None) -> str:
    """The cookie of somebody logged in; whoever changes something must also have got the form from us."""
    cookie = cookie_of(request)
    if cookie is None:
        raise HTTPException(401)
    if form_token is not None and not site_of(request).credentials.is_form_token(form_token, cookie):
        raise HTTPException(403)
    return cookie


@router.get("", name="experimenter")
def overview(request: Request) -> Response:
    """The page itself, or the way in."""
    if cookie_of(request) is None:
        return render(request, "login.html", language=language_of(request), fault=None)
    return _overview(request, links=[])


@router.post("/login", name="login")
def login(request: Request, password: Annotated[str, Form(max_length=200)]) -> Response:
    """Give a cookie for the password."""
    site, language = site_of(request), language_of(request)
    with _one_try_at_a_time:
        right = site.credentials.is_password(password)
    if not right:
        say = load_language(language).text
        fault = say("This is not the password.")
        return render(request, "login.html", language=language, fault=fault, status=401)
    answer = RedirectResponse(request.app.url_path_for("experimenter"), status_code=303)
    answer.set_cookie(
        COOKIE,
        site.credentials.cookie(site.clock()),
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
    require_login(request, form_token)
    answer = RedirectResponse(request.app.url_path_for("experimenter"), status_code=303)
    answer.delete_cookie(COOKIE, path="/experimenter")
    return answer


@router.post("/links", name="links")
def make_links(
    request: Request,
    form_token: Annotated[str, Form()],
    count: Annotated[int, Form(ge=1, le=MOST_LINKS)],
    note: Annotated[str, Form(max_length=100)] = "",
    test: Annotated[bool, Form()] = False,
) -> Response:
    """Invite participants. Their links are shown this once: only hashes of them are kept."""
    require_login(request, form_token)
    site = site_of(request)
    links = []
    for _ in range(count):
        token = new_token()
        kind = "test" if test else site.kind
        participant = new_participant(token, kind=kind, created_at=site.clock())
        site.store.add_participant(participant, Contact(note=note) if note else None)
        links.append(str(request.url_for("link", token=token)))
    return _overview(request, links=links)


@router.get("/responses.csv", name="responses")
def download_responses(request: Request) -> Response:
    """All answers as a table."""
    require_login(request)
    site = site_of(request)
    return _download(
        responses_csv(site.store, site.protocol, kind=site.kind, clips=hashes(site.clips)),
        "text/csv",
        "responses.csv",
    )


@router.get("/responses.codebook.json", name="codebook")
def download_codebook(request: Request) -> Response:
    """What the table's columns and values mean."""
    require_login(request)
    site = site_of(request)
    content = json.dumps(codebook(site.protocol, kind=site.kind), indent=2, ensure_ascii=False)
    return _download(content, "application/json", "responses.codebook.json")


def _download(content: str, kind: str, name: str) -> Response:
    disposition = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(content, media_type=f"{kind}; charset=utf-8", headers=disposition)


def _overview(request: Request, *, links: list[str]) -> Response:
    site, language = site_of(request), language_of(request)
    rows = _rows(site)
    counted = [row for row in rows if row["kind"] == site.kind]
    return render(
        request,
        "experimenter.html",
        language=language,
        rows=rows,
        counts={state: sum(row["state"] == state for row in counted) for state in STATES},
        planned=site.protocol.participants.planned,
        links=links,
        most_links=MOST_LINKS,
        moment=lambda when: format_datetime(
            when.astimezone(), "d MMM, HH:mm", locale=language.replace("-", "_")
        ),
        form_token=site.credentials.form_token(require_login(request)),
    )


STATES = ("invited", "active", "stalled", "completed")


def _rows(site: Site) -> list[dict[str, object]]:
    now = site.clock()
    failures = site.store.event_counts("video_failed")
    rows = []
    for person in site.store.progress():
        session = person.session
        pages = steps_of(site, session) if session else ()
        step = next_step(pages, person.answered)
        ended_at = session and (session.completed_at or person.active_at)
        quiet_s = (now - person.active_at).total_seconds() if person.active_at else 0
        stalled = quiet_s > site.protocol.participants.abandoned_after
        state = (
            "invited"
            if session is None
            else "completed"
            if step is None
            else "stalled"
            if stalled
            else "active"
        )
        rows.append(
            {
                "name": person.participant.name,
                "kind": person.participant.kind,
                "note": person.contact.note,
                "state": state,
                "place": len(person.answered),
                "pages": len(pages),
                "step": step.key if step else "",
                "slot": session.plan.slot + 1 if session else None,
                "begun_at": session.begun_at if session else None,
                "minutes": (ended_at - session.begun_at).total_seconds() / 60
                if session and ended_at
                else None,
                "failed_videos": failures.get(person.participant.name, 0),
            }
        )
    return rows
