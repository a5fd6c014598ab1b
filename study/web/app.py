"""The application: routes, guards, and what is said when something is not found."""

from __future__ import annotations

import logging

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, JSONResponse, Response
from sqlalchemy.exc import DataError, DBAPIError, IntegrityError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from study.storage.database import ServedByAnotherError
from study.web import entry, experimenter, participant
from study.web.language import load_language
from study.web.limits import Limits
from study.web.pages import STATIC, render, static_version
from study.web.security import HEADERS, Guard
from study.web.site import Site
from study.web.turns import Turns
from study.web.visitor import has_token, language_of

LONGEST_BODY = 256 * 1024
"""Bytes. An answered page with its playback records has some 10 kB; one of two clips with all the happenings
that are kept and the five longest texts, in letters of three bytes, has 210 kB, and must not be refused."""
TRY_AGAIN_S = 5
FOR_EVER = {"Cache-Control": "public, max-age=31536000, immutable"}

logger = logging.getLogger(__name__)


def create_app(site: Site) -> FastAPI:
    """The application that serves a study."""
    app = FastAPI(
        title=site.protocol.study,
        openapi_url=None,
        max_body_size=LONGEST_BODY,
        telemetry={"tracing": False, "metrics": False, "logs": False},  # a study tells nobody anything
    )
    app.state.site = site
    app.state.limits = Limits()
    app.state.turns = Turns(site.store)
    app.state.is_stopping = lambda: False  # the server knows better
    for router in (participant.router, entry.router, experimenter.router):  # looked for in this order
        app.router.routes.extend(router.routes)  # `include_router` would match every request twice
    app.add_middleware(Guard)
    clips = {clip.name: clip for one in (site, *site.earlier.values()) for clip in one.clips.values()}
    static = {file.name: file for file in STATIC.iterdir()}

    @app.get("/clips/{name}")
    def clip(name: str) -> Response:
        """A video, whole or in ranges."""
        if name not in clips:
            raise HTTPException(404)
        return FileResponse(clips[name].path, media_type="video/mp4", headers=FOR_EVER)

    @app.get("/static/{version}/{name}")
    def static_file(version: str, name: str) -> Response:
        """A style sheet or a script."""
        if name not in static:
            raise HTTPException(404)
        return FileResponse(static[name], headers=FOR_EVER if version == static_version() else None)

    @app.exception_handler(HTTPException)
    async def say_what_went_wrong(request: Request, fault: HTTPException) -> Response:
        """A page for people, JSON for the page's scripts."""
        if request.method == "POST" and request.headers.get("content-type") == "application/json":
            return JSONResponse({"reason": str(fault.detail)}, fault.status_code, fault.headers)
        language = language_of(request)
        if fault.status_code == 401:
            return render(request, "login.html", language=language, status=401, fault=None)
        say = load_language(language).text
        heading, message = {
            404: (
                say("This page is not here"),
                say("The address may be mistyped. Please use the link you were given."),
            ),
            410: (
                say("This invitation has expired"),
                say("Please ask the experimenter for a new one."),
            ),
            428: (
                say("Your browser keeps no cookies"),
                say("The study needs one. Please allow cookies, then open your link again."),
            ),
            429: (
                say("Please wait a little"),
                say("There were too many attempts. Please try again in a minute."),
            ),
            500: (
                say("This did not work"),
                say("What you sent before is safe. Please wait a minute, then reload this page."),
            ),
            503: (
                say("Nothing can be stored at the moment"),
                say("What you sent before is safe. Please wait a minute, then reload this page."),
            ),
        }.get(fault.status_code, (say("This did not work"), say("Please go back and try again.")))
        page = render(
            request,
            "message.html",
            language=language,
            status=fault.status_code,
            heading=heading,
            message=message,
            way_back=has_token(request),
        )
        page.headers.update(fault.headers or {})
        return page

    @app.exception_handler(RequestValidationError)
    async def say_what_is_malformed(_: Request, fault: RequestValidationError) -> Response:
        """The first fault is enough: only programs see it."""
        first = fault.errors()[0]
        return JSONResponse({"reason": f"{'.'.join(map(str, first['loc']))}: {first['msg']}"}, 422)

    @app.exception_handler(IntegrityError)
    async def say_that_it_contradicts(_: Request, __: IntegrityError) -> Response:
        """Such as an answer under way from somebody who withdrew meanwhile."""
        site.store.forget()
        return JSONResponse({"reason": "contradicts what is stored"}, 409)

    @app.exception_handler(DataError)
    async def say_that_it_cannot_be_kept(request: Request, _: DataError) -> Response:
        """Such as the character of code 0, in PostgreSQL."""
        return await say_what_went_wrong(request, HTTPException(400, "cannot be stored"))

    @app.exception_handler(DBAPIError)
    @app.exception_handler(ServedByAnotherError)
    async def say_that_nothing_can_be_stored(
        request: Request, fault: DBAPIError | ServedByAnotherError
    ) -> Response:
        """The disk is full, the database away or served by another: browsers send it again."""
        logger.error("Nothing can be stored: %s", fault.orig if isinstance(fault, DBAPIError) else fault)
        site.store.forget()
        unavailable = HTTPException(503, "cannot be stored now", {"Retry-After": str(TRY_AGAIN_S)})
        return await say_what_went_wrong(request, unavailable)

    @app.exception_handler(ClientDisconnect)
    async def say_nothing(_: Request, __: ClientDisconnect) -> Response:
        """Who left while they were sending hears nothing any more; their browser sends it again."""
        return Response(status_code=400)

    @app.exception_handler(Exception)
    async def say_that_the_fault_is_ours(request: Request, _: Exception) -> Response:
        """Told from outside the guard; the server's log has what it was."""
        page = await say_what_went_wrong(request, HTTPException(500))
        page.headers.update(HEADERS)
        return page

    return app
