"""How the cells of a published table stand in a CSV file: answers below each other, or side by side.

Who copies a table in which groups stand side by side gives it two rows of headings, of which the first may
leave merged cells empty, or one row of names that end in the answer:

    ,Arc,,Ant,                              ,Arc ↑,Arc ↓,Ant ↑,Ant ↓
    ,↑,↓,↑,↓                                high,0.94,0.06,0.79,0.21
    high,0.94,0.06,0.79,0.21                low,0.00,1.00,0.26,0.74
    low,0.00,1.00,0.26,0.74
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from itertools import groupby
from pathlib import Path

from analysis.fields import refuse_line_for_excel
from stimuli.errors import InputError

DELIMITERS = ",;\t"
LAST_WORD = re.compile(r"(.*\S)[\s_:/]+(\S+)")  # "Arc ↑", "ant_lower": the group, and the answer


@dataclass(frozen=True)
class Record:
    """A row of the table."""

    line: int
    cells: tuple[str, ...]


def read_records(path: Path) -> tuple[list[str], list[Record]]:
    """The names of the columns of a CSV file, and its rows."""
    return arranged(*_read(path))


def arranged(header: list[str], records: list[Record]) -> tuple[list[str], list[Record]]:
    """The same table with answers that stand side by side below each other."""
    if (below := _second_header(header, records)) is not None:
        groups, answers = _filled(header), below
        records = records[1:]
    else:
        groups, answers = _split(header)
    numbers = [place for place, answer in enumerate(answers) if answer]
    found = [[answers[place] for place in places] for _, places in _groups(groups, numbers)]
    if len(found) < 2 or len(found[0]) < 2 or any(one != found[0] for one in found):
        return header, records
    labels = [place for place in range(len(header)) if place not in numbers]
    return (
        ["", *(header[place] for place in labels), *found[0]],
        [
            Record(record.line, (group, *(record.cells[place] for place in (*labels, *places))))
            for group, places in _groups(groups, numbers)
            for record in records
        ],
    )


def number(text: str) -> Decimal | None:
    """A printed number: 0.79, .79, 0,79, 79%, −0.5."""
    plain = text.strip().removesuffix("%").strip().replace("−", "-").replace(",", ".")
    try:
        found = Decimal(plain)
    except InvalidOperation:
        return None
    return found if found.is_finite() else None


def _groups(groups: Sequence[str], places: Sequence[int]) -> list[tuple[str, list[int]]]:
    """Columns that stand side by side under one name."""
    return [(name, list(same)) for name, same in groupby(places, lambda place: groups[place])]


def _second_header(header: Sequence[str], records: Sequence[Record]) -> list[str] | None:
    """The answers in a second row of headings, where there is one; empty for columns of labels."""
    first, *rest = records
    numeric = [
        all(number(record.cells[place]) is not None for record in rest) for place in range(len(header))
    ]
    named = [cell for cell, is_number in zip(first.cells, numeric, strict=True) if is_number]
    if not rest or not named or any(not cell or number(cell) is not None for cell in named):
        return None
    return [cell if is_number else "" for cell, is_number in zip(first.cells, numeric, strict=True)]


def _filled(header: Sequence[str]) -> list[str]:
    """The names of merged cells, over each of their columns."""
    names: list[str] = []
    for name in header:
        names.append(name or (names[-1] if names else ""))
    return names


def _split(header: Sequence[str]) -> tuple[list[str], list[str]]:
    """Group and answer of each column; both empty where its name is but one word."""
    found = [LAST_WORD.fullmatch(name) for name in header]
    return [one[1] if one else "" for one in found], [one[2] if one else "" for one in found]


def _read(path: Path) -> tuple[list[str], list[Record]]:
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8; save the table as CSV UTF-8") from error
    refuse_line_for_excel(path, text)
    lines = text.splitlines()
    delimiter = max(DELIMITERS, key=lines[0].count) if lines else ","
    reader = csv.reader(lines, delimiter=delimiter)
    records = [Record(reader.line_num, tuple(cell.strip() for cell in row)) for row in reader if any(row)]
    if len(records) < 2:
        raise InputError(f"{path}: holds no rows below its header")
    header = list(records[0].cells)
    for record in records[1:]:
        if len(record.cells) != len(header):
            raise InputError(
                f"{path}:{record.line}: has {len(record.cells)} cells; the header has {len(header)}"
            )
    return header, records[1:]
