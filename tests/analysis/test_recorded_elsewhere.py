"""Whole studies in the files that survey programs export give the numbers of our own file."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from analysis.dataset import Responses, read_responses
from analysis.fields import ResponsesError
from study.protocol import Protocol, load_protocol
from study.protocol.errors import ProtocolError
from tests.analysis.conftest import EMOTIONS, PAPER, Row, Write, choices, ratings

N = 5
ROWS: list[Row] = [*ratings(n=N), *choices(n=N)]
JUDGED = list(dict.fromkeys((stimulus, item) for _, stimulus, item, _ in ROWS))
PEOPLE = list(dict.fromkeys(row[0] for row in ROWS))
GIVEN = {(person, stimulus, item): answer for person, stimulus, item, answer in ROWS}
CODES = {emotion: f"G02Q{place:02}" for place, emotion in enumerate(EMOTIONS, 3)}  # LimeSurvey's
SUBQUESTIONS = {emotion: f"SQ{place:03}" for place, emotion in enumerate(EMOTIONS, 1)}
LIMESURVEY = f"""
  responses:
    columns: {{participant: token}}
    stimuli: {json.dumps(CODES)}
    items: {json.dumps(SUBQUESTIONS)}
    answers:
      recognition: {{1: AO01, 2: AO02, 3: AO03, 4: AO04, 5: AO05}}
      intensity: {{lower: A1, higher: A2, "": [N/A]}}
"""
LABELS = ("not at all", "2", "3", "4", "very strongly")
QUALTRICS = """
  responses:
    columns: {participant: ResponseId, arc_low.intensity: QID77}
    answers:
      recognition: {1: not at all, 5: very strongly}
      intensity: {lower: [lower intensity, "1"], higher: higher intensity}
"""

VARIABLES = {emotion: f"A{place}01" for place, emotion in enumerate(EMOTIONS, 1)}  # SoSci Survey's
SOSCI = f"""
  responses:
    columns: {{participant: CASE}}
    stimuli: {json.dumps(VARIABLES)}
    items: {json.dumps({emotion: f"{place:02}" for place, emotion in enumerate(EMOTIONS, 1)})}
    answers:
      recognition: {{"": ["-9", "-1"]}}
      intensity: {{lower: "1", higher: "2", "": "-9"}}
"""


def saying(folder: Path, said: str) -> Protocol:
    """The paper's study with what a file calls its names."""
    text = (PAPER / "protocol.yaml").read_text(encoding="utf-8")
    path = folder / "protocol.yaml"
    path.write_text(text.rstrip() + said, encoding="utf-8")
    return load_protocol(path)


def limesurvey_answer(stimulus: str, answer: str) -> str:
    return f"AO0{answer}" if stimulus in EMOTIONS else {"lower": "A1", "higher": "A2"}[answer]


def limesurvey(delimiter: str = ";") -> str:
    """Headings by question code, answers by code, every cell in quotation marks, a BOM."""
    header = ["id", "submitdate", "lastpage", "startlanguage", "seed", "token"]
    header += [f"{CODES[s]}[{SUBQUESTIONS[i]}]" if s in CODES else s for s, i in JUDGED]
    records = [
        [str(number), "2026-11-20 10:12:13", "4", "de", "1712345678", person]
        + [limesurvey_answer(s, GIVEN[person, s, i]) for s, i in JUDGED]
        for number, person in enumerate(PEOPLE, 1)
    ]
    return "\ufeff" + table([header, *records], delimiter, csv.QUOTE_ALL)


def qualtrics_answer(stimulus: str, answer: str) -> str:
    return LABELS[int(answer) - 1] if stimulus in EMOTIONS else f"{answer} intensity"


def qualtrics(status: str = "IP Address") -> str:
    """Three header rows, one of them with line breaks, choices as text."""
    names = ["StartDate", "Status", "Finished", "ResponseId"]
    names += ["QID77" if s == "arc_low" else f"{s}_{i}" if s in EMOTIONS else s for s, i in JUDGED]
    texts = ["Start Date", "Response Type", "Finished", "Response ID"]
    texts += [f'To which extent does the robot "express" …\n\n- {i}' for _, i in JUDGED]
    imported = [json.dumps({"ImportId": name}, separators=(",", ":")) for name in names]
    records = [
        ["2026-11-20 10:12:13", status if person == "P03" else "IP Address", "True", person]
        + [qualtrics_answer(s, GIVEN[person, s, i]) for s, i in JUDGED]
        for person in PEOPLE
    ]
    return table([names, texts, imported, *records], ",", csv.QUOTE_MINIMAL)


