"""The experimenter's passwords and the key that signs their cookies, both kept in the study's data folder."""

from __future__ import annotations

import hashlib
import hmac
import json
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Literal, cast, get_args

from stimuli.errors import InputError
from stimuli.whole_files import whole_or_nothing
from study.participants import LETTERS

Role = Literal["edit", "view"]
"""Who edits may do everything; who views sees the running study and takes its answers, and neither changes
anything nor learns who anybody is."""

SCRYPT = {"n": 2**14, "r": 8, "p": 1}  # 16 MB and some 50 ms per try
LOGIN_LASTS = timedelta(hours=12)


@dataclass(frozen=True)
class Passwords:
    """What is shown once, when they are made."""

    edit: str
    view: str


@dataclass(frozen=True)
class Credentials:
    """Checks passwords, and makes and checks cookies and form tokens."""

    salt: bytes
    password_hash: bytes
    key: bytes  # signs cookies; new on every change of password
    viewer_hash: bytes = b""  # of the password that only lets look on; none where it is empty

    def role_of(self, password: str) -> Role | None:
        """What a password allows, in a time that does not depend on where it differs."""
        given = _scrypt(password, self.salt)
        may_edit = hmac.compare_digest(given, self.password_hash)
        may_view = hmac.compare_digest(given, self.viewer_hash)
        return "edit" if may_edit else "view" if may_view else None

    def cookie(self, role: Role, now: datetime) -> str:
        """A cookie for somebody who has just given a password: role, end and a nonce, signed together."""
        content = f"{role}.{int((now + LOGIN_LASTS).timestamp())}.{secrets.token_urlsafe(16)}"
        return f"{content}.{self._sign('cookie', content)}"

    def role_in(self, cookie: str, now: datetime) -> Role | None:
        """What a cookie allows that was signed here and has not ended."""
        content, _, signature = cookie.rpartition(".")
        if not hmac.compare_digest(signature.encode(), self._sign("cookie", content).encode()):
            return None
        role, ends, _ = content.split(".")
        return cast("Role", role) if role in get_args(Role) and int(ends) > now.timestamp() else None

    def form_token(self, cookie: str) -> str:
        """What every form of the experimenter sends back, so that no other site can send it for them."""
        return self._sign("form", cookie)

    def is_form_token(self, token: str, cookie: str) -> bool:
        """Whether a form was made for the holder of that cookie."""
        return hmac.compare_digest(token.encode(), self.form_token(cookie).encode())

    def token_for(self, person: str) -> str:
        """The token of somebody whom others name, which only this server can make."""
        return self._sign("token", person)[:43]

    @property
    def kiosk_key(self) -> str:
        """Six digits by which the experimenter lets the next participant in."""
        return f"{int(self._sign('kiosk', ''), 16) % 10**6:06d}"

    def is_kiosk_key(self, typed: str) -> bool:
        """Whether this is the key."""
        return hmac.compare_digest(typed.encode(), self.kiosk_key.encode())

    def _sign(self, purpose: str, content: str) -> str:
        return hmac.new(self.key, f"{purpose}:{content}".encode(), hashlib.sha256).hexdigest()


def _scrypt(password: str, salt: bytes) -> bytes:
    return hashlib.scrypt(password.encode(), salt=salt, **SCRYPT)


def new_credentials(passwords: Passwords) -> Credentials:
    """Credentials for passwords."""
    salt = secrets.token_bytes(16)
    return Credentials(
        salt,
        password_hash=_scrypt(passwords.edit, salt),
        key=secrets.token_bytes(32),
        viewer_hash=_scrypt(passwords.view, salt),
    )


def new_passwords() -> Passwords:
    """Draw passwords of 79 random bits that can be read out and typed."""
    return Passwords(edit=_password(), view=_password())


def _password() -> str:
    return "-".join("".join(secrets.choice(LETTERS) for _ in range(4)) for _ in range(4))


def open_credentials(folder: Path) -> tuple[Credentials, Passwords | None]:
    """The credentials kept in a folder, and at the first start, when they are made, the passwords."""
    file = folder / "experimenter.json"
    if file.is_file():
        try:
            kept = json.loads(file.read_text())
            return Credentials(**{name: bytes.fromhex(value) for name, value in kept.items()}), None
        except (ValueError, TypeError, AttributeError) as err:
            message = (
                f"{file}: is damaged. Delete it and start again: new passwords are made, and shown once."
            )
            raise InputError(message) from err
    passwords = new_passwords()
    made = new_credentials(passwords)
    folder.mkdir(parents=True, exist_ok=True)
    with whole_or_nothing(file) as partial:
        partial.touch(mode=0o600)
        partial.write_text(json.dumps({name: value.hex() for name, value in vars(made).items()}, indent=2))
    return made, passwords
