from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import pytest

import study.questions
from study.questions.number import Number
from study.storage.store import Phase
from study.web.language import CATALOGUES, load_language, preferred
from study.web.overview import STATES, TROUBLES
from study.web.pages import HERE, ask
from study.web.step_pages import PAGE_TEXTS

SPOKEN = re.compile(r"""\b(?:_|say)\((?:"([^"]+)"|'([^']+)')\)""")


def english_texts() -> set[str]:
    """Everything the interface says, as written in its source."""
    sources = [*HERE.glob("templates/*.html"), *Path(study.questions.__file__).parent.glob("*.html")]
    sources += HERE.glob("*.py")
    found = {one or other for source in sources for one, other in SPOKEN.findall(source.read_text("utf-8"))}
    return found | set(PAGE_TEXTS.values()) | {*STATES, "free", *TROUBLES.values(), *get_args(Phase)}


@pytest.mark.parametrize("catalogue", sorted(CATALOGUES.glob("*.po")), ids=lambda path: path.stem)
def test_every_catalogue_says_everything_and_nothing_else(catalogue: Path) -> None:
    assert set(load_language(catalogue.stem).texts) == english_texts()


@pytest.mark.parametrize("catalogue", sorted(CATALOGUES.glob("*.po")), ids=lambda path: path.stem)
def test_every_translation_keeps_what_is_filled_in(catalogue: Path) -> None:
    for english, translated in load_language(catalogue.stem).texts.items():
        assert set(re.findall(r"{\w+}", english)) == set(re.findall(r"{\w+}", translated))


@pytest.mark.parametrize(
    ("accept", "expected"),
    [
        ("de-DE,de;q=0.9,en;q=0.8", "de"),
        ("fr, de;q=0.5, en;q=0.7", "en"),
        ("fr", "en"),
        ("", "en"),
        ("de;q=nonsense", "en"),
    ],
)
def test_the_browser_s_wish_is_followed(accept: str, expected: str) -> None:
    assert preferred(accept, ("en", "de")) == expected


def test_numbers_are_written_as_in_the_language_and_bounds_to_the_last_digit() -> None:
    bounds = {"least": 0.5, "most": 1234567}
    shown = ask("de", Number.model_validate({"item": "steps", "text": "Wie viele?"} | bounds), 1)
    assert 'min="0.5" max="1234567"' in shown
    assert "Bitte geben Sie eine Zahl von 0,5 bis 1234567 an." in shown
