"""What `study check` says is one screen: what is good, what to mind, what must be mended."""

from pathlib import Path

from study.check import check
from study.protocol import load_protocol

PAPER = Path(__file__).parents[3] / "protocols" / "hielscher2025"


def found(report, about):
    return next(finding for finding in report.findings if finding.about == about)


def test_the_papers_protocol_is_one_screen():
    report = check(load_protocol(PAPER))
    assert len(str(report).splitlines()) <= 24
    assert found(report, "orders").message == "balanced for 36 participants (a multiple of 6)"
    assert found(report, "texts").verdict == "good"


def test_uneven_numbers_and_missing_texts_and_gestures_are_said(load, written):
    written["participants"]["planned"] = 34
    written["languages"] = ["en", "de", "fr"]
    written["parts"]["recognition"]["ask"][0]["rate"]["items"]["joy"] = {"en": "Joy"}
    report = check(load(written))
    assert not report.good
    assert "30 or 36 would not" in found(report, "orders").message
    assert "ask[0].rate.items.joy: is missing in de and fr" in found(report, "texts").message
    assert "texts.consent: is missing in fr" in found(report, "texts").message
    assert "not in fr" in str(report), "the interface has no French catalogue"
    assert "gestures.explain: " in found(report, "gestures").message
    assert str(report).endswith("Not ready: mend what is marked ✗.")
    assert report.as_json()["good"] is False
