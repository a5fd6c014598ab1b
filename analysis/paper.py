"""A paper's text checked: its sentences, and its tables in Markdown or LaTeX."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from analysis.printed_layout import Record, arranged
from analysis.printed_table import table_of
from analysis.published import Fault, Verification, verify_printed
from analysis.statcheck import Checked, Reading, check_text, read_text, tables_in
from stimuli.errors import InputError

PIPES = re.compile(r"^[ \t]*\S.*\|.*\n[ \t:|-]*-[ \t:-]*\|[ \t:|-]*\n(?:.*\|.*(?:\n|\Z))*", re.MULTILINE)
TABULAR = re.compile(r"\\begin\{(tabular[*xy]?|longtable)\}(.*?)\\end\{\1\}", re.DOTALL)
COLUMNS = re.compile(r"\A(?:\[[^\]]*\]|\{(?:[^{}]|\{[^{}]*\})*\}|\s)*")  # how they are set, before the cells
RULES = re.compile(
    r"\\(?:(?:top|mid|bottom)rule|hline|[cx]?(?:mid)?(?:rule|line)(?:\([^)]*\))?\{[^}]*\})|(?<!\\)%.*"
)
ROW = re.compile(r"(.+?)(?:\\\\(?:\[[^\]]*\])?|\Z)", re.DOTALL)
SPANNING = re.compile(r"\\multicolumn\{(\d+)\}\{[^{}]*\}")
DIAGONAL = re.compile(r"\\diagbox(?:\[[^\]]*\])?\{[^{}]*\}\{[^{}]*\}")
SIGNS = {r"\uparrow": "↑", r"\downarrow": "↓", r"\%": "%", r"\_": "_", "--": "–", "~": " "}
COMMAND = re.compile(r"\\[A-Za-z]+\s?|[${}*`]")


@dataclass(frozen=True)
class Paper:
    """The sentences of a text, and each of its tables by the line where it starts."""

    reading: Reading
    tables: tuple[tuple[int, Verification | str], ...]  # a word where there is nothing to check in it

    @property
    def faults(self) -> tuple[Checked | Fault, ...]:
        """Whatever cannot be."""
        in_tables = [fault for _, one in self.tables if isinstance(one, Verification) for fault in one.faults]
        return (*self.reading.faults, *in_tables)

    def __str__(self) -> str:
        return "\n".join([str(self.reading), *(f"Table in line {line}: {one}" for line, one in self.tables)])


def check_paper(path: Path, n: int | None, *, items: int = 1) -> Paper:
    """Recompute the tests of a text; where n participants are behind its tables, check these as well."""
    text = read_text(path)
    sentences = check_text(text)
    if n is None:
        return Paper(Reading(tuple(sentences), tables=tables_in(text)), ())
    found = ((line, _verified(path, rows, n, items)) for line, rows in _tables(text))
    return Paper(Reading(tuple(sentences)), tuple(found))


def _verified(path: Path, rows: list[Record], n: int, items: int) -> Verification | str:
    """The table checked; rows of counts below shares, called n, are left out."""
    width = max(len(row.cells) for row in rows)
    filled = [replace(row, cells=(*row.cells, *[""] * (width - len(row.cells)))) for row in rows]
    head, *body = [row for row in filled if row.cells[0] not in ("n", "N")]
    try:
        header, records = arranged(list(head.cells), body)
        printed = table_of(path, header, records, n)
        if printed.kind != "means" and not printed.whole:
            return "not checked; it has no column of means, and its rows are no shares of one whole."
        return verify_printed(printed, n, items=items)
    except InputError as error:
        said = str(error).removeprefix(f"{path}:")
        return f"not checked; {said.strip() if said.startswith(' ') else f'line {said}'}."


def _tables(text: str) -> Iterator[tuple[int, list[Record]]]:
    """Each table that has rows below its heading, with the line where it starts."""
    found = {one.start(): _of_pipes(one[0], _line(text, one.start())) for one in PIPES.finditer(text)}
    found |= {one.start(): _of_latex(one[2], _line(text, one.start(2))) for one in TABULAR.finditer(text)}
    for start, table in sorted(found.items()):
        if len(rows := [*table]) > 1:
            yield _line(text, start), rows


def _of_pipes(table: str, line: int) -> Iterator[Record]:
    for at, row in enumerate(table.rstrip("\n").split("\n")):
        if at != 1:
            cells = re.split(r"(?<!\\)\|", row.strip().removeprefix("|").removesuffix("|"))
            yield Record(line + at, tuple(_plain(cell) for cell in cells))


def _of_latex(table: str, line: int) -> Iterator[Record]:
    body = COLUMNS.sub("", table, count=1)
    line += table.count("\n", 0, len(table) - len(body))
    for row in ROW.finditer(body):
        if written := RULES.sub("", row[1]).strip():
            cells = [cell for part in re.split(r"(?<!\\)&", written) for cell in _spanned(part)]
            yield Record(line + body.count("\n", 0, row.end(1)), tuple(cells))


def _spanned(cell: str) -> Iterator[str]:
    """A cell, and an empty one for each further column that it spans."""
    span = SPANNING.match(cell.strip())
    yield _plain(SPANNING.sub("", cell))
    yield from [""] * (int(span[1]) - 1 if span else 0)


def _plain(cell: str) -> str:
    for written, meant in SIGNS.items():
        cell = cell.replace(written, meant)
    return COMMAND.sub("", DIAGONAL.sub("", cell)).strip()


def _line(text: str, place: int) -> int:
    return text.count("\n", 0, place) + 1
