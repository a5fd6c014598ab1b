"""Pick one of a list of options, as small buttons or a list: gender, first language, field of study."""

from __future__ import annotations

from typing import ClassVar

from study.questions.choice import Choice


class Select(Choice):
    """One of several options, one below the other."""

    kind: ClassVar[str] = "select"
