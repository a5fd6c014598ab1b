from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest

from analysis.dataset import Responses, read_responses
from analysis.fields import ResponsesError
from analysis.published import HIGHER
from study.protocol import Protocol
from tests.analysis.conftest import EMOTIONS, Write, choices, ratings


def test_answers_stand_where_the_protocol_says_whatever_the_order_of_rows(
    paper: Protocol, write: Write
) -> None:
    rows = [*ratings(), *choices()]
    sorted_responses = read_responses(write(rows, "a.csv"), paper)
    random.Random(3).shuffle(rows)
    shuffled = read_responses(write(rows, "b.csv"), paper)
    assert shuffled.participants == sorted_responses.participants
    for one, other in zip(sorted_responses.questions, shuffled.questions, strict=True):
        assert np.array_equal(one.codes, other.codes)
    assert sorted_responses.answers("intensity").options == ("lower", "higher")
    assert sorted_responses.answers("recognition").stimuli == EMOTIONS


def test_every_rating_reads_back(paper: Protocol, write: Write) -> None:
    rows = ratings(n=5)
    answers = read_responses(write(rows), paper).answers("recognition")
    for participant, stimulus, item, response in rows:
        place = (
            answers.participants.index(participant),
            answers.stimuli.index(stimulus),
            answers.items.index(item),
        )
        assert answers.ratings[place] == float(response)


def test_participants_are_texts_even_where_they_look_like_numbers(paper: Protocol, write: Write) -> None:
    rows = [("01", "joy", "joy", "4"), ("10", "joy", "joy", "2"), ("2.0", "joy", "joy", "5")]
    answers = read_responses(write(rows), paper).answers("recognition")
    assert sorted(answers.participants) == ["01", "10", "2.0"]


def test_levels_are_told_apart_by_name_not_by_appearance(paper: Protocol, write: Write) -> None:
    for rows in (choices(), choices()[::-1]):
        answers = read_responses(write([*ratings(), *rows]), paper).answers("intensity")
        chose = answers.chose("higher")
        for principle, counts in HIGHER.items():
            assert np.nansum(chose[:, answers.stimuli.index(f"{principle}_high")]) == counts["high"]
            assert np.nansum(chose[:, answers.stimuli.index(f"{principle}_low")]) == counts["low"]


def test_empty_and_absent_answers_are_missing(paper: Protocol, write: Write) -> None:
    rows = ratings(n=2)
    first = rows[0][:3]
    answers = read_responses(write([(*first, ""), *rows[2:]]), paper).answers("recognition")
    assert np.isnan(answers.ratings[0, 0, :2]).all()
    assert int(np.isnan(answers.ratings).sum()) == 2


@pytest.mark.parametrize("text", [
    "﻿participant,stimulus,item,response\nP1,joy,joy,4\n",
    "participant;stimulus;item;response\nP1;joy;joy;4\n",
    "participant\tstimulus\titem\tresponse\r\nP1\tjoy\tjoy\t4\r\n",
    "\r\nparticipant;stimulus;item;response\r\nP1;joy;joy;4\r\n",
    "participant,trial,stimulus,item,response\nP1,1764000000000,joy,joy,4\n",
    'note,response,item,stimulus,participant\n"a, ""b""\nc",4,joy,joy,P1\n',
])  # fmt: skip
def test_ways_of_writing_a_table_that_leave_no_doubt_are_read(
    paper: Protocol, tmp_path: Path, text: str
) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text, encoding="utf-8")
    assert read_responses(path, paper).answers("recognition").ratings[0, 0, 0] == 4


HEADER = "participant,stimulus,item,response\n"


