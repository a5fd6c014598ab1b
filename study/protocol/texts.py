"""The texts around the questions: shipped in English and German, or a protocol's own.

A text is Markdown, written in the protocol or in a file of its own (a value that ends in `.md`). In it,
{title}, {contact}, {authors}, {ethics}, {service}, {videos} and {minutes} stand for what the study has there;
a paragraph of a shipped text that names what a study leaves open is left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from study.text import ANY, Text
from study.written import Written

_SHIPPED = Path(__file__).parent.parent / "defaults"


class WrittenTexts(Written):
    """The protocol's own texts, each in place of the shipped one."""

    consent: Text | None = None
    instructions: Text | None = None  # of a part without an `intro`
    comparison: Text | None = None  # the same, where a reference is shown first
    pairs: Text | None = None  # the same, where two are shown side by side
    practice: Text | None = None
    debrief: Text | None = None


class Texts(Written):
    """All texts of a study, in its languages, filled in and ready to be shown."""

    consent: Text
    instructions: Text
    comparison: Text
    pairs: Text
    practice: Text
    debrief: Text

    def introducing(self, *, comparison: bool, pairs: bool) -> Text:
        """What is said before a part that says nothing itself."""
        if pairs:
            return self.pairs
        return self.comparison if comparison else self.instructions


@cache
def shipped(name: str) -> Text:
    """A text this platform brings, in all languages it has it in."""
    files = sorted(_SHIPPED.glob(f"{name}.*.md"))
    return Text({file.suffixes[-2].removeprefix("."): file.read_text(encoding="utf-8") for file in files})


@cache
def shipped_demographics() -> Any:
    """The questions about the participant that are asked where a protocol names none."""
    return yaml.safe_load((_SHIPPED / "demographics.yaml").read_text(encoding="utf-8"))


def files_named_in(text: Text, folder: Path) -> dict[str, Path]:
    """The Markdown files a text names instead of spelling it out, by language."""
    return {
        language: folder / words
        for language, words in text.root.items()
        if words.endswith(".md") and "\n" not in words
    }


def without_gaps(text: Text, missing: Sequence[str]) -> Text:
    """The text without the paragraphs that name something missing."""
    return Text(
        {
            language: "\n\n".join(
                paragraph
                for paragraph in words.split("\n\n")
                if not any(f"{{{name}}}" in paragraph for name in missing)
            )
            for language, words in text.root.items()
        }
    )


def completed(text: Text, languages: Sequence[str], *, folder: Path, values: Mapping[str, Text]) -> Text:
    """The text in these languages, files read and what stands in braces filled in.

    A language it is not written in is left out. Raises OSError or UnicodeDecodeError for an unreadable file.
    """
    files = files_named_in(text, folder)
    complete = {}
    for language in languages:
        written_in = language if language in text.root else ANY
        if written_in not in text.root:
            continue
        words = text.root[written_in]
        whole = files[written_in].read_text(encoding="utf-8") if written_in in files else words
        for name, value in values.items():
            whole = whole.replace(f"{{{name}}}", value.in_(language))
        complete[language] = whole.strip()
    return Text(complete) if complete else text
