"""What the experimenter sees of a running study: who is where, how full the design is, what went wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Literal

from study.balance import Balance, balance
from study.participants import is_of
from study.sessions import next_step
from study.storage.archive import Event, Progress
from study.storage.store import Phase
from study.web.participant import steps_of
from study.web.site import Site

State = Literal["invited", "active", "stalled", "completed"]
STATES: tuple[State, ...] = ("invited", "active", "stalled", "completed")
STALLED_AFTER = timedelta(minutes=5)  # without an answer: a sign, long before the place is given away
HOURS = 24
TROUBLES = {  # events the experimenter should know of, and what they are called
    "video_failed": "a video failed",
    "video_retried": "a video had to be loaded again",
    "answer_refused": "an answer was refused",
    "page_reopened": "a page was opened again",
}


@dataclass(frozen=True)
class Row:
    """One participant."""

    name: str
    kind: str
    note: str
    state: State
    dropped_out: bool  # without an answer for so long that the place in the design is free again
    place: int
    pages: int
    step: str
    slot: int | None
    begun_at: datetime | None
    minutes: float | None
    failed_videos: int


@dataclass(frozen=True)
class Overview:
    """The study at one moment."""

    phase: Phase
    rows: tuple[Row, ...]
    withdrawn: int
    planned: int
    places: tuple[str, ...]  # of the planned design, in order: the state of its latest holder, or "free"
    balances: tuple[Balance, ...]  # over completed sessions
    hours: tuple[int, ...]  # pages answered in each of the last hours, the present one last
    troubles: tuple[Event, ...]  # the latest
    backup_fault: str | None  # why the latest backup failed

    @property
    def counts(self) -> Mapping[str, int]:
        """How many participants are in each state; tests do not count."""
        return Counter(row.state for row in self.rows if row.kind != "test")

    @property
    def dropouts(self) -> int:
        """How many began and have gone."""
        return sum(row.dropped_out for row in self.rows if row.kind != "test")

    @property
    def median_minutes(self) -> float | None:
        """How long the study took those who completed it."""
        taken = sorted(
            row.minutes for row in self.rows if row.state == "completed" and row.minutes is not None
        )
        return taken[len(taken) // 2] if taken else None


def overview(site: Site) -> Overview:
    """Look at the study now."""
    now = site.clock()
    people = site.store.progress()
    failures = site.store.event_counts("video_failed")
    rows = [_row(site, person, failures.get(person.participant.name, 0), now) for person in people]
    completed = [
        person.session.plan for person in people if person.session and _counts(site, person) and _done(person)
    ]
    return Overview(
        phase=site.store.phase,
        rows=tuple(rows),
        withdrawn=sum(is_of(site.kind, note.participant) for note in site.store.withdrawals()),
        planned=site.protocol.participants.planned,
        places=_places(site, rows),
        balances=tuple(balance(site.protocol, completed)) if completed else (),
        hours=_hours(site.store.answered_since(now - timedelta(hours=HOURS), site.kind), now),
        troubles=tuple(site.store.events(TROUBLES, most=8)),
        backup_fault=site.backup_fault(),
    )


def may_see_report(site: Site, seen: Overview) -> bool:
    """Whether so many have completed as were planned, or the protocol allows peeking."""
    return site.protocol.participants.peeking or seen.counts["completed"] >= seen.planned


def _counts(site: Site, person: Progress) -> bool:
    return person.participant.kind == site.kind


def _done(person: Progress) -> bool:
    return person.session is not None and person.session.completed_at is not None


def _row(site: Site, person: Progress, failed_videos: int, now: datetime) -> Row:
    session = person.session
    begun = session and site.as_begun(session)
    pages = steps_of(begun, session) if session and begun else ()
    step = next_step(pages, person.answered)
    quiet = now - person.active_at if person.active_at else timedelta()
    state: State = "active"
    if session is None:
        state = "invited"
    elif _done(person):
        state = "completed"
    elif quiet > STALLED_AFTER:
        state = "stalled"
    ended_at = session and (session.completed_at or person.active_at)
    minutes = (ended_at - session.begun_at).total_seconds() / 60 if session and ended_at else None
    gone = quiet.total_seconds() > site.protocol.participants.abandoned_after
    return Row(
        name=person.participant.name,
        kind=person.participant.kind,
        note=person.contact.note or person.contact.external_id or "",
        state=state,
        dropped_out=state == "stalled" and gone,
        place=len(person.answered),
        pages=len(pages),
        step=step.key if step else "",
        slot=session.plan.slot if session else None,
        begun_at=session.begun_at if session else None,
        minutes=minutes,
        failed_videos=failed_videos,
    )


def _places(site: Site, rows: Sequence[Row]) -> tuple[str, ...]:
    places = ["free"] * site.protocol.participants.planned
    for state in ("active", "stalled", "completed"):  # later ones take precedence
        for row in rows:
            held = row.kind == site.kind and row.state == state and not row.dropped_out
            if held and row.slot is not None and row.slot < len(places):
                places[row.slot] = state
    return tuple(places)


def _hours(moments: Sequence[datetime], now: datetime) -> tuple[int, ...]:
    ago = Counter(int((now - moment) / timedelta(hours=1)) for moment in moments)
    return tuple(ago[hours] for hours in reversed(range(HOURS)))
