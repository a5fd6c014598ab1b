"""Where the values of a CSV file stand, one block of rows after the other.

A delimiter or line end counts where an even number of quotation marks comes before it, so a block is cut
by a few passes over its bytes (as in Langdale & Lemire 2019, VLDB J 28) and no more than a block is held.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stimuli.errors import InputError

BLOCK = 1 << 20  # bytes read at once; no row may be longer
BOM = b"\xef\xbb\xbf"
NEWLINE, QUOTE = ord("\n"), ord('"')

Bytes = NDArray[np.uint8]
Places = NDArray[np.int64]


class ResponsesError(InputError):
    """A file of responses that cannot be read without guessing."""


@dataclass(frozen=True)
class Fields:
    """Some rows of a file: their text, where in it each value starts, and how long it is."""

    text: bytes  # UTF-8, and eight zero bytes at its end
    starts: Places  # (rows, columns)
    lengths: Places  # (rows, columns) bytes


def delimiter(path: Path) -> str:
    """Comma, semicolon or tab: whichever the header has most of."""
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        header = next(filter(str.strip, iter(lambda: file.readline(BLOCK), "")), "")
    return max(",;\t", key=header.count)


def read_header(path: Path) -> list[str]:
    """The names of the columns, or what is wrong with them."""
    try:
        with path.open("rb") as file:
            first = file.read(2)
    except OSError as error:
        raise ResponsesError(f"{path}: cannot be read: {error.strerror}") from error
    if first in {b"\xff\xfe", b"\xfe\xff"}:
        raise ResponsesError(f"{path}: is UTF-16 (Excel's 'Unicode text'); save the file as CSV UTF-8")
    if first == b"PK":
        raise ResponsesError(f"{path}: is a workbook or an archive; save the table as CSV UTF-8")
    with path.open(encoding="utf-8-sig", errors="replace", newline="") as file:
        columns = next(filter(None, csv.reader(file, delimiter=delimiter(path))), [])
    if not columns:
        raise ResponsesError(f"{path}: is empty")
    refuse_line_for_excel(path, columns[0])
    if any("\0" in column for column in columns):
        raise ResponsesError(f"{path}:1: holds a zero byte; save the file as CSV UTF-8")
    if twice := [column for column in columns if columns.count(column) > 1]:
        raise ResponsesError(f"{path}:1: column {twice[0]!r} stands twice")
    return columns


def refuse_line_for_excel(path: Path, first: str) -> None:
    """Raise ResponsesError where a file starts with the line that tells Excel what parts its columns."""
    if first.lower().startswith("sep="):
        raise ResponsesError(f"{path}:1: 'sep=' is a line for Excel, no header; delete it")


def read_fields(path: Path, columns: int) -> Iterator[Fields]:
    """The rows of a file, the header first; blank lines are no rows."""
    mark = ord(delimiter(path))
    line, rest = 1, b""
    with path.open("rb") as file:
        file.seek(len(BOM) if file.read(len(BOM)) == BOM else 0)
        at_end = False
        while not at_end:
            read = file.read(BLOCK)
            at_end = len(read) < BLOCK
            if read.endswith(b"\r"):
                read += file.read(1)
            if b"\r" in read:
                read = read.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
            block = _Block(path, line, rest + read + b"\n" * at_end, mark)  # the last line may lack its end
            yield block.fields(columns)
            rest = block.rest
            line += block.lines
    if rest.strip():
        raise _unended(path, line)


def _unended(path: Path, line: int) -> ResponsesError:
    return ResponsesError(f"{path}:{line}: a row that does not end; is a quotation mark left open?")


class _Block:
    """The whole rows at the start of a text, and where their values end."""

    def __init__(self, path: Path, line: int, text: bytes, mark: int) -> None:
        self.path, self.line, self.mark = path, line, mark  # line: where the text starts in the file
        body: Bytes = np.frombuffer(text, dtype=np.uint8)
        stops = body == mark
        stops |= body == NEWLINE
        self.quoted = QUOTE in text
        if self.quoted:
            stops &= ~np.logical_xor.accumulate(body == QUOTE)
        ends = np.flatnonzero(stops)
        last = body[ends] == NEWLINE
        if not last.any():
            raise _unended(path, line)
        kept = last.size - int(np.argmax(last[::-1]))
        size = int(ends[kept - 1]) + 1
        self.ends, self.last = ends[:kept], last[:kept]  # of values; and whether of rows too
        self.text, self.rest, self.body = text[:size], text[size:], body[:size]
        self.lines = int(np.count_nonzero(self.body == NEWLINE if self.quoted else self.last))

    def fields(self, columns: int) -> Fields:
        """Its rows, each with as many values as the header has."""
        self._refuse_other_bytes()
        starts = np.empty_like(self.ends)
        starts[0], starts[1:] = 0, self.ends[:-1] + 1
        rows = self.ends.size // columns
        whole = columns > 1 and np.count_nonzero(self.last) == rows and self.ends.size == rows * columns
        if whole and self.last[columns - 1 :: columns].all():
            starts, ends = starts.reshape(rows, columns), self.ends.reshape(rows, columns)
        else:
            starts, ends = self._without_blank_lines(starts, columns)
        if self.quoted:
            self._refuse_stray_quotes()
            within = self.body[starts] == QUOTE
            starts, ends = starts + within, ends - within
        return Fields(self.text + bytes(8), starts, ends - starts)

    def _without_blank_lines(self, starts: Places, columns: int) -> tuple[Places, Places]:
        """Starts and ends of the values of each row, (rows, columns)."""
        first = np.concatenate(([True], self.last[:-1]))
        blank = first & self.last & (starts == self.ends)
        starts, ends, last = starts[~blank], self.ends[~blank], self.last[~blank]
        row = np.cumsum(last) - last
        sizes = np.bincount(row)
        if (sizes != columns).any():
            bad = int(np.argmax(sizes != columns))
            place = int(starts[row == bad][0])
            values = "1 value" if sizes[bad] == 1 else f"{sizes[bad]} values"
            raise self._error(place, f"has {values}, but the header names {columns} columns")
        return starts.reshape(-1, columns), ends.reshape(-1, columns)

    def _refuse_other_bytes(self) -> None:
        try:
            self.text.decode()
        except UnicodeDecodeError as error:
            raise self._error(error.start, "is not UTF-8; save the file as CSV UTF-8") from error
        if (zero := self.text.find(b"\0")) >= 0:
            raise self._error(zero, "holds a zero byte; save the file as CSV UTF-8")

    def _refuse_stray_quotes(self) -> None:
        """Refuse a quotation mark that neither encloses a value nor is doubled within one."""
        marks = np.flatnonzero(self.body == QUOTE)
        outside = np.tile(
            [-1, 1], marks.size // 2
        )  # of an opening the byte before, of a closing the one after
        neighbours = self.body[marks + outside]
        stray = ~np.isin(neighbours, (self.mark, NEWLINE, QUOTE))
        if stray.any():
            place = int(marks[np.argmax(stray)])
            raise self._error(place, 'a stray quotation mark; within a value in quotation marks, write ""')

    def _error(self, place: int, said: str) -> ResponsesError:
        """What is wrong at a place in the text."""
        line = self.line + self.text.count(b"\n", 0, place)
        return ResponsesError(f"{self.path}:{line}: {said}")
