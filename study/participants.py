"""Participants: who may take part, without saying who they are.

A participant is known by a random name in the data and by a secret token in their personal link. Only the
token's hash is stored, so the database does not open anybody's session.
"""

from __future__ import annotations

import base64
import hashlib
import secrets
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

Kind = Literal["participant", "test", "simulated"]

LETTERS = "abcdefghjkmnpqrstuvwxyz23456789"  # none that are mistaken for another when read aloud or typed
NAME_PREFIX: dict[Kind, str] = {"participant": "p", "test": "test", "simulated": "simulated"}


@dataclass(frozen=True)
class Participant:
    """Somebody invited to the study, whether or not they have begun."""

    name: str  # stands in the data; random, says nothing of order or person
    kind: Kind
    token_sha256: str
    created_at: datetime


@dataclass(frozen=True)
class Contact:
    """What may say who a participant is. Kept apart from the answers and never exported."""

    note: str = ""  # the experimenter's own word for them
    source: str | None = None  # who sent them: prolific, sona, mturk
    external_id: str | None = None  # what they are called there


def new_token() -> str:
    """Draw a token of 128 random bits for a personal link."""
    return secrets.token_urlsafe(16)


def token_sha256(token: str) -> str:
    """Hash of a token. Tokens are random and long, so no slow hash is needed."""
    return hashlib.sha256(token.encode()).hexdigest()


def new_personal_code() -> str:
    """Draw a code of 49 random bits that stands for a personal link where one types, e.g. `k3mz9-q2xwp`."""
    return f"{_code(5)}-{_code(5)}"


def token_of_code(code: str) -> str:
    """The token a personal code stands for, however it was typed: in capitals, with or without its dash."""
    typed = "".join(code.lower().replace("-", " ").split())
    digest = hashlib.sha256(f"personal code {typed}".encode()).digest()
    return base64.urlsafe_b64encode(digest[:18]).decode()


def new_participant(token: str, *, kind: Kind, created_at: datetime) -> Participant:
    """Make a participant with a random name, e.g. `p-7kq2mx9w`."""
    return Participant(
        name=f"{NAME_PREFIX[kind]}-{_code(8)}",
        kind=kind,
        token_sha256=token_sha256(token),
        created_at=created_at,
    )


def is_of(kind: Kind, name: str) -> bool:
    """Whether a participant of that name was of that kind: names say so, also when all else is deleted."""
    return name.startswith(f"{NAME_PREFIX[kind]}-")


def new_completion_code() -> str:
    """Draw the code shown at the end, by which a participant is paid or may withdraw."""
    return f"{_code(5)}-{_code(5)}".upper()


def _code(length: int) -> str:
    return "".join(secrets.choice(LETTERS) for _ in range(length))
