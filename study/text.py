"""Texts people read, in every language of the study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, RootModel, WithJsonSchema, model_validator

from study.written import wrong

ANY = ""  # the key of a text written once for all languages


class Text(RootModel[dict[str, str]]):
    """A text in one or more languages; written `{en: Yes, de: Ja}`, or plainly where one serves for all."""

    model_config = ConfigDict(frozen=True)

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: Any, handler: Any) -> dict[str, Any]:
        texts = {"type": "object", "additionalProperties": {"type": "string"}}
        return {"anyOf": [{"type": ["string", "number"]}, texts]}

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: Any) -> Any:
        if isinstance(value, (str, int, float)) and not isinstance(value, bool):
            return {ANY: str(value)}
        if isinstance(value, dict) and value and all(isinstance(text, str) for text in value.values()):
            return value
        if isinstance(value, Text):
            return value.root
        raise wrong("must be text, or texts by language such as {en: Yes, de: Ja}")

    def in_(self, language: str) -> str:
        """The text in that language; failing that as written for all, in English, or in the first given."""
        for wanted in (language, ANY, "en"):
            if wanted in self.root:
                return self.root[wanted]
        return next(iter(self.root.values()))

    def lacks(self, languages: Sequence[str]) -> tuple[str, ...]:
        """The languages this text is not written in."""
        return () if ANY in self.root else tuple(lang for lang in languages if lang not in self.root)

    def __str__(self) -> str:
        return self.in_("en")


def _texts(value: Any) -> Any:
    """Read `[Yes, No]` or `{en: [Yes, No], de: [Ja, Nein]}` as a list of texts."""
    if not isinstance(value, Mapping):
        return value
    lists = list(value.values())
    if not lists or not all(isinstance(texts, list) for texts in lists):
        raise wrong("must be a list, or lists by language such as {en: [Yes, No], de: [Ja, Nein]}")
    if len({len(texts) for texts in lists}) > 1:
        counts = ", ".join(f"{len(texts)} in {language}" for language, texts in value.items())
        raise wrong(f"must have as many texts in each language; there are {counts}")
    return [dict(zip(value.keys(), map(str, row), strict=True)) for row in zip(*lists, strict=True)]


_LIST = {"type": "array", "items": {"type": "string"}}
_TEXTS_SCHEMA = {"anyOf": [_LIST, {"type": "object", "additionalProperties": _LIST}]}

Texts = Annotated[tuple[Text, ...], BeforeValidator(_texts), WithJsonSchema(_TEXTS_SCHEMA)]
Ends = Annotated[tuple[Text, Text], BeforeValidator(_texts), WithJsonSchema(_TEXTS_SCHEMA)]


def _named_texts(value: Any) -> Any:
    """Read `[joy, anger]` as names that are their own text."""
    if isinstance(value, list):
        names = list(map(str, value))
        if twice := [name for at, name in enumerate(names) if name in names[:at]]:
            raise wrong(f"names {twice[0]} twice")
        return {str(name): str(name) for name in value}
    return value


NamedTexts = Annotated[
    dict[str, Text],
    BeforeValidator(_named_texts, json_schema_input_type=list[str] | dict[str, Text]),
]
