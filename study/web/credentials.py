"""The experimenter's password and the key that signs their cookie, both kept in the study's data folder."""

from __future__ import annotations

import hashlib
import hmac
import json
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

from study.participants import LETTERS

SCRYPT = {"n": 2**14, "r": 8, "p": 1}  # 16 MB and some 50 ms per try
LOGIN_LASTS = timedelta(hours=12)


@dataclass(frozen=True)
class Credentials:
    """Checks passwords, and makes and checks cookies and form tokens."""

    salt: bytes
    password_hash: bytes
    key: bytes  # signs cookies; new on every change of password

    def is_password(self, password: str) -> bool:
        """Whether this is the password, in a time that does not depend on where it differs."""
        return hmac.compare_digest(_scrypt(password, self.salt), self.password_hash)

    def cookie(self, now: datetime) -> str:
        """A cookie for somebody who has just given the password: when it ends, a nonce, and both signed."""
        content = f"{int((now + LOGIN_LASTS).timestamp())}.{secrets.token_urlsafe(16)}"
        return f"{content}.{self._sign('cookie', content)}"

    def is_cookie(self, cookie: str, now: datetime) -> bool:
        """Whether a cookie was signed here and has not ended."""
        content, _, signature = cookie.rpartition(".")
        if not hmac.compare_digest(signature.encode(), self._sign("cookie", content).encode()):
            return False
        return int(content.partition(".")[0]) > now.timestamp()

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


def new_credentials(password: str) -> Credentials:
    """Credentials for a password."""
    salt = secrets.token_bytes(16)
    return Credentials(salt, _scrypt(password, salt), secrets.token_bytes(32))


def new_password() -> str:
    """Draw a password of 79 random bits that can be read out and typed."""
    return "-".join("".join(secrets.choice(LETTERS) for _ in range(4)) for _ in range(4))


def open_credentials(folder: Path) -> tuple[Credentials, str | None]:
    """The credentials kept in a folder, and at the first start, when they are made, the password."""
    file = folder / "experimenter.json"
    if file.is_file():
        kept = json.loads(file.read_text())
        return Credentials(**{name: bytes.fromhex(value) for name, value in kept.items()}), None
    password = new_password()
    made = new_credentials(password)
    folder.mkdir(parents=True, exist_ok=True)
    file.touch(mode=0o600)
    file.write_text(json.dumps({name: value.hex() for name, value in vars(made).items()}, indent=2))
    return made, password
