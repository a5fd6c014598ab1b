"""The interface's languages: English in the source, every other as one gettext catalogue in `languages/`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

from babel import Locale
from babel.messages.pofile import read_po
from babel.numbers import format_decimal

CATALOGUES = Path(__file__).parent / "languages"
SOURCE = "en"


@dataclass(frozen=True)
class Language:
    """One language of the interface."""

    code: str
    texts: Mapping[str, str]  # by the English text

    def text(self, english: str) -> str:
        """The text in this language, or in English where it has none."""
        return self.texts.get(english, english)

    def number(self, value: float) -> str:
        """A number as one writes it in this language: 0,5 in German."""
        return format_decimal(value, format="0.###############", locale=self.code.replace("-", "_"))

    @cached_property
    def name(self) -> str:
        """Its own name for itself: Deutsch."""
        return (Locale.parse(self.code, sep="-").get_display_name() or self.code).capitalize()


@cache
def load_language(code: str) -> Language:
    """The language of that code; a language without a catalogue has English texts."""
    catalogue = CATALOGUES / f"{code}.po"
    if not catalogue.is_file():
        return Language(code, {})
    with catalogue.open("rb") as file:
        messages = [message for message in read_po(file, locale=code) if message.id and message.string]
    return Language(code, {str(message.id): str(message.string) for message in messages})


def interface_languages() -> tuple[str, ...]:
    """The codes of all languages the interface is written in."""
    return (SOURCE, *sorted(catalogue.stem for catalogue in CATALOGUES.glob("*.po")))


def preferred(accept_language: str, offered: Sequence[str]) -> str:
    """The offered language a browser likes best (RFC 9110, 12.5.4); the first offered if it likes none."""
    wishes = []
    for wish in accept_language.split(","):
        tag, _, weight = wish.partition(";q=")
        try:
            wishes.append((-float(weight or 1), tag.strip().lower()))
        except ValueError:
            continue
    for _, tag in sorted(wishes, key=lambda wish: wish[0]):
        for code in offered:
            if tag and tag.split("-")[0] == code.lower().split("-")[0]:
                return code
    return offered[0]
