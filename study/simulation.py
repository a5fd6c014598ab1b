"""Rehearsal: simulated participants take a whole study through the real application over HTTP.

They see what a browser sees and send what its scripts send, on a real server with a real database; but all
they leave behind is marked as simulated, so that it can never be mistaken for data.
"""

from __future__ import annotations

import hashlib
import http.client
import json
import math
import random
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlencode, urlsplit
from uuid import UUID

from stimuli.errors import InputError, nearest
from study.chance import Stream
from study.export import export_responses
from study.protocol import Pair, Protocol, Stimulus
from study.protocol.parts import series_of
from study.questions import Question
from study.questions.scale import Scale
from study.sessions import Session
from study.storage import open_store
from study.web.app import create_app
from study.web.credentials import new_credentials, new_passwords
from study.web.participant import questions_of, steps_of
from study.web.server import SOFTWARE, running
from study.web.site import Clip, Site, hashes

AT_ONCE = 8
PAGE = re.compile(r'<script type="application/json" id="page">(.*?)</script>', re.DOTALL)


@dataclass(frozen=True)
class Manner:
    """How somebody answers."""

    effect: float  # 0: by chance; 1: sees what is meant about as well as the paper's participants
    same: bool = False  # always the last answer offered, whatever is asked
    drops_out: float = 0.0  # chance of leaving on any one page
    rt_s: float = 4.0  # median time per answer


MANNERS: Mapping[str, Manner] = {
    "attentive": Manner(effect=1.0),
    "unsure": Manner(effect=0.4, rt_s=7.0),
    "random clicker": Manner(effect=0.0, rt_s=1.0),
    "yea-sayer": Manner(effect=0.0, same=True, rt_s=2.0),
    "speeder": Manner(effect=0.2, rt_s=0.4),
    "dropout": Manner(effect=1.0, drops_out=0.1),
}
USUAL = {  # shares
    "attentive": 0.8,
    "unsure": 0.12,
    "random clicker": 0.03,
    "yea-sayer": 0.03,
    "speeder": 0.02,
}
EASE = (0.3, 1.3)  # times the manner's effect: some stimuli are hard to read and others plain


def crowd_of(manners: Sequence[str]) -> Mapping[str, float]:
    """Equal shares of these manners; the usual crowd where none is named."""
    for name in manners:
        if name not in MANNERS:
            raise InputError(f"{name!r} is no manner of answering: {nearest(name, MANNERS)}")
    return dict.fromkeys(manners, 1.0) or USUAL


def rehearse(
    protocol: Protocol,
    n: int,
    out: Path,
    *,
    clips: Mapping[str, Clip] | None = None,
    shares: Mapping[str, float] = USUAL,
    progress: Callable[[int], object] = lambda _: None,
) -> Path:
    """Let n simulated participants take the study; write responses.csv and codebook, give the table's path.

    Clips need not be rendered: without them the videos count as of no length. `shares` says how often each of
    the MANNERS occurs; `progress` hears how many are done.
    """
    shown = {stimulus: _unrendered(stimulus) for stimulus in protocol.stimuli} | dict(clips or {})
    with tempfile.TemporaryDirectory() as scratch:
        store = open_store(f"sqlite:///{scratch}/rehearsal.db")
        site = Site(protocol, store, shown, new_credentials(new_passwords()), SOFTWARE, kind="simulated")
        with running(create_app(site)) as address, ThreadPoolExecutor(AT_ONCE) as crowd:
            visits = [crowd.submit(take_part, site, address, number, shares) for number in range(n)]
            for done, visit in enumerate(visits, start=1):
                visit.result()
                progress(done)
        rendered = {protocol.sha256: hashes(clips or {})}
        table = export_responses(store, protocol, out, kind="simulated", clips=rendered)
        store.close()
    return table


def take_part(site: Site, address: str, number: int, shares: Mapping[str, float]) -> None:
    """Take the study as one simulated participant, from the door to the end or to dropping out."""
    rng = random.Random(f"{site.protocol.seed}/{number}")
    manner = MANNERS[rng.choices(list(shares), weights=list(shares.values()))[0]]
    with closing(Browser(address)) as browser:
        browser.submit("/start", {})
        seen = browser.submit("/consent", {"agreed": "yes", "language": site.protocol.languages[0]})
        session: Session | None = None
        while found := PAGE.search(seen):
            if rng.random() < manner.drops_out:
                return
            page = json.loads(found[1])
            session = session or site.store.session(page["participant"])
            assert session is not None, "a page of the session was shown"
            browser.send(page["answer_url"], _answer(site, session, page, manner, rng))
            seen = browser.open(page["next_url"])


