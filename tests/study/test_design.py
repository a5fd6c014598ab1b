"""The design on one screen."""

from pathlib import Path

from study.design import design
from study.protocol import load_protocol

PROTOCOLS = Path(__file__).parents[2] / "protocols"


def test_the_papers_design_is_read_off_its_protocol():
    found = design(load_protocol(PROTOCOLS / "hielscher2025"))
    recognition, intensity = found.parts
    assert recognition.factors["modulation"] == ["joy", "sadness", "anger", "fear", "shame", "hurry"]
    assert intensity.factors["level"] == ["low", "high"]
    assert (recognition.pages, intensity.pages) == (6, 12)
    assert not recognition.between
    assert found.cycle == 6
    assert "and even with 36" in str(found)
    assert len(str(found).splitlines()) <= 24


def test_groups_and_conditions_are_said():
    assert "(between participants, 1 page)" in str(design(load_protocol(PROTOCOLS / "godspeed")))
    assert "experience is sometimes or often" in str(design(load_protocol(PROTOCOLS / "online")))


def test_of_very_many_participants_the_first_orders_are_counted(monkeypatch):
    monkeypatch.setattr("study.design.DRAWN", 6)
    (part, *_) = design(load_protocol(PROTOCOLS / "template")).parts
    assert part.balance == "of the first 6, in each position 2 times, after each other 2 times"
