"""The door: by personal link, code or recruitment service, or, where it stands open, by just coming in."""

from __future__ import annotations

import re
from datetime import timedelta
from typing import Annotated

from fastapi import APIRouter, Form, Request
from fastapi.responses import Response
from starlette.exceptions import HTTPException

from study.participants import (
    Contact,
    Participant,
    new_participant,
    new_token,
    token_of_code,
    token_sha256,
)
from study.web.language import load_language
from study.web.limits import address_of, count_wrong_guess, limits_of, require, require_guesses_left
from study.web.pages import render
from study.web.site import site_of
from study.web.visitor import forget, language_of, participant_of, remember, speaking, to

EXTERNAL_ID = re.compile(r"[A-Za-z0-9_-]{1,200}")

router = APIRouter()


@router.get("/", name="entry")
def entry(request: Request) -> Response:
    """Whoever is sent by the recruitment service comes in at once; others may start, or give their code."""
    site, language = site_of(request), language_of(request)
    if external_id := request.query_params.get(site.protocol.participants.recruitment.parameter or ""):
        return _recruited(request, external_id)
    if participant_of(request):
        return to(request, "study")
    return speaking(_door(request, language), language)


def _door(request: Request, language: str, *, fault: str | None = None) -> Response:
    phase = site_of(request).store.phase
    status = 404 if fault else 200
    return render(request, "entry.html", language=language, status=status, phase=phase, fault=fault)


def _recruited(request: Request, external_id: str) -> Response:
    """The same person is the same participant, however often they are sent."""
    site = site_of(request)
    service = site.protocol.participants.recruitment.service
    if not EXTERNAL_ID.fullmatch(external_id):
        raise HTTPException(404)
    require(limits_of(request).entries, address_of(request))
    token = site.credentials.token_for(f"{service}:{external_id}")
    if site.store.participant(token_sha256(token)) is None:
        participant = new_participant(token, kind=site.kind, created_at=site.clock())
        site.store.recruit(participant, Contact(source=service, external_id=external_id))
    return remember(request, token)


@router.post("/start", name="start")
def start(request: Request) -> Response:
    """Somebody starts without a link."""
    site = site_of(request)
    if site.door == "link":
        raise HTTPException(403)
    if site.store.phase != "open":  # paused or closed while they looked at the button
        return to(request, "entry")
    if participant_of(request):  # a double click
        return to(request, "study")
    require(limits_of(request).entries, address_of(request))
    token = new_token()
    site.store.add_participant(new_participant(token, kind=site.kind, created_at=site.clock()))
    return remember(request, token)


@router.get("/p/{token}", name="link")
def link(request: Request, token: str) -> Response:
    """A personal link. The token leaves the address at once and stays in a cookie no script can read.

    A right one opens, however often others guessed at the same address: of 2⁴⁹ codes none is found that way.
    """
    invited = site_of(request).store.participant(token_sha256(token))
    if invited is None:
        require_guesses_left(request)
        count_wrong_guess(request)
        raise HTTPException(404)
    _require_in_time(request, invited)
    return remember(request, token)


@router.post("/code", name="code")
def code(request: Request, code: Annotated[str, Form(max_length=40)]) -> Response:
    """A personal code, for where one types and does not click."""
    token, language = token_of_code(code), language_of(request)
    invited = site_of(request).store.participant(token_sha256(token))
    if invited is None:
        require_guesses_left(request)
        count_wrong_guess(request)
        say = load_language(language).text
        return _door(request, language, fault=say("This code is not known."))
    _require_in_time(request, invited)
    return remember(request, token)


@router.get("/entered", name="entered")
def entered(request: Request) -> Response:
    """On to the page that is due; a browser that keeps no cookie is told so instead of welcomed for ever."""
    if participant_of(request) is None:
        raise HTTPException(428)
    return to(request, "study")


def _require_in_time(request: Request, invited: Participant) -> None:
    """An invitation that is not followed in time opens nothing any more; whoever has begun may go on."""
    site = site_of(request)
    last = timedelta(seconds=site.protocol.participants.links_last)
    if site.clock() - invited.created_at > last and site.store.session(invited.name) is None:
        raise HTTPException(410)


# Handing the browser on


@router.get("/next", name="next")
def ask_for_key(request: Request) -> Response:
    """In a laboratory's kiosk only the experimenter opens the door to the next participant."""
    return _next(request, language_of(request))


@router.post("/next")
def next_participant(request: Request, key: Annotated[str, Form(max_length=40)] = "") -> Response:
    """The session is over and the next participant may use this browser."""
    site, language = site_of(request), language_of(request)
    if site.door == "kiosk":
        require_guesses_left(request)
        if not site.credentials.is_kiosk_key(key.strip()):
            count_wrong_guess(request)
            say = load_language(language).text
            fault = say("This is not the key.")
            return _next(request, language, fault=fault)
    return forget(to(request, "entry"))


def _next(request: Request, language: str, *, fault: str | None = None) -> Response:
    """The page that asks for the key; whoever came there by mistake finds their way back."""
    known = participant_of(request) is not None
    status = 403 if fault else 200
    return render(request, "next.html", language=language, status=status, known=known, fault=fault)
