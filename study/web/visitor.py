"""Who is visiting: the cookies of a participant and of a language, and what they are refused."""

from __future__ import annotations

import asyncio

from fastapi import Request
from fastapi.responses import RedirectResponse, Response

from study.participants import Participant, token_sha256
from study.storage.store import Visit
from study.web.language import preferred
from study.web.pages import url
from study.web.site import site_of

TOKEN = "participant"  # the cookie that holds the token of a personal link
LANGUAGE = "language"
COOKIE_LASTS_S = 30 * 24 * 3600


def language_of(request: Request) -> str:
    """The language asked for by the address, chosen before, or liked best by the browser."""
    offered = site_of(request).protocol.languages
    for wish in (request.query_params.get("lang"), request.cookies.get(LANGUAGE)):
        if wish in offered:
            return wish
    return preferred(request.headers.get("accept-language", ""), offered)


def participant_of(request: Request) -> Participant | None:
    """Whose cookie came with the request."""
    token = request.cookies.get(TOKEN)
    return site_of(request).store.participant(token_sha256(token)) if token else None


def has_token(request: Request) -> bool:
    """Whether somebody was let in by this browser, be it that they have withdrawn since."""
    return bool(request.cookies.get(TOKEN))


async def visit_of(request: Request) -> Visit | None:
    """Whose cookie came with the request, and how far they have come."""
    token, store = request.cookies.get(TOKEN), site_of(request).store
    if token is None:
        return None
    known = token_sha256(token)
    return store.remembered(known) or await asyncio.wrap_future(store.visit(known))


def to(request: Request, name: str) -> RedirectResponse:
    """The way to another page."""
    return RedirectResponse(url(request.app, name), status_code=303)


def remember(request: Request, token: str) -> Response:
    """Keep the token in a cookie that no script can read, and see that the browser brings it back."""
    answer = to(request, "entered")
    secure = request.url.scheme == "https"
    answer.set_cookie(TOKEN, token, max_age=COOKIE_LASTS_S, httponly=True, samesite="lax", secure=secure)
    if (language := request.query_params.get("lang")) in site_of(request).protocol.languages:
        return speaking(answer, language)
    return answer


def forget(answer: Response) -> Response:
    """Leave nothing of the participant in the browser."""
    answer.delete_cookie(TOKEN)
    answer.headers["Clear-Site-Data"] = '"cookies", "storage"'
    return answer


def speaking(answer: Response, language: str) -> Response:
    """Keep the language."""
    answer.set_cookie(LANGUAGE, language, max_age=COOKIE_LASTS_S, httponly=True, samesite="lax")
    return answer