def sosci(*, labels: bool, mode: str = "interview") -> str:
    """Variables by question and item, codes, a row of labels if asked for, and who was only testing."""
    names = ["CASE", "SERIAL", "REF", "QUESTNNR", "MODE", "STARTED"]
    names += [f"{VARIABLES[s]}_{EMOTIONS.index(i) + 1:02}" if s in EMOTIONS else s for s, i in JUDGED]
    texts = ["Interview-Nummer (fortlaufend)", "Personenkennung oder Teilnahmecode (sofern verwendet)"]
    texts += ["Referenz (sofern im Link angegeben)", "Fragebogen, der im Interview verwendet wurde"]
    texts += ["Interview-Modus", "Zeitpunkt zu dem das Interview begonnen hat (Europe/Berlin)"]
    texts += [f"Ausdruck: {i}" for _, i in JUDGED]
    codes = {"lower": "1", "higher": "2"}
    records = [
        [str(number), "", "", "base", mode if person == "P03" else "interview", "2026-11-20 10:12:13"]
        + [codes.get(GIVEN[person, s, i], GIVEN[person, s, i]) for s, i in JUDGED]
        for number, person in enumerate(PEOPLE, 101)
    ]
    return "\ufeff" + table([names, *([texts] if labels else []), *records], ";", csv.QUOTE_ALL)


def table(records: Sequence[Sequence[str]], delimiter: str, quoting: int) -> str:
    file = io.StringIO(newline="")
    csv.writer(file, delimiter=delimiter, quoting=quoting, lineterminator="\r\n").writerows(records)  # type: ignore[arg-type]
    return file.getvalue()


def read(folder: Path, protocol: Protocol, text: str) -> Responses:
    path = folder / "export.csv"
    path.write_bytes(text.encode())
    return read_responses(path, protocol)


def assert_same(found: Responses, own: Responses) -> None:
    assert found.participants == own.participants
    for one, other in zip(found.questions, own.questions, strict=True):
        assert np.array_equal(one.codes, other.codes)


@pytest.mark.parametrize(
    ("said", "text"),
    [
        (LIMESURVEY, limesurvey()),
        (LIMESURVEY, limesurvey(",")),
        (LIMESURVEY, limesurvey("\t")),
        (QUALTRICS, qualtrics()),
        (QUALTRICS, qualtrics("0")),
    ],
    ids=["LimeSurvey ;", "LimeSurvey ,", "LimeSurvey tab", "Qualtrics in words", "Qualtrics' numbers"],
)
def test_an_export_gives_the_same_answers_as_our_own_file(
    paper: Protocol, write: Write, tmp_path: Path, said: str, text: str
) -> None:
    assert_same(read(tmp_path, saying(tmp_path, said), text), read_responses(write(ROWS), paper))


@pytest.mark.parametrize("labels", [True, False])
def test_sosci_survey_has_a_row_of_labels_or_none(
    paper: Protocol, write: Write, tmp_path: Path, labels: bool
) -> None:
    found = read(tmp_path, saying(tmp_path, SOSCI), sosci(labels=labels))
    own = read_responses(write(ROWS), paper)
    assert found.participants == ("101", "102", "103", "104", "105")
    for one, other in zip(found.questions, own.questions, strict=True):
        assert np.array_equal(one.codes, other.codes)
    all_but_one = re.sub(r'"\d"\s*$', '"-9"\n', sosci(labels=labels))
    missing = read(tmp_path, saying(tmp_path, SOSCI), all_but_one).answers("intensity").codes
    assert np.sum(missing < 0) == 1


def test_one_row_per_answer_may_have_other_names_too(paper: Protocol, write: Write, tmp_path: Path) -> None:
    named = {emotion: f"clip {place}" for place, emotion in enumerate(EMOTIONS)}
    freude = {"joy": "Freude"}
    said = f"\n  responses: {{stimuli: {json.dumps(named)}, items: {json.dumps(freude)}}}\n"
    rows = [
        f"{p},{named.get(s, s)},{'Freude' if i == 'joy' else i},{answer}"
        for (p, s, i), answer in GIVEN.items()
    ]
    text = "participant,stimulus,item,response\n" + "\n".join(rows) + "\n"
    assert_same(read(tmp_path, saying(tmp_path, said), text), read_responses(write(ROWS), paper))


