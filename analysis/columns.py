"""Columns of a CSV file: every distinct value once, and for each row only its number.

Five million rows take some bytes per row and column, whatever the length of their values.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from analysis.fields import Fields, Places, read_fields, read_header

WORD = 8  # bytes compared at once
KEEP = np.array([(1 << 8 * length) - 1 for length in range(WORD + 1)], dtype=np.uint64)  # of the first bytes
NO_WORD = (1 << 8 * WORD) - 1  # larger than any: UTF-8 has no byte 255
SCATTER = np.uint64(0x9E3779B97F4A7C15)  # 2⁶⁴ over the golden ratio: Knuth (1998), TAOCP 3, section 6.4
MOMENT = re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d")

Words = NDArray[np.uint64]
Numbers = NDArray[np.int32]
Codes = NDArray[np.integer]


@dataclass(frozen=True)
class Column:
    """The values of a column."""

    values: Sequence[str]  # distinct; each occurs
    codes: Codes  # (rows,) index of each row's value

    @classmethod
    def of(cls, values: Sequence[str], codes: Codes) -> Column:
        """From values that may stand twice or not occur."""
        occurring = np.unique(codes)
        distinct = list(dict.fromkeys(values[code] for code in occurring))
        place = {value: i for i, value in enumerate(distinct)}
        places = np.zeros(len(values), dtype=np.int64)
        places[occurring] = [place[values[code]] for code in occurring]
        return cls(distinct, places[codes])

    def renamed(self, names: Mapping[str, str]) -> Column:
        """The same with other names for some values."""
        return Column.of([names.get(value, value) for value in self.values], self.codes)

    def at(self, row: int) -> str:
        """The value of one row."""
        return self.values[int(self.codes[row])]


def read_columns(path: Path, names: Iterable[str]) -> dict[str, Column]:
    """Columns of a file as the texts that stand there, none of them taken for a number or a missing value."""
    header = read_header(path)
    gathered = {name: _Gathered(header.index(name)) for name in names}
    below = 1  # the header
    under_way: Iterator[None] = iter(())
    with ThreadPoolExecutor() as threads:  # columns are gathered while the next block is cut
        for fields in read_fields(path, len(header)):
            deque(under_way, maxlen=0)
            under_way = threads.map(_Gathered.add, gathered.values(), repeat(fields), repeat(below))
            below = 0
        deque(under_way, maxlen=0)
    return {name: column.whole() for name, column in gathered.items()}


def time_span(path: Path, name: str = "answered_at") -> tuple[str, str] | None:
    """The first and the last moment in a column, written as in ISO 8601; None where there are none."""
    header = read_header(path)
    if name not in header:
        return None
    place, span = header.index(name), set[bytes]()
    for fields in read_fields(path, len(header)):
        stretches = zip(fields.starts[:, place].tolist(), fields.lengths[:, place].tolist(), strict=True)
        found = {fields.text[start : start + length] for start, length in stretches}
        span |= {moment for moment in found if MOMENT.match(moment)}
        span = {min(span), max(span)} if span else span
    return (min(span).decode(), max(span).decode()) if span else None


class _Gathered:
    """A column while it is read."""

    def __init__(self, place: int) -> None:
        self.place = place
        self.values: list[str] = []
        self.blocks: list[Codes] = []
        self.spellings = _Spellings()
        self.codes = np.empty(0, dtype=np.int32)  # of spellings; −1 where it is but the beginning of one

    def add(self, fields: Fields, below: int) -> None:
        """Add the rows of a block from the row `below` on."""
        starts, lengths = fields.starts[below:, self.place], fields.lengths[below:, self.place]
        words = _words(fields.text, starts, lengths)
        first = _first_of_runs(fields.text, starts, lengths, words)
        codes = self._codes(fields.text, starts[first], lengths[first], words[first])
        codes = codes.astype(np.min_scalar_type(len(self.values)))
        self.blocks.append(np.repeat(codes, np.diff(first, append=starts.size)))

    def _codes(self, text: bytes, starts: Places, lengths: Places, words: Words) -> Codes:
        """The code of each value, (values,); new values get the next ones, in the order of rows."""
        spelling = self.spellings.numbers(text, starts, lengths, words)
        if (more := self.spellings.size - self.codes.size) > 0:
            self.codes = np.append(self.codes, np.full(more, -1, dtype=np.int32))
        codes: Codes = self.codes[spelling]
        if codes.min(initial=0) >= 0:
            return codes
        new = np.flatnonzero(codes < 0)
        new = new[np.sort(np.unique(spelling[new], return_index=True)[1])]
        self.codes[spelling[new]] = np.arange(len(self.values), len(self.values) + new.size)
        stretches = zip(starts[new].tolist(), lengths[new].tolist(), strict=True)
        self.values += [
            text[start : start + length].decode().replace('""', '"') for start, length in stretches
        ]
        return self.codes[spelling]

    def whole(self) -> Column:
        """The column when all is read."""
        return Column(self.values, np.concatenate([np.empty(0, dtype=np.uint8), *self.blocks]))


def _words(text: bytes, starts: Places, lengths: Places) -> Words:
    """The first eight bytes of each value, (rows,); zeros where it is shorter."""
    at_every_byte: Words = np.ndarray((len(text) - WORD,), "<u8", text, strides=(1,))
    return at_every_byte[starts] & KEEP[np.minimum(lengths, WORD)]


def _first_of_runs(text: bytes, starts: Places, lengths: Places, words: Words) -> Places:
    """The rows that hold another value than the row before; `words` are their first ones."""
    new = np.ones(starts.size, dtype=bool)
    new[1:] = (words[1:] != words[:-1]) | (lengths[1:] != lengths[:-1])
    for done in range(WORD, int(lengths.max(initial=0)), WORD):
        longer = np.flatnonzero(lengths > done)
        word = _words(text, starts[longer] + done, lengths[longer] - done)
        new[longer[1:]] |= word[1:] != word[:-1]
    return np.flatnonzero(new)


class _Spellings:
    """Numbers for values, the same where they are spelled alike: a tree of words of eight bytes."""

    def __init__(self) -> None:
        self.first, self.next, self.pairs = _Numbered(), _Numbered(), _Numbered()

    @property
    def size(self) -> int:
        """No number is larger."""
        return 2 * max(self.first.words.size, self.pairs.words.size)

    def numbers(self, text: bytes, starts: Places, lengths: Places, words: Words) -> Numbers:
        """The number of each value, (rows,), given its first word; beginnings of values too."""
        found = 2 * self.first.numbers(words)
        for done in range(WORD, int(lengths.max(initial=0)), WORD):
            longer = np.flatnonzero(lengths > done)
            word = self.next.numbers(_words(text, starts[longer] + done, lengths[longer] - done))
            pairs: Words = found[longer].astype(np.uint64) << np.uint64(32) | word.astype(np.uint64)
            found[longer] = 2 * self.pairs.numbers(pairs) + 1
        return found


class _Numbered:
    """Numbers for words, in the order of their coming, found in a hash table.

    Words that hash alike share a slot; all but one of them are searched for among the few without a slot.
    """

    def __init__(self) -> None:
        self._arrange(np.array([NO_WORD], dtype=np.uint64))

    def numbers(self, words: Words) -> Numbers:
        """The number of each word, (rows,)."""
        found = self._known(words)
        if found.min(initial=0) < 0:
            new = np.unique(words[found < 0])
            self._arrange(np.append(self.words, new))
            found = self._known(words)
        return found

    def _arrange(self, words: Words) -> None:
        """Give each word a slot, where `words` are in the order of their numbers."""
        self.words = words
        self.shift = np.uint64(8 * WORD - 3 - words.size.bit_length())  # at least eight slots for each
        self.slots = np.zeros(1 << 3 + words.size.bit_length(), dtype=np.int32)
        slot = self._slot(words)
        self.slots[slot] = np.arange(words.size)
        without = np.flatnonzero(self.words[self.slots[slot]] != words)
        self.without = without[np.argsort(words[without])]

    def _slot(self, words: Words) -> Words:
        slot: Words = (words * SCATTER) >> self.shift
        return slot

    def _known(self, words: Words) -> Numbers:
        """The number of each word, (rows,); −1 for new ones."""
        found: Numbers = self.slots[self._slot(words)]
        other = np.flatnonzero(self.words[found] != words)
        if other.size:
            known = np.append(self.words[self.without], np.uint64(NO_WORD))
            place = np.searchsorted(known, words[other])
            numbers = np.append(self.without, -1)[place]
            found[other] = np.where(known[place] == words[other], numbers, -1)
        return found
