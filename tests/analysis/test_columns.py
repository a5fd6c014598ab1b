"""Reading columns of a CSV file, held to Python's own reader."""

import csv
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis import fields
from analysis.columns import read_columns
from analysis.fields import ResponsesError

NAMES = ["a", "b", "c"]
cells = st.one_of(
    st.text(st.sampled_from('xyé€𝄞",;\t\n '), max_size=12),
    st.sampled_from(
        ["", "joy", "joy ", "joyfully", "joyfully 2", "a participant's rather long name", "01", "1"]
    ),
)
tables = st.lists(st.tuples(cells, cells, cells).filter(any), max_size=30)


@given(
    rows=tables,
    mark=st.sampled_from(",;\t"),
    end=st.sampled_from(["\n", "\r\n"]),
    quoting=st.sampled_from([csv.QUOTE_MINIMAL, csv.QUOTE_ALL]),
    block=st.sampled_from([200, 500, 1 << 20]),
    start=st.sampled_from(["", "\ufeff"]),
)
def test_every_value_reads_back_wherever_blocks_end(
    tmp_path_factory: pytest.TempPathFactory, rows: list[tuple[str, str, str]], mark: str, end: str,
    quoting: int, block: int, start: str,
) -> None:  # fmt: skip
    path = tmp_path_factory.mktemp("csv") / "r.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(start)
        writer = csv.writer(file, delimiter=mark, lineterminator=end, quoting=quoting)
        writer.writerows([NAMES, *rows])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fields, "BLOCK", block)
        found = read_columns(path, NAMES)
    read = [tuple(found[name].at(row) for name in NAMES) for row in range(len(rows))]
    assert read == rows
    for column in found.values():
        assert len(set(column.values)) == len(column.values)
        assert {column.at(row) for row in range(len(rows))} == set(column.values)


@pytest.mark.parametrize(
    "text", ["a,b,c\n1,2,\n\n4,,6\n\n", "a,b,c\r1,2,\r4,,6", "\ufeff\na,b,c\n1,2,\n4,,6"]
)
def test_blank_lines_are_no_rows(tmp_path: Path, text: str) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text, encoding="utf-8", newline="")
    found = read_columns(path, ["c", "a"])
    assert [(found["a"].at(row), found["c"].at(row)) for row in (0, 1)] == [("1", ""), ("4", "6")]


@pytest.mark.parametrize(("text", "message"), [
    ("a,b\n1,2\n3,4,5\n", r"r.csv:3: has 3 values, but the header names 2 columns"),
    ("a,b\n1\n2\n", r"r.csv:2: has 1 value, but the header names 2 columns"),
    ("a,b\n1,2\n3\n", r"r.csv:3: has 1 value, but the header names 2 columns"),
    ("", r"r.csv: is empty"),
    ("\ufeff\n\n", r"r.csv: is empty"),
    ("PK\x03\x04", r"r.csv: is a workbook or an archive"),
    ("a\0,b\0\n", r"r.csv:1: holds a zero byte"),
    ('a,b\n1,2\n3,"x\ny\n', r"r.csv:3: a row that does not end; is a quotation mark left open"),
    ('a,b\n1,2\n3,4" tall "\n', r"r.csv:3: a stray quotation mark"),
    ('a,b\n1,2\n"3"4,5\n', r"r.csv:3: a stray quotation mark"),
    ("a,b\n1,2\n3,\0\n", r"r.csv:3: holds a zero byte"),
])  # fmt: skip
def test_what_has_two_readings_is_refused_at_its_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ResponsesError, match=message):
        read_columns(path, ["a"])


def test_thousands_of_values_are_told_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fields, "BLOCK", 5000)
    people = [f"P{person * 7919 % 4001}" for person in range(4001)] * 2
    (tmp_path / "r.csv").write_text("\n".join(["participant,item", *(f"{p},joy" for p in people)]))
    column = read_columns(tmp_path / "r.csv", ["participant"])["participant"]
    assert [column.values[code] for code in column.codes] == people
    assert len(column.values) == 4001
