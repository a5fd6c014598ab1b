"""The principles explained, as a document, from their own docstrings and parameters."""

from __future__ import annotations

import inspect
from typing import get_args

from pydantic.fields import FieldInfo

from stimuli.principles import PRINCIPLES, Principle

_INTRODUCTION = """\
# The nine principles

In the order in which they act. Each is written in a protocol by its short name, with a bare number for its
intensity or with parameters, `ant: {intensity: 0.3, form: mirror}`. Where the formula as the paper prints it
does not do what its text says, another form stands beside it; the printed one is always the default. `study
figures` draws them:

![Each principle on one demonstration, the printed forms beside the others](principles.png)
"""


def principles_as_markdown() -> str:
    """All principles in the folder: what each does, its formula, its forms, its parameters."""
    return "\n".join([_INTRODUCTION, *(_section(kind) for kind in PRINCIPLES.values())])


def _section(kind: type[Principle]) -> str:
    rows = [
        f"| `{name}` | {_choices(field)} | {_default(field)} |" for name, field in kind.model_fields.items()
    ]
    table = ["| parameter | may be | unless told |", "|---|---|---|", *rows]
    return "\n".join([f"## {kind.title}: `{kind.kind}`", "", inspect.getdoc(kind) or "", "", *table, ""])


def _choices(field: FieldInfo) -> str:
    """The values a parameter may have: words, or a kind of value within bounds."""
    words = [value for value in get_args(field.annotation) if isinstance(value, str)]
    if words:
        return ", ".join(f"`{word}`" for word in words)
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<"}
    bounds = [
        f"{sign} {getattr(limit, name):g}"
        for limit in field.metadata
        for name, sign in signs.items()
        if isinstance(getattr(limit, name, None), int | float)
    ]
    return ", ".join(bounds) or "see above"


def _default(field: FieldInfo) -> str:
    value = field.get_default(call_default_factory=True)
    return f"`{value}`" if value not in (None, (), {}) else "none"