@pytest.mark.parametrize(("text", "message"), [
    ("participant,stimulus,item\n", r"r.csv:1: needs the columns .*; response not among"),
    ("", r"r.csv: is empty"),
    (HEADER, r"r.csv: holds no answers below its header"),
    (HEADER + "1,joy,joy,4\n01,joy,fear,4\n", r"participant '1' is also written '01'"),
    (HEADER + "1,joy,joy,4\n1.0,joy,fear,4\n", r"r.csv:3: participant '1.0' is also written '1'"),
    (HEADER + "P1,joy,joy,4\nP1 ,joy,fear,4\n", r"r.csv:3: participant 'P1 ' is also written 'P1'"),
    ("response," + HEADER, r"r.csv:1: column 'response' stands twice"),
    (HEADER + "P1,joy,joy,6\n", r"r.csv:2: response '6' is not an answer to joy; known: 1, 2, 3, 4, 5"),
    (HEADER + 'P1,joy,joy,4\nP1,"sa\nd",joy,4\n', r"r.csv:4: stimulus 'sa\\nd' is not in the protocol"),
    (HEADER + "\nP1,joy,envy,4\n", r"r.csv:3: item 'envy' is not asked about joy; known: anger, fear"),
    (HEADER + "P1,joy,joy,4\nP2,joy,joy,4\nP1,joy,joy,5\n",
     r"r.csv:4: second answer to \(P1, joy, joy\); the first is in line 2"),
    (HEADER + "P1\n", r"r.csv:2: has 1 value, but the header names 4 columns"),
    (HEADER + "P1,joy,joy,4,5\nP1,joy,joy,4\n", r"r.csv"),
    ("sep=;\n" + HEADER.replace(",", ";"), r"r.csv:1: 'sep=' is a line for Excel"),
    (HEADER + ",joy,joy,4\n", r"r.csv:2: has no participant"),
    (HEADER + " ,joy,joy,4\n", r"r.csv:2: has no participant"),
    ("part," + HEADER + "recogniton,P1,joy,joy,4\n", r"r.csv:2: part 'recogniton' is not in the protocol"),
])  # fmt: skip
def test_what_cannot_be_read_without_guessing_is_refused_at_its_line(
    paper: Protocol, tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "r.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ResponsesError, match=message):
        read_responses(path, paper)


@pytest.mark.parametrize(("content", "message"), [
    ((HEADER + "P1,joy,joy,4\nPé,joy,joy,4\n").encode("latin-1"), r"r.csv:3: is not UTF-8"),
    (HEADER.encode("utf-16"), r"is UTF-16"),
])  # fmt: skip
def test_other_encodings_are_refused_by_name(
    paper: Protocol, tmp_path: Path, content: bytes, message: str
) -> None:
    path = tmp_path / "r.csv"
    path.write_bytes(content)
    with pytest.raises(ResponsesError, match=message):
        read_responses(path, paper)
    with pytest.raises(ResponsesError, match="cannot be read"):
        read_responses(tmp_path / "none.csv", paper)


def test_practice_and_demographics_are_left_out(paper: Protocol, tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text(
        "participant,part,stimulus,item,response\n"
        "P1,demographics,,age,31\nP1,recognition,practice,joy,3\nP1,recognition,joy,joy,4\n",
        encoding="utf-8",
    )
    assert int((read_responses(path, paper).answers("recognition").codes >= 0).sum()) == 1


def read(paper: Protocol, folder: Path, text: str, columns: dict[str, str] | None = None) -> Responses:
    path = folder / "r.csv"
    path.write_text(text, encoding="utf-8")
    return read_responses(path, paper, columns)


@pytest.mark.parametrize(("kind", "note"), [
    ("participant", ""), ("simulated", "Simulated answers, no data"), ("test", "Test answers, no data"),
])  # fmt: skip
def test_answers_that_are_no_data_say_so(paper: Protocol, tmp_path: Path, kind: str, note: str) -> None:
    text = f"participant,stimulus,item,response,session\nP1,joy,joy,4,{kind}\n"
    assert read(paper, tmp_path, text).note == note


@pytest.mark.parametrize(("rows", "message"), [
    ("P1,joy,joy,4,participant\nP2,joy,joy,4,simulated\n", "r.csv:3: simulated answers among participant"),
    ("P1,joy,joy,4,2\n", "r.csv:2: session '2' is none of participant, .* --column session="),
])  # fmt: skip
def test_kinds_of_answers_are_never_mixed_or_guessed(
    paper: Protocol, tmp_path: Path, rows: str, message: str
) -> None:
    with pytest.raises(ResponsesError, match=message):
        read(paper, tmp_path, "participant,stimulus,item,response,session\n" + rows)


def test_columns_may_bear_other_names(paper: Protocol, tmp_path: Path) -> None:
    text = "PID;clip;item;value;session\nP1;joy;joy;4,0;first\n"
    said = {"participant": "PID", "stimulus": "clip", "response": "value", "session": ""}
    found = read(paper, tmp_path, text, said)
    assert found.answers("recognition").ratings[0, 0, 0] == 4
    with pytest.raises(ResponsesError, match=r"column 'ID', said to be participant, is not among PID, clip"):
        read(paper, tmp_path, text, {"participant": "ID"})
    with pytest.raises(ResponsesError, match=r"'person' is neither one of participant"):
        read(paper, tmp_path, text, {"person": "PID"})


def test_a_wide_table_needs_to_say_who_answered(paper: Protocol, tmp_path: Path) -> None:
    columns = ",".join(f"{s}[{i}]" for s in EMOTIONS for i in EMOTIONS)
    with pytest.raises(ResponsesError, match=r"none called participant; name it as in --column"):
        read(paper, tmp_path, f"id,{columns}\n1{',3' * 36}\n")
    found = read(paper, tmp_path, f"id,{columns}\n1{',3' * 36}\n", {"participant": "id"})
    assert (found.answers("recognition").ratings == 3).all()


def test_the_file_says_when_it_was_answered(paper: Protocol, tmp_path: Path) -> None:
    head = "answered_at,participant,stimulus,item,response\n"
    moments = ["2026-11-22T07:01:32.065Z", "2026-10-01T09:00:00.000Z", "", "2026-11-02T00:00:00.000Z"]
    rows = "".join(f"{moment},P{n},joy,joy,4\n" for n, moment in enumerate(moments))
    assert read(paper, tmp_path, head + rows).answered == (moments[1], moments[0])
    assert read(paper, tmp_path, head + "yesterday,P1,joy,joy,4\n").answered is None


def test_times_are_numbers_or_refused(paper: Protocol, tmp_path: Path) -> None:
    head = "participant;stimulus;item;response;rt_ms\n"
    found = read(paper, tmp_path, head + "P1;joy;joy;4;1500,5\n")
    assert found.median_rt_s is not None and found.median_rt_s[0] == pytest.approx(1.5005)
    with pytest.raises(ResponsesError, match=r"r.csv:2: rt_ms 'soon' is not a number"):
        read(paper, tmp_path, head + "P1;joy;joy;4;soon\n")