@pytest.mark.parametrize(
    ("said", "text", "message"),
    [
        (LIMESURVEY, limesurvey().replace("AO01", "AO09", 1),
         r"export\.csv:2: response 'AO09' is not an answer to \w+; known: AO01, AO02, AO03, AO04, AO05, or"),
        (LIMESURVEY, limesurvey().replace('"AO02"', '"2"', 1),
         r"export\.csv:2: response '2' is not an answer to \w+; known: AO01"),
        (LIMESURVEY, limesurvey().replace("P02", "P01"),
         r"export\.csv:4: second answer to \(P01, joy, joy\); the first is in line 3"),
        (LIMESURVEY, limesurvey().replace("G02Q05[SQ001]", "G02Q05[SQ007]"),
         r"export\.csv:1: has no column for anger\.joy; name it in the protocol, under analysis: responses"),
        (LIMESURVEY.replace("token", "tokens"), limesurvey(),
         r"export\.csv:1: column 'tokens', said to be participant, is not among id, submitdate"),
        (QUALTRICS, qualtrics("Survey Preview"),
         r"export\.csv:\d+: Status 'Survey Preview' is no participant's answer; leave out such rows"),
        (QUALTRICS, qualtrics("1"), r"Status '1' is no participant's answer"),
        (SOSCI, sosci(labels=True, mode="debug"),
         r"export\.csv:6: MODE 'debug' is no participant's answer; leave out such rows$"),
        (SOSCI, sosci(labels=True).replace("QUESTNNR", "QNR"),
         r"export\.csv:2: response 'Ausdruck: joy' .* none\. If this row holds headings, leave it out"),
        (QUALTRICS, qualtrics().replace("very strongly", "strongly"),
         r"response 'strongly' is not an answer to \w+; known: not at all, 2, 3, 4, very strongly"),
    ],
)  # fmt: skip
def test_what_an_export_leaves_open_is_refused_by_name(
    tmp_path: Path, said: str, text: str, message: str
) -> None:
    with pytest.raises(ResponsesError, match=message):
        read(tmp_path, saying(tmp_path, said), text)


def test_the_line_of_a_bad_answer_is_that_of_the_file(tmp_path: Path) -> None:
    text = qualtrics().replace("lower intensity", "lowest intensity", 1)
    line = text[: text.index("lowest intensity")].count("\n") + 1
    with pytest.raises(ResponsesError, match=rf"export\.csv:{line}: response 'lowest intensity'"):
        read(tmp_path, saying(tmp_path, QUALTRICS), text)


def test_a_part_may_be_in_another_file_and_a_column_said_to_be_left_out(tmp_path: Path) -> None:
    left_out = QUALTRICS.replace("arc_low.intensity: QID77", 'arc_low.intensity: ""')
    found = read(tmp_path, saying(tmp_path, left_out), qualtrics())
    intensity = found.answers("intensity")
    assert (intensity.codes[:, intensity.stimuli.index("arc_low")] < 0).all()
    only = (
        "ResponseId," + ",".join(f"{s}_{i}" for s in EMOTIONS for i in EMOTIONS) + "\nP1" + ",3" * 36 + "\n"
    )
    found = read(tmp_path, saying(tmp_path, QUALTRICS.replace(", arc_low.intensity: QID77", "")), only)
    assert (found.answers("intensity").codes < 0).all()
    assert (found.answers("recognition").codes == 2).all()


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ("{columns: {person: PID}}", r"responses\.columns: 'person' is no column, nor STIMULUS\.ITEM"),
        ("{stimuli: {envy: Q1}}", r"responses\.stimuli: 'envy' is no stimulus; known: joy"),
        ("{items: {joi: SQ1}}", r"responses\.items: 'joi' is no item; did you mean joy\?"),
        ("{answers: {intensity: {lowered: A1}}}", r"'lowered' is no answer to intensity; did you mean lower"),
        ("{answers: {envy: {lower: A1}}}", r"responses\.answers: 'envy' is no part or item"),
        ("{colums: {}}", r"colums: is no field here; did you mean columns\?"),
    ],
)
def test_names_that_the_study_lacks_are_refused_in_the_protocol(
    tmp_path: Path, said: str, message: str
) -> None:
    with pytest.raises(ProtocolError, match=message):
        saying(tmp_path, f"\n  responses: {said}\n")
