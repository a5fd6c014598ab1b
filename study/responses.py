"""Responses: what a page sends back when a participant has answered it, and whether it may be believed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Literal, Self
from uuid import UUID

from pydantic import BaseModel, ConfigDict, Field, model_validator

PLAYED_ENOUGH = 0.98  # of a clip's duration; players differ by a frame or two at the ends

Short = Annotated[str, Field(max_length=200)]
Milliseconds = Annotated[float, Field(ge=0, le=1e9, allow_inf_nan=False)]
Seconds = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]


class Happening(BaseModel):
    """Something that happened to a player: play, waiting, pause, ended, error, hidden, visible …"""

    model_config = ConfigDict(frozen=True, extra="forbid")

    at_ms: Milliseconds  # since the page opened, by the browser's monotonic clock
    name: Annotated[str, Field(max_length=40)]
    media_s: Seconds  # place in the clip


class View(BaseModel):
    """One clip as it was played on one page, all its plays together."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    role: Literal["clip", "reference", "left", "right"]  # of which stimulus, stands in the plan
    plays: int = Field(ge=0, le=10_000)  # plays that reached the end
    starts: int = Field(0, ge=0, le=10_000)  # plays begun
    played_s: Seconds  # truly played in the first full play: sum of forward steps, jumps not counted
    duration_s: Seconds
    frames: int = Field(
        ge=0, le=10_000_000
    )  # put on screen, by requestVideoFrameCallback; 0 where a browser has none
    dropped: int = Field(ge=0, le=10_000_000)  # by getVideoPlaybackQuality
    streamed: bool = False  # true where the clip could not be loaded whole before playing
    happenings: tuple[Happening, ...] = Field((), max_length=500)


class Answer(BaseModel):
    """The answer to one item."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    item: Short
    value: Annotated[str, Field(max_length=10_000)]
    rt_ms: Milliseconds | None = None  # from the end of the first full view to the last change
    changes: int = Field(0, ge=0, le=100_000)  # how often an answer was replaced by another


class Submission(BaseModel):
    """One answered page. The browser makes its id once and may send it again until it is acknowledged."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    id: UUID
    step: Short
    answers: tuple[Answer, ...] = Field((), max_length=500)
    views: tuple[View, ...] = Field((), max_length=20)
    on_page_ms: Milliseconds

    @model_validator(mode="after")
    def _say_each_thing_once(self) -> Self:
        for name, said in (
            ("item", [answer.item for answer in self.answers]),
            ("role", [view.role for view in self.views]),
        ):
            if len(set(said)) < len(said):
                raise ValueError(f"the same {name} twice")
        return self

    @property
    def values(self) -> dict[str, str]:
        """Answers by item."""
        return {answer.item: answer.value for answer in self.answers}


@dataclass(frozen=True)
class Response:
    """A submission as it is stored, with the server's own clock beside the browser's."""

    submission: Submission
    shown_at: datetime  # UTC, when the server first handed out the page
    answered_at: datetime  # UTC, when the answer was stored


def playback_fault(
    views: Sequence[View],
    durations_s: Mapping[str, float],
    *,
    elapsed_s: float | None,
    replays: int | None = None,
) -> str | None:
    """Say why the clips of a page cannot have been watched, or None if all is well.

    `durations_s` maps the role of each clip that had to be watched to its duration; `elapsed_s` is the time
    since the server handed out the page, None where that is not to be judged (simulated sessions); `replays`
    is how often a clip may be played again after its first full view. A negative time judges nothing: the
    server's clock was set back meanwhile.
    """
    seen: dict[str, View] = {view.role: view for view in views}
    if unshown := seen.keys() - durations_s.keys():
        return f"there is no {min(unshown)} on this page"
    for role, duration_s in durations_s.items():
        view = seen.get(role)
        if view is None or view.plays < 1:
            return f"the {role} was not played to its end"
        if view.played_s < PLAYED_ENOUGH * duration_s:
            return f"of the {role} only {view.played_s:.2f} of {duration_s:.2f} s were played"
        if replays is not None and view.plays > 1 + replays:
            return f"the {role} was played {view.plays} times; {1 + replays} are allowed"
    needed_s = PLAYED_ENOUGH * sum(durations_s.values())
    if elapsed_s is not None and 0 <= elapsed_s < needed_s:
        return f"answered {elapsed_s:.2f} s after the page was opened; its clips take {needed_s:.2f} s"
    return None
