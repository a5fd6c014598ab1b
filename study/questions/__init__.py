"""Questions: one kind per file, its HTML beside it; this folder is the list.

A protocol asks by kind, `ask: [{rate: {…}}, {choose: {…}}]`.
"""

from __future__ import annotations

import importlib
import pkgutil
from typing import Annotated, Any

from pydantic import BeforeValidator, SerializeAsAny, ValidationError, WithJsonSchema

from study.questions.question import AnswerError, Question
from study.written import NAME, meant, refusal, relocated, wrong, wrong_at

__all__ = ["ANY_QUESTION", "QUESTIONS", "AnswerError", "Asked", "Question"]

QUESTIONS: dict[str, type[Question]] = {
    kind.kind: kind
    for module in pkgutil.iter_modules(__path__)
    for kind in vars(importlib.import_module(f"{__name__}.{module.name}")).values()
    if isinstance(kind, type) and issubclass(kind, Question) and "kind" in vars(kind)
}


def _read(value: Any) -> Question:
    """Read `{rate: {…}}` as a question of that kind."""
    if isinstance(value, Question):
        return value
    if not isinstance(value, dict) or len(value) != 1:
        raise wrong(f"must be one question, written {{kind: …}}; kinds: {', '.join(QUESTIONS)}")
    ((kind, body),) = value.items()
    if kind not in QUESTIONS:
        raise wrong_at((kind,), f"is no kind of question; {meant(kind, QUESTIONS)}", body, NAME)
    try:
        return QUESTIONS[kind].model_validate(body)
    except ValidationError as error:
        raise refusal(relocated(error, (kind,))) from None


ANY_QUESTION: dict[str, Any] = {
    "type": "object",
    "title": "Question",
}  # in the JSON Schema, until kinds are put in
Asked = Annotated[SerializeAsAny[Question], BeforeValidator(_read), WithJsonSchema(ANY_QUESTION)]
