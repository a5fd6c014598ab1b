"""What is wrong with a protocol, said all at once and each at its place."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from stimuli.errors import InputError


@dataclass(frozen=True)
class Problem:
    """One thing to mend: where it stands, which field it is, what is there and what would do."""

    file: Path
    line: int | None
    column: int | None
    field: str
    message: str

    def __str__(self) -> str:
        place = ":".join(str(part) for part in (self.file, self.line, self.column) if part is not None)
        return f"{place}: {self.field}: {self.message}" if self.field else f"{place}: {self.message}"


SHOWN = 50  # problems at most in one message


class ProtocolError(InputError):
    """Everything found wrong in one reading of a protocol, in the order of the file."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(sorted(problems, key=lambda problem: (problem.line or 0, problem.column or 0)))
        more = len(self.problems) - SHOWN
        rest = [f"and {more} more problems; mend these first"] if more > 0 else []
        super().__init__("\n".join([*map(str, self.problems[:SHOWN]), *rest]))
