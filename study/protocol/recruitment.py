"""Where participants of an online study come from, and where they go back to."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Literal, Self
from urllib.parse import quote

from pydantic import model_validator

from stimuli.errors import nearest
from study.written import Written, wrong_at

Service = Literal["prolific", "sona", "mturk"]

PARAMETERS: Mapping[Service, str] = {  # in the address they send people to: what the person is called there
    "prolific": "PROLIFIC_PID",
    "sona": "survey_code",
    "mturk": "workerId",
}
NAMES: Mapping[Service, str] = {"prolific": "Prolific", "sona": "SONA", "mturk": "MTurk"}
GAPS = ("id", "code")  # in a completion address, in braces
HOSTS = ("app.prolific.com", "*.sona-systems.com", "worker.mturk.com", "workersandbox.mturk.com")
ADDRESS = re.compile(
    r"https://([a-z0-9.-]+)(?::\d+)?(?:[/?#][^\s\\]*)?"
)  # no user, whom browsers may mistake


class Recruitment(Written):
    """A service that sends people. In `completion_url`, {id} is what it calls them, {code} is our code."""

    service: Service | None = None
    completion_url: str | None = None
    hosts: tuple[str, ...] = ()  # that people may be sent to, beside those of the known services

    @model_validator(mode="after")
    def _goes_to_a_known_host(self) -> Self:
        if self.completion_url is None:
            return self
        found = ADDRESS.fullmatch(self.completion_url)
        if found is None:
            raise wrong_at(
                ("completion_url",), "must be an address that begins with https://", self.completion_url
            )
        for gap in re.findall(r"{(.*?)}", self.completion_url):
            if gap not in GAPS:
                message = f"has {{{gap}}}, which stands for nothing; {nearest(gap, GAPS)}"
                raise wrong_at(("completion_url",), message, self.completion_url)
        host = found[1]
        if not any(_is(host, known) for known in (*HOSTS, *self.hosts)):
            message = f"sends participants to {host}; if that is meant, add `hosts: [{host}]`"
            raise wrong_at(("completion_url",), message, self.completion_url)
        return self

    @property
    def parameter(self) -> str | None:
        """Under which name the service's links say who somebody is."""
        return PARAMETERS[self.service] if self.service else None

    @property
    def called(self) -> str | None:
        """What people know the service as."""
        return NAMES[self.service] if self.service else None

    def completion_address(self, *, external_id: str | None, code: str) -> str | None:
        """Where somebody goes at the end."""
        if self.completion_url is None:
            return None
        address = self.completion_url.replace("{id}", quote(external_id or "", safe=""))
        return address.replace("{code}", quote(code, safe=""))


def _is(host: str, known: str) -> bool:
    return host.endswith(known[1:]) if known.startswith("*.") else host == known
