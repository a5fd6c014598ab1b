"""The participant's pages: entry, consent, the session step by step, the end, and withdrawal."""

from __future__ import annotations

import hashlib
from datetime import timedelta
from typing import Annotated, Any

from fastapi import APIRouter, Form, Request
from fastapi.responses import JSONResponse, RedirectResponse, Response
from pydantic import BaseModel, ConfigDict, Field
from starlette.exceptions import HTTPException

from study.orders import draw_plan
from study.participants import Participant, new_completion_code, new_participant, new_token, token_sha256
from study.questions import AnswerError, Question
from study.responses import Submission, playback_fault
from study.sessions import Session, Step, Verdict, judge, next_step, plan_sha256, steps
from study.web.language import load_language, preferred
from study.web.pages import render
from study.web.site import Clip, Site, site_of

TOKEN = "participant"  # the cookie that holds the token of a personal link
LANGUAGE = "language"
COOKIE_LASTS_S = 30 * 24 * 3600

router = APIRouter()


class Event(BaseModel):
    """Something the page wants written down."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(max_length=40, pattern=r"^[a-z_]+$")
    detail: str = Field("", max_length=500)


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


def steps_of(site: Site, session: Session) -> tuple[Step, ...]:
    """The pages of a session."""
    return steps(session.plan, demographics=bool(site.protocol.demographics))


def questions_of(site: Site, step: Step) -> tuple[Question, ...]:
    """What is asked on a page."""
    if step.kind == "demographics":
        return site.protocol.demographics
    return site.protocol.parts[step.trial.part].questions if step.trial else ()


# Entry


@router.get("/", name="entry")
def entry(request: Request) -> Response:
    """The door: in the lab one may start here, elsewhere a personal link is needed."""
    site, language = site_of(request), language_of(request)
    if participant_of(request):
        return _to(request, "study")
    if site.lab:
        return _speaking(render(request, "entry.html", language=language), language)
    say = load_language(language).text
    message = say("Please open the personal link you were given.")
    return render(request, "message.html", language=language, heading=say("Welcome"), message=message)


@router.post("/start", name="start")
def start(request: Request) -> Response:
    """Somebody starts without a link."""
    site = site_of(request)
    if not site.lab:
        raise HTTPException(403)
    if participant_of(request):  # a double click
        return _to(request, "study")
    token = new_token()
    site.store.add_participant(new_participant(token, kind=site.kind, created_at=site.clock()))
    return _remember(request, token)


@router.get("/p/{token}", name="link")
def link(request: Request, token: str) -> Response:
    """A personal link. The token leaves the address at once and stays in a cookie no script can read."""
    if site_of(request).store.participant(token_sha256(token)) is None:
        raise HTTPException(404)
    return _remember(request, token)


@router.post("/leave", name="leave")
def leave(request: Request) -> Response:
    """The session is over and the next participant may use this browser."""
    answer = _to(request, "entry")
    answer.delete_cookie(TOKEN)
    return answer


# The session


@router.get("/study", name="study")
def study(request: Request) -> Response:
    """The page that is due, whatever was open before."""
    site, language = site_of(request), language_of(request)
    participant = participant_of(request)
    if participant is None:
        return _to(request, "entry")
    session = site.store.session(participant.name)
    if session is None:
        page = render(request, "consent.html", language=language, kind=participant.kind)
        return _speaking(page, language)
    pages = steps_of(site, session)
    answered = site.store.answered(participant.name)
    step = next_step(pages, answered)
    if step is None:
        return render(
            request,
            "debrief.html",
            language=session.language,
            kind=participant.kind,
            completion_code=session.completion_code,
            completion_url=None,
        )
    site.store.show_page(participant.name, step.key, now=site.clock())
    return _page(request, participant, session, step=step, pages=pages)


@router.post("/consent", name="consent")
def consent(request: Request, agreed: Annotated[str, Form()], language: Annotated[str, Form()]) -> Response:
    """Consent: the moment the session begins and all its orders are drawn and kept."""
    site, participant = site_of(request), participant_of(request)
    if participant is None or agreed != "yes" or language not in site.protocol.languages:
        raise HTTPException(400)
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
    return _to(request, "study")


@router.post("/study/answers", name="answers")
def answers(request: Request, submission: Submission) -> JSONResponse:
    """Store an answered page. 200: it is on disk. 409: another page is due. 422: this cannot be an answer."""
    site, participant = site_of(request), participant_of(request)
    session = site.store.session(participant.name) if participant else None
    if participant is None or session is None:
        return JSONResponse({"reason": "no session"}, 409)
    pages = steps_of(site, session)
    answered = site.store.answered(participant.name)
    verdict = judge(submission.id, submission.step, pages=pages, answered=answered)
    if verdict is Verdict.STORE:
        due = next(page for page in pages if page.key == submission.step)
        if fault := _fault(site, participant, due, submission):
            return JSONResponse({"reason": fault}, 422)
        verdict = site.store.add_response(participant.name, submission, steps=pages, now=site.clock())
    stored = verdict in {Verdict.STORE, Verdict.KNOWN}
    return JSONResponse({"reason": verdict.value}, 200 if stored else 409)


@router.post("/study/events", name="events", status_code=204)
def events(request: Request, event: Event) -> Response:
    """Write down what happened on a page, such as a video that failed."""
    site, participant = site_of(request), participant_of(request)
    if participant is None:
        raise HTTPException(409)
    site.store.log(event.name, event.detail, participant=participant.name, now=site.clock())
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
    name = participant.name if participant else site.store.participant_with_code(code.strip().upper())
    if name is None or sure != "yes":
        fault = say("This code is not known. Please check it, or write to us.")
        return render(request, "withdraw.html", language=language, known=False, fault=fault, status=404)
    site.store.withdraw(name, now=site.clock())
    answer = render(
        request,
        "message.html",
        language=language,
        heading=say("Your answers are deleted"),
        message=say("You have withdrawn from the study. Thank you for your time."),
    )
    answer.delete_cookie(TOKEN)
    return answer


def _page(
    request: Request, participant: Participant, session: Session, *, step: Step, pages: tuple[Step, ...]
) -> Response:
    site, language = site_of(request), session.language
    say = load_language(language).text
    place = pages.index(step)
    part = site.protocol.parts[step.part] if step.part else None
    values: dict[str, Any] = {
        "number": place + 1,
        "total": len(pages),
        "trial": step.trial,
        "questions": questions_of(site, step),
        "heading": part.title.in_(language) if part else say("Before we start"),
        "gate": "",
        "instructions": "",
    }
    clips: dict[str, Clip] = {}
    if step.trial:
        clips = site.clips_on(step.trial)
        one = say("Watch the video to its end, then answer.")
        values["gate"] = one if len(clips) == 1 else say("Watch both videos to their ends, then answer.")
    elif step.kind == "instructions":
        intro = part.intro if part else site.protocol.texts.practice
        values["instructions"] = intro.in_(language)
    ahead = pages[place + 1].trial if place + 1 < len(pages) else None
    facts = {
        "participant": participant.name,
        "step": step.key,
        "clips": [
            {"role": role, "url": _address(request, clip), "size": clip.size} for role, clip in clips.items()
        ],
        "ahead": [_address(request, clip) for clip in site.clips_on(ahead).values()] if ahead else [],
        "answer_url": request.app.url_path_for("answers"),
        "event_url": request.app.url_path_for("events"),
        "next_url": request.app.url_path_for("study"),
        "texts": {name: say(english) for name, english in PAGE_TEXTS.items()},
    }
    template = f"{step.kind}.html"
    return render(request, template, language=language, kind=participant.kind, page=facts, **values)


PAGE_TEXTS = {
    "play": "Play",
    "again": "Watch again",
    "continue": "Continue the video",
    "retry": "Try again",
    "loading": "Loading …",
    "waiting": "One moment, the video is loading …",
    "watched": "Watched",
    "incomplete": "The video was not played completely. Please watch it again.",
    "press": "Please press the button again.",
    "missing": "Please answer every question.",
    "offline": "There is no connection at the moment. Your answer is kept on this device and will be sent as "
    "soon as possible. Please leave this page open.",
    "failed": "The video could not be played. Please try again; if it keeps failing, tell the experimenter.",
    "refused": "Your answer could not be stored. Please reload this page.",
}


def _fault(site: Site, participant: Participant, step: Step, submission: Submission) -> str | None:
    values = submission.values
    try:
        for question in questions_of(site, step):
            question.check({item: values.pop(item) for item in question.items if item in values})
    except AnswerError as fault:
        return str(fault)
    if values:
        return f"{next(iter(values))} is not asked here"
    if step.trial is None:
        return None
    durations_s = {role: clip.duration_s for role, clip in site.clips_on(step.trial).items()}
    now = site.clock()
    elapsed_s = (now - site.store.show_page(participant.name, step.key, now=now)).total_seconds()
    return playback_fault(
        submission.views, durations_s, None if participant.kind == "simulated" else elapsed_s
    )


def _address(request: Request, clip: Clip) -> str:
    return str(request.app.url_path_for("clip", name=clip.name))


def _to(request: Request, name: str) -> RedirectResponse:
    return RedirectResponse(request.app.url_path_for(name), status_code=303)


def _remember(request: Request, token: str) -> Response:
    answer = _to(request, "study")
    secure = request.url.scheme == "https"
    answer.set_cookie(TOKEN, token, max_age=COOKIE_LASTS_S, httponly=True, samesite="lax", secure=secure)
    if (language := request.query_params.get("lang")) in site_of(request).protocol.languages:
        return _speaking(answer, language)
    return answer


def _speaking(answer: Response, language: str) -> Response:
    answer.set_cookie(LANGUAGE, language, max_age=COOKIE_LASTS_S, httponly=True, samesite="lax")
    return answer
