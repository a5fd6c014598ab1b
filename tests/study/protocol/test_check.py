"""What `study check` says is one screen: what is good, what to mind, what must be mended."""

from datetime import date
from pathlib import Path

import pytest

from study.check import check
from study.design import design
from study.protocol import ProtocolError, load_protocol

PAPER = Path(__file__).parents[3] / "protocols" / "hielscher2025"


def found(report, about):
    return next(finding for finding in report.findings if finding.about == about)


def test_the_papers_protocol_is_one_screen():
    report = check(load_protocol(PAPER))
    assert len(str(report).splitlines()) <= 28
    assert found(report, "orders").message == "36 participants fill them evenly, as does every multiple of 6"
    assert found(report, "recognition").within == "orders"
    assert found(report, "stop").message == "the study closes itself when 36 have completed it"
    assert "against 3, the middle of the scale from 1 to 5; Holm correction over six tests" in (
        found(report, "H1").message
    )
    assert max(map(len, str(report).splitlines())) <= 110
    assert all(entry["about"] == entry["about"].strip() for entry in report.as_json()["findings"])
    assert found(report, "texts").verdict == "good"


def test_each_motion_is_told_of_as_it_is_checked():
    told = []
    protocol = load_protocol(PAPER)
    check(protocol, lambda done, of: told.append((done, of)))
    assert told == [(done, len(protocol.stimuli)) for done in range(1, len(protocol.stimuli) + 1)]


def test_a_demonstration_that_is_too_much_for_the_robot_is_said_once(load, written, tmp_path):
    (tmp_path / "gestures").mkdir()
    for file in written["gestures"].values():
        table = "time,HeadYaw\n0,0\n0.05,1\n0.1,0\n0.2,0\n0.3,0\n"
        (tmp_path / file).with_suffix(".csv").write_text(table)
    written["gestures"] = {name: f"gestures/{name}.csv" for name in written["gestures"]}
    message = found(check(load(written)), "gestures").message
    assert message.count("the demonstration itself exceeds what pepper can do: HeadYaw") == 2


def test_a_value_stands_once_in_its_message(load, written):
    written["robot"] = "peper"
    message = found(check(load(written)), "robot").message
    assert message.count("peper'") == 1 and "is not a robot; did you mean pepper?" in message


def test_a_gesture_is_told_from_a_protocol():
    with pytest.raises(ProtocolError, match="is a gesture, not a protocol"):
        load_protocol(PAPER / "gestures" / "wave.yaml")


def test_orders_that_need_no_number_say_so():
    report = check(load_protocol(PAPER.parent / "online"))
    assert found(report, "orders").message.startswith("any number of participants will do")
    assert found(report, "experts").message == "fixed: each seen 120 times"


def test_a_translation_of_our_own_is_to_be_minded(load, written):
    written["parts"]["recognition"]["ask"].append({"rate": {"set": "rosas warmth"}})
    (minded,) = (one for one in check(load(written)).findings if "our own translation" in one.message)
    assert (minded.verdict, minded.about) == ("mind", "texts")
    assert minded.message == "rosas warmth in de is our own translation, unpublished and not validated"


def test_uneven_numbers_and_missing_texts_and_gestures_are_said(load, written):
    written["participants"]["planned"] = 34
    written["languages"] = ["en", "de", "fr"]
    written["parts"]["recognition"]["ask"][0]["rate"]["items"]["joy"] = {"en": "Joy"}
    report = check(load(written))
    assert not report.good
    assert "uneven with 34 participants; even with 30 or 36" in found(report, "orders").message
    assert "ask[0].rate.items.joy: is missing in de and fr" in found(report, "texts").message
    assert "come in English and German; write your own for fr" in found(report, "texts").message
    assert "not in fr" in str(report), "the interface has no French catalogue"
    assert "gestures.explain: " in found(report, "gestures").message
    assert str(report).endswith("Not ready: mend what is marked ✗.")
    assert report.as_json()["good"] is False


def test_what_is_declared_but_never_shown_is_to_be_minded(load, written):
    written["modulations"] |= {
        "base": {"time": 1.1},
        "glee": {"extends": "base"},
        "tempo": {"grid": {"exa": [1, 2]}},
    }
    written["gestures"]["spare"] = "gestures/spare.yaml"
    written["parts"]["recognition"]["stimuli"]["modulations"].append("tempo_2")
    minded = [one.message for one in check(load(written)).findings if one.message.startswith("declared")]
    assert minded == [f"declared but shown in no part: {name}" for name in ("spare", "glee")]


