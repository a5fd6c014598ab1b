"""The page of a step: nearly all of it is the same for everybody who comes to it, and is made once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache

from fastapi import FastAPI
from fastapi.responses import HTMLResponse
from jinja2.utils import htmlsafe_json_dumps
from markupsafe import Markup

from study.orders import Shown
from study.participants import Kind, Participant
from study.sessions import Pages, Session, Step, StepKind
from study.web.language import load_language
from study.web.pages import fill, url
from study.web.site import Clip, Site

FACTS = Markup("<facts>")  # holds their place while a page is made; no text comes in with a tag of this name


@dataclass(frozen=True)
class Sheet:
    """What stands on a page, whoever sees it."""

    kind: StepKind
    language: str
    seen_by: Kind
    number: int
    total: int
    study_title: str
    heading: str
    instructions: str
    description: str  # of the clips
    roles: tuple[str, ...]  # of the clips
    practice: bool
    questions: tuple[Shown, ...]


def step_page(
    app: FastAPI, site: Site, participant: Participant, session: Session, step: Step, pages: Pages
) -> HTMLResponse:
    """The page of a step, for that participant; `site` is as it was when their session began."""
    place = pages.index(step)
    ahead = pages[place + 1].trial if place + 1 < len(pages) else None
    clips = site.clips_on(step.trial) if step.trial else {}

    def address(clip: Clip) -> str:
        return url(app, "clip", name=clip.name)

    facts = {
        "participant": participant.name,
        "step": step.key,
        "clips": [{"role": role, "url": address(clip), "size": clip.size} for role, clip in clips.items()],
        "ahead": [address(clip) for clip in site.clips_on(ahead).values()] if ahead else [],
        "answer_url": url(app, "answers"),
        "replays": site.protocol.video.replays,
        "event_url": url(app, "events"),
        "next_url": url(app, "study"),
        "texts": page_texts(session.language),
    }
    sheet = _sheet(site, participant.kind, session.language, step, place + 1, len(pages))
    before, after = _around_facts(app, sheet)
    return HTMLResponse(f"{before}{htmlsafe_json_dumps(facts)}{after}")


def asked(site: Site, step: Step) -> tuple[Shown, ...]:
    """The questions of a page."""
    if step.kind == "demographics":
        return tuple((question, (), ()) for question in site.protocol.demographics)
    if step.trial is None:
        return ()
    return tuple(step.trial.asked(site.protocol.parts[step.trial.part]))


def _sheet(site: Site, seen_by: Kind, language: str, step: Step, number: int, total: int) -> Sheet:
    say, protocol, trial = load_language(language).text, site.protocol, step.trial
    part = protocol.parts[step.part] if step.part else None
    intro = part.intro if part else protocol.texts.practice
    described = protocol.video.description
    robot = say("A robot makes a gesture. The video has no sound.")
    return Sheet(
        kind=step.kind,
        language=language,
        seen_by=seen_by,
        number=number,
        total=total,
        study_title=protocol.title.in_(language),
        heading=part.title.in_(language) if part else say("Before we start"),
        instructions=intro.in_(language) if step.kind == "instructions" else "",
        description=described.in_(language) if described else robot,
        roles=tuple(site.clips_on(trial)) if trial else (),
        practice=trial is not None and trial.practice,
        questions=asked(site, step),
    )


@lru_cache(maxsize=1024)
def _around_facts(app: FastAPI, sheet: Sheet) -> tuple[str, str]:
    """A page before and after the facts for its scripts, which are each participant's own."""
    page = fill(
        app,
        f"{sheet.kind}.html",
        language=sheet.language,
        kind=sheet.seen_by,
        study_title=sheet.study_title,
        sheet=sheet,
        facts=FACTS,
    )
    before, _, after = page.partition(FACTS)
    return before, after


@cache
def page_texts(language: str) -> Mapping[str, str]:
    """What the page's scripts say."""
    say = load_language(language).text
    return {name: say(english) for name, english in PAGE_TEXTS.items()}


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
    "blocked": "Something between this device and the study refuses your answer. It is kept on this device "
    "and sent again until it arrives. Please leave this page open and tell the experimenter.",
    "last": "Watched as often as is possible here",
    "failed": "The video could not be played. Please try again; if it keeps failing, tell the experimenter.",
    "refused": "Your answer could not be stored. Please reload this page.",
}
