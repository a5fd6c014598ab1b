"""The participant's pages: consent, the session step by step, the end, and withdrawal."""

from __future__ import annotations

import asyncio
import hashlib
from collections.abc import Collection, Mapping
from datetime import datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Form, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from starlette.exceptions import HTTPException

from study.orders import draw_plan
from study.participants import Participant, new_completion_code
from study.questions import AnswerError, Question
from study.responses import Submission, playback_fault
from study.sessions import Pages, Session, Step, Verdict, judge, next_step, plan_sha256, steps
from study.storage.store import Visit
from study.web.language import load_language
from study.web.limits import count_wrong_guess, limits_of, require, require_guesses_left
from study.web.pages import render
from study.web.site import Site, site_of
from study.web.step_pages import asked, step_page
from study.web.visitor import forget, has_token, language_of, participant_of, speaking, to, visit_of

router = APIRouter()


class Event(BaseModel):
    """Something the page wants written down."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(max_length=40, pattern=r"^[a-z_]+$")
    detail: str = Field("", max_length=500)


def steps_of(site: Site, session: Session, given: Mapping[str, Collection[str]] | None = None) -> Pages:
    """The pages of a session, as the answers given so far lead to; those are looked up unless told."""
    conditional = [part for part in site.protocol.parts.values() if part.only_if]
    if conditional and given is None:
        given = site.store.given(session.participant)
    left_out = frozenset(part.id for part in conditional if not part.due(given or {}))
    return steps(session.plan, demographics=bool(site.protocol.demographics), left_out=left_out)


def questions_of(site: Site, step: Step) -> tuple[Question, ...]:
    """What is asked on a page."""
    return tuple(question for question, _, _ in asked(site, step))


# The session


# The two addresses of every page are plain routes: FastAPI's way of taking a request apart costs as much as
# all that is done here.


@router.route("/study", name="study")
async def study(request: Request) -> Response:
    """The page that is due, whatever was open before."""
    await request.app.state.turns.wait()
    site, visit = site_of(request), await visit_of(request)
    if visit is None:
        return to(request, "entry")
    session, phase = visit.session, site.store.phase
    if phase == "paused" or (phase == "closed" and session is None):
        return _not_now(request, visit.participant, paused=phase == "paused")
    if session is None:
        language = language_of(request)
        page = render(request, "consent.html", language=language, kind=visit.participant.kind)
        return speaking(page, language)
    begun = site.as_begun(session)
    if begun is None:
        return _changed(request, visit.participant, session.language)
    pages = steps_of(begun, session, visit.given)
    step = next_step(pages, visit.answered)
    if step is None:
        return _the_end(request, begun, visit.participant, session)
    now = site.clock()
    if step.key in visit.shown:
        require(limits_of(request).sendings, visit.participant.name)
        site.store.log("page_reopened", step.key, participant=visit.participant.name, now=now)
    else:
        site.store.show_page(visit, step.key, now=now)
    return step_page(request.app, begun, visit.participant, session, step, pages)


def _the_end(request: Request, begun: Site, participant: Participant, session: Session) -> Response:
    site, language = site_of(request), session.language
    recruitment = site.protocol.participants.recruitment
    external_id = site.store.contact(participant.name).external_id if recruitment.completion_url else None
    return render(
        request,
        "debrief.html",
        language=language,
        kind=participant.kind,
        study_title=begun.protocol.title.in_(language),
        debrief=begun.protocol.texts.debrief.in_(language),
        completion_code=session.completion_code,
        service=recruitment.called,
        completion_url=recruitment.completion_address(external_id=external_id, code=session.completion_code),
    )


def _not_now(request: Request, participant: Participant, *, paused: bool) -> Response:
    language = language_of(request)
    say = load_language(language).text
    message = (
        say("Your answers are stored. Please come back to this page later; you go on where you were.")
        if paused
        else say("Nobody can begin any more. Thank you for your interest.")
    )
    return render(
        request,
        "message.html",
        language=language,
        kind=participant.kind,
        heading=say("The study is paused") if paused else say("The study is closed"),
        message=message,
    )


def _changed(request: Request, participant: Participant, language: str) -> Response:
    """They began with a version of the study that is not kept."""
    say = load_language(language).text
    return render(
        request,
        "message.html",
        language=language,
        kind=participant.kind,
        heading=say("The study has changed"),
        message=say("It was changed after you began. Your answers so far are stored; thank you."),
    )


@router.post("/consent", name="consent")
def consent(request: Request, agreed: Annotated[str, Form()], language: Annotated[str, Form()]) -> Response:
    """Consent: the moment the session begins and all its orders are drawn and kept."""
    site, participant = site_of(request), participant_of(request)
    if participant is None:  # withdrawn in another tab
        return to(request, "entry")
    if agreed != "yes" or language not in site.protocol.languages:
        raise HTTPException(400)
    if site.store.phase != "open":
        return to(request, "study")
    now = site.clock()

    def draw(slot: int) -> Session:
        plan = draw_plan(site.protocol, slot)
        return Session(
            participant=participant.name,
            plan=plan,
            plan_sha256=plan_sha256(plan),
            protocol_sha256=site.protocol.sha256,
            software=site.software,
            language=language,
            consent_sha256=hashlib.sha256(site.protocol.texts.consent.in_(language).encode()).hexdigest(),
            completion_code=new_completion_code(),
            begun_at=now,
        )

    stale_after = timedelta(seconds=site.protocol.participants.abandoned_after)
    site.store.begin_session(participant, draw, now=now, stale_after=stale_after)
    return to(request, "study")


@router.route("/study/answers", methods=["POST"], name="answers")
async def answers(request: Request) -> JSONResponse:
    """Store an answered page. 200: it is on disk. 409: another page is due. 422: this cannot be an answer."""
    submission = await _submission_in(request)
    site, visit = site_of(request), await visit_of(request)
    if visit is None or visit.session is None:
        return JSONResponse({"reason": "no session"}, 409)
    require(limits_of(request).sendings, visit.participant.name)
    values = submission.values
    given = {item: {answer, *visit.given.get(item, ())} for item, answer in values.items()}
    begun = site.as_begun(visit.session)
    if begun is None:
        return JSONResponse({"reason": "the study has changed"}, 409)
    pages = steps_of(begun, visit.session, {**visit.given, **given})
    verdict = judge(submission.id, submission.step, pages=pages, answered=visit.answered)
    if verdict is Verdict.STORE:
        due = next(page for page in pages if page.key == submission.step)
        now = site.clock()
        if fault := _fault(begun, visit, due, submission, now):
            return JSONResponse({"reason": fault}, 422)
        storing = site.store.add_response(visit, submission, steps=pages, now=now)
        verdict = await asyncio.wrap_future(storing)
        if next_step(pages, {*visit.answered, submission.step}) is None:
            await _close_when_complete(site, visit.participant, now)
    stored = verdict in {Verdict.STORE, Verdict.KNOWN}
    return JSONResponse({"reason": verdict.value}, 200 if stored else 409)


async def _submission_in(request: Request) -> Submission:
    content = await request.body()
    kind, _, _ = request.headers.get("content-type", "").partition(";")
    if kind.strip().lower() != "application/json":  # as other sites' forms
        raise RequestValidationError([{"loc": ("content-type",), "msg": "must be application/json"}])
    try:
        return Submission.model_validate_json(content)
    except ValidationError as fault:
        raise RequestValidationError(fault.errors()) from fault


async def _close_when_complete(site: Site, participant: Participant, now: datetime) -> None:
    """Somebody has completed the study: if they are the last planned, nobody else may begin."""
    rules = site.protocol.participants
    if rules.stop == "when complete" and participant.kind == "participant":
        await asyncio.wrap_future(site.store.close_when(rules.planned, now=now))


@router.post("/study/events", name="events", status_code=204)
def events(request: Request, event: Event) -> Response:
    """Write down what happened on a page, such as a video that failed."""
    site, participant = site_of(request), participant_of(request)
    if participant is None:
        raise HTTPException(409)
    require(limits_of(request).sendings, participant.name)
    site.store.log(event.name, event.detail, participant=participant.name, now=site.clock()).result()
    return Response(status_code=204)


# Withdrawal


@router.get("/withdraw", name="withdraw")
def ask_to_withdraw(request: Request) -> Response:
    """Whether they are sure."""
    known = participant_of(request) is not None
    return render(request, "withdraw.html", language=language_of(request), known=known, fault=None)


@router.post("/withdraw")
def withdraw(
    request: Request, sure: Annotated[str, Form()], code: Annotated[str, Form(max_length=40)] = ""
) -> Response:
    """Delete everything about whoever holds the cookie or the code."""
    site, language, participant = site_of(request), language_of(request), participant_of(request)
    say = load_language(language).text
    if sure != "yes":
        raise HTTPException(400)
    if participant is None and not code and has_token(request):
        return _withdrawn(request, language)  # sent twice: the first has deleted everything
    if participant is None:
        require_guesses_left(request)
    name = participant.name if participant else site.store.participant_with_code(code.strip().upper())
    if name is None:
        count_wrong_guess(request)
        fault = say("This code is not known. Please check it, or write to us.")
        return render(request, "withdraw.html", language=language, known=False, fault=fault, status=404)
    site.store.withdraw(name, now=site.clock())
    return _withdrawn(request, language)


def _withdrawn(request: Request, language: str) -> Response:
    say = load_language(language).text
    answer = render(
        request,
        "message.html",
        language=language,
        heading=say("Your answers are deleted"),
        message=say("You have withdrawn from the study. Thank you for your time."),
    )
    return forget(answer)


def _fault(site: Site, visit: Visit, step: Step, submission: Submission, now: datetime) -> str | None:
    values = submission.values
    try:
        for question in questions_of(site, step):
            question.check({item: values.pop(item) for item in question.items if item in values})
    except AnswerError as fault:
        return str(fault)
    if values:
        return f"{next(iter(values))} is not asked here"
    clips = site.clips_on(step.trial) if step.trial else {}
    durations_s = {role: clip.duration_s for role, clip in clips.items()}
    shown_at = visit.shown_at(step.key)
    elapsed_s = (now - shown_at).total_seconds() if shown_at else 0.0
    return playback_fault(
        submission.views,
        durations_s,
        elapsed_s=None if visit.participant.kind == "simulated" else elapsed_s,
        replays=site.protocol.video.replays,
    )