def test_what_a_slip_of_the_pen_leaves_is_to_be_minded(load, written):
    written["title"] = "How does the robot move?"
    written["modulations"]["glee"] = written["modulations"]["joy"]
    written["parts"]["recognition"]["stimuli"]["modulations"].append("glee")
    report = check(load(written))
    assert found(report, "stimuli").message == "joy and glee are the same motion"
    minded = [one.message for one in report.findings if one.verdict == "mind"]
    assert "nobody sees those in de: the study is in en, as its title or `languages` says" in minded


def test_an_amendment_dated_ahead_is_to_be_minded(load, written):
    written["amendments"] = [{"date": "2026-11-23", "reason": "A word", "replaces": "0" * 12}]
    protocol = load(written)
    for today, minded in ((date(2026, 11, 22), ["2026-11-23 lies ahead; give the day of the change: A word"]),
                          (date(2026, 11, 23), [])):  # fmt: skip
        report = check(protocol, today=today)
        assert [one.message for one in report.findings if one.about == "amendments"] == minded


def test_one_participant_is_not_called_many(load, written):
    written["participants"]["planned"] = 1
    report, protocol = str(check(load(written))), load(written)
    assert "uneven with one participant; even with 6" in report
    assert "closes itself when one has completed it" in report and "1 participants" not in report
    assert str(design(protocol)).startswith("hielscher2025: one participant, each")


def test_of_very_many_participants_the_first_are_counted(load, written, monkeypatch):
    monkeypatch.setattr("study.check.DRAWN", 12)
    written["parts"]["recognition"]["order"] = {"stimuli": "shuffled", "max_run": {"modulation": 2}}
    report = check(load(written))
    brief = "shuffled, at most 2 of one modulation in a row: of the first 12, in each position"
    assert found(report, "recognition").message.startswith(brief)


def test_a_gesture_that_is_eased_is_to_be_minded(load, written, tmp_path):
    (tmp_path / "gestures").mkdir()
    samples = "".join(f"{k / 50},{0.4 * k / 50}\n" for k in range(51))
    (tmp_path / "gestures" / "cut.csv").write_text("time,HeadYaw\n" + samples)
    written = {name: written[name] for name in ("study", "title", "contact", "robot", "seed", "participants")}
    written |= {
        "gestures": {"cut": "gestures/cut.csv"},
        "parts": {
            "only": {
                "title": {"en": "Only", "de": "Nur"},
                "stimuli": {"gesture": "cut", "modulations": ["neutral"]},
                "ask": [{"text": {"item": "remark", "text": {"en": "Remark", "de": "Bemerkung"}}}],
            }
        },
    }
    minded = [one.message for one in check(load(written)).findings if one.about == "gestures"]
    assert minded[-1].startswith("cut moves at its start and end; eased over 0.2 s of it")
    refusing = load(written | {"learning": {"moving_ends": "refuse"}})
    assert "moves at its start or end" in str(check(refusing))


def test_joints_whose_speed_nobody_limits_are_named(load, tmp_path):
    body = "<body name='arm'><joint name='lift' range='-60 60'/><geom size='.1'/></body>"
    (tmp_path / "arm.xml").write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>")
    (tmp_path / "arm.yaml").write_text("robot: arm\ntitle: An arm\nmodel: arm.xml\n")
    (tmp_path / "nod.yaml").write_text(
        "gesture: nod\nduration: 1 s\njoints: {lift: {0: 0, 0.5: 0.1, 1: 0}}\n"
    )
    part = {"title": "Arm", "stimuli": {"gesture": "nod", "modulations": ["neutral"]}}
    rate = {"text": "Lively", "items": ["lively"], "points": 5, "ends": ["no", "yes"]}
    study = {"study": "arm", "title": "Arm", "contact": "lab@example.org", "robot": "arm.yaml", "seed": 1}
    study |= {"gestures": {"nod": "nod.yaml"}, "modulations": {"neutral": {}}}
    study |= {"parts": {"one": {**part, "ask": [{"rate": rate}]}}, "participants": {"planned": 4}}
    report = check(load(study))
    unknown = "arm.yaml: how fast lift may move is unknown, so it is not checked; give `velocities`"
    assert any(unknown in finding.message for finding in report.findings if finding.verdict == "mind")