class Browser:
    """As much of a browser as a rehearsal needs: a connection, cookies, and going where it is sent on."""

    def __init__(self, address: str) -> None:
        self._connection = http.client.HTTPConnection(urlsplit(address).netloc, timeout=60)
        self._cookies: dict[str, str] = {}

    def open(self, path: str) -> str:
        """The page at an address."""
        return self._request("GET", path)

    def submit(self, path: str, form: Mapping[str, str]) -> str:
        """The page that a form leads to."""
        return self._request("POST", path, urlencode(form), "application/x-www-form-urlencoded")

    def send(self, path: str, content: object) -> None:
        """Send what a page's scripts send."""
        self._request("POST", path, json.dumps(content), "application/json")

    def close(self) -> None:
        """Hang up."""
        self._connection.close()

    def _request(self, method: str, path: str, body: str | None = None, kind: str | None = None) -> str:
        headers = {"Cookie": "; ".join(f"{name}={value}" for name, value in self._cookies.items())}
        if kind:
            headers["Content-Type"] = kind
        try:
            self._connection.request(method, path, body, headers)
            answer = self._connection.getresponse()
        except (BrokenPipeError, ConnectionResetError):  # servers hang up on who is silent for some seconds
            self.close()
            return self._request(method, path, body, kind)
        text = answer.read().decode()
        for given in answer.headers.get_all("Set-Cookie", ()):
            name, _, value = given.partition(";")[0].partition("=")
            self._cookies[name] = value
        if answer.status == http.HTTPStatus.SEE_OTHER:
            return self.open(answer.headers["Location"])
        if answer.status >= http.HTTPStatus.BAD_REQUEST:
            raise RuntimeError(f"{method} {path}: {answer.status} {text}")
        return text


def _answer(
    site: Site, session: Session, page: dict[str, Any], manner: Manner, rng: random.Random
) -> dict[str, Any]:
    """What the page's scripts would send: answers to its questions, and records of its clips."""
    step = next(step for step in steps_of(site, session) if step.key == page["step"])
    stimulus = site.protocol.judged[step.trial.stimulus] if step.trial else None
    answers: dict[str, str] = {}
    for question in questions_of(site, step):
        answers |= choose(site.protocol, stimulus, question, manner, rng)
    clips = site.clips_on(step.trial) if step.trial else {}
    return {
        "id": str(UUID(int=rng.getrandbits(128), version=4)),
        "step": page["step"],
        "answers": [
            {"item": item, "value": value, "rt_ms": 1000 * manner.rt_s * rng.lognormvariate(0, 0.4)}
            for item, value in answers.items()
        ],
        "views": [_view(role, clip) for role, clip in clips.items()],
        "on_page_ms": 1000 * manner.rt_s,
    }


def choose(
    protocol: Protocol,
    stimulus: Stimulus | Pair | None,
    question: Question,
    manner: Manner,
    rng: random.Random,
) -> dict[str, str]:
    """Answer a question about a stimulus (None: about oneself) in that manner."""
    if manner.same and question.values:
        return question.straight_lined()
    if stimulus is None:
        return question.simulate(rng, None, manner.effect)
    effect = manner.effect * ease_of(protocol, stimulus)
    answers = question.simulate(rng, target_of(protocol, stimulus, question), effect)
    return _leaning(protocol, stimulus, question, answers=answers, effect=effect, rng=rng)


def _leaning(
    protocol: Protocol,
    stimulus: Stimulus | Pair,
    question: Question,
    *,
    answers: dict[str, str],
    effect: float,
    rng: random.Random,
) -> dict[str, str]:
    """Ratings moved by as many standard deviations as the effect between two conditions that are compared."""
    if not isinstance(question, Scale):
        return answers
    options = tuple(question.values)
    series = series_of((question,))
    for hypothesis in protocol.analysis.hypotheses.values():
        condition = stimulus.level or stimulus.name
        compared = hypothesis.compare
        if compared is None or hypothesis.part != stimulus.part or condition not in compared:
            continue
        asked = hypothesis.item or next(iter(question.items))
        up = (condition == compared[0]) != (hypothesis.alternative == "less")
        step = (1 if up else -1) * effect / 2 * (len(options) - 1) / 4
        for item in series.get(asked, (asked,)):
            if item in answers:
                place = options.index(answers[item]) + math.floor(step + rng.random())
                answers[item] = options[min(max(place, 0), len(options) - 1)]
    return answers


def ease_of(protocol: Protocol, stimulus: Stimulus | Pair) -> float:
    """How plainly a stimulus shows what is meant; the same for all who see it, and for both of its levels."""
    hardest, easiest = EASE
    what = stimulus.principle or stimulus.name or stimulus.gesture
    return hardest + (easiest - hardest) * Stream("ease", protocol.seed, what).below(1000) / 999


def target_of(protocol: Protocol, stimulus: Stimulus | Pair, question: Question) -> str | None:
    """What a stimulus is meant to evoke: the item of its name, or what is expected of its level or pair."""
    if stimulus.name in question.items:
        return stimulus.name
    for hypothesis in protocol.analysis.hypotheses.values():
        if hypothesis.part != stimulus.part or hypothesis.compare is None:
            continue
        if isinstance(stimulus, Pair) and (compared := stimulus.of(hypothesis.compare)):
            return compared[hypothesis.alternative == "less"].id
        if hypothesis.outcome is None:
            continue
        answers = tuple(question.values or ())
        if hypothesis.outcome in answers and stimulus.level in hypothesis.compare:
            others = [answer for answer in answers if answer != hypothesis.outcome]
            return hypothesis.outcome if stimulus.level == hypothesis.compare[0] else others[0]
    return None


def _view(role: str, clip: Clip) -> dict[str, Any]:
    return {
        "role": role,
        "plays": 1,
        "played_s": clip.duration_s,
        "duration_s": clip.duration_s,
        "frames": 0,
        "dropped": 0,
        "happenings": [{"at_ms": 0, "name": "simulated", "media_s": 0}],
    }


def _unrendered(stimulus: str) -> Clip:
    """What stands for a clip that has not been rendered."""
    return Clip(Path("/nowhere"), hashlib.sha256(stimulus.encode()).hexdigest(), size=0, duration_s=0.0)
