"""A valid protocol broken in hundreds of ways: each time an error at its line, never a traceback."""

import copy
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from study.protocol import ProtocolError

PAPER = Path(__file__).parents[3] / "protocols" / "hielscher2025" / "protocol.yaml"
BEYOND = """
study: beyond
title: What the paper's study does not have
contact: lab@example.org
robot: pepper
seed: 5
gestures: {wave: gestures/wave.yaml, bow: {file: gestures/bow.yaml, robot: pepper}}
modulations:
  calm: {time: 1.3}
  calmer: {extends: calm, times: {time: 1.1}}
  tempo: {grid: {time: [0.8, 1.2]}}
demographics: [{select: {item: experience, text: Have you met robots?, options: [never, often]}}]
parts:
  groups:
    title: Groups
    stimuli: {gesture: [wave, bow], modulations: [calm, calmer]}
    order: {gestures: between participants, stimuli: latin square}
    ask:
      - differential: {set: godspeed animacy, points: 7, item_order: shuffled}
      - slider: {text: It is, items: {hurried: in a hurry}, ends: [not at all, extremely]}
      - attention: {text: Please choose fairly, options: [fairly, very], expected: fairly, at: [2]}
  pairs:
    title: Pairs
    stimuli: {gesture: wave, modulations: [calm, calmer, tempo], prefix: side_}
    pairs: [[calm, calmer], [tempo_1, tempo_2]]
    order: {stimuli: shuffled, max_run: {gesture: 9}}
    ask: [{prefer: {item: happier, text: Which looks happier?}}]
  experts:
    if: {experience: [often]}
    title: Experts
    stimuli: {gesture: wave, modulations: [neutral]}
    order: fixed
    ask:
      - rank: {text: What matters?, items: [speed, size]}
      - number: {item: metres, text: How far away?, least: 0, most: 20, unit: m, optional: true}
      - text: {item: remark, text: Anything else?, optional: true}
participants:
  planned: 24
  stop: by hand
  exclude: {failed_attention: 1, faster_than: 0.5 s, straight_lining: true}
  recruitment: {service: prolific, completion_url: "https://app.prolific.com/submissions/complete?cc=C1A2B3"}
analysis:
  H1: {part: groups, item: animacy, test: paired t, compare: [calm, calmer], alternative: greater}
  H2: {part: pairs, test: binomial, compare: [calm, calmer], alternative: greater}
amendments: [{date: '2026-11-22', reason: A misspelt word, replaces: 0123456789ab}]
"""
VALID: dict[str, Any] = yaml.safe_load(PAPER.read_text(encoding="utf-8"))
BEYOND_THE_PAPER: dict[str, Any] = yaml.load(BEYOND, Loader=yaml.CSafeLoader)
REQUIRED = [
    "study",
    "title",
    "contact",
    "robot",
    "seed",
    "gestures",
    "parts",
    "participants",
    "practice.stimulus",
    "practice.ask",
    "practice.stimulus.gesture",
    "participants.planned",
    "parts.recognition.title",
    "parts.recognition.stimuli",
    "parts.recognition.ask",
    "parts.recognition.stimuli.gesture",
    "parts.recognition.stimuli.modulations",
    "parts.recognition.ask.0.rate",
    "parts.recognition.ask.0.rate.text",
    "parts.recognition.ask.0.rate.items",
    "parts.recognition.ask.0.rate.ends",
    "parts.intensity.stimuli.levels",
    "parts.intensity.order.principles",
    "parts.intensity.ask.0.choose.options",
    "parts.intensity.ask.0.choose.text",
    "analysis.H1.part",
    "analysis.H1.test",
    "analysis.H1.of",
    "analysis.H1.alternative",
    "analysis.H2.1.part",
    "analysis.H2.1.compare",
    "gestures.wave",
    "modulations.joy",
    "levels.arc",
]
WRONG: tuple[Any, ...] = (True, [], {}, {"nonsense": {"nonsense": 1}}, None)


def places(value: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place in the protocol."""
    if at:
        yield at
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in inner:
        yield from places(child, (*at, key))


def put(valid: dict[str, Any], at: tuple[Any, ...], value: Any) -> dict[str, Any]:
    broken = copy.deepcopy(valid)
    holder: Any = broken
    for key in at[:-1]:
        holder = holder[key]
    holder[at[-1]] = value
    return broken


def is_text(at: tuple[Any, ...]) -> bool:
    """Whether anything that can be written may stand there: words people read."""
    return bool({"title", "text", "ends", "authors", "contact", "items", "options"} & set(map(str, at)))


def mutations(valid: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for at in places(valid):
        name = ".".join(map(str, at))
        here: Any = valid
        for key in at:
            here = here[key]
        if isinstance(here, dict):
            yield f"{name}: unknown field", put(valid, (*at, "zzz-unknown!"), {"en": [1]})
        for wrong in WRONG if isinstance(here, (dict, list)) else ([], {"nonsense": 1}):
            if isinstance(here, (dict, list)) or not is_text(at):
                yield f"{name}: {wrong!r}", put(valid, at, wrong)
        if isinstance(here, (int, float)) and not isinstance(here, bool):
            yield f"{name}: words", put(valid, at, "many")
            yield f"{name}: far too small", put(valid, at, -1e9)
        if isinstance(here, str) and not is_text(at):
            yield f"{name}: misspelt", put(valid, at, here + "xqz")


def allowed(name: str) -> bool:
    """Changes that leave a protocol somebody could mean."""
    field, change = name.split(": ", 1)
    free = {
        "misspelt": r"study|robot|gestures\.\w+(\.file|\.robot)?|video\.camera"
        r"|parts\.\w+\.ask\.\d\.\w+\.(item|unit)|.*\.(prefix|completion_url|reason)",
        "far too small": r".*\.number\.least",
        "{}": r"video|analysis|modulations\.\w+(\.times)?|.*\.(max_run|exclude|recruitment)",
        "[]": r"authors|amendments",
        "None": r"practice|modulations\.\w+\.goal.*|.*attention\.at",
    }
    return change in free and re.fullmatch(free[change], field) is not None


@pytest.mark.parametrize("valid", [VALID, BEYOND_THE_PAPER], ids=["paper", "beyond"])
def test_a_valid_protocol_broken_in_hundreds_of_ways_is_refused_at_its_line(valid, load):
    load(valid)
    tried = 0
    accepted = []
    for name, broken in mutations(valid):
        if allowed(name):
            continue
        tried += 1
        try:
            load(broken)
        except ProtocolError as refused:
            assert refused.problems, name
            for problem in refused.problems:
                assert problem.line, (name, problem)
                assert problem.message.strip(), (name, problem)
                assert "pydantic" not in problem.message and "Input should" not in problem.message, (
                    name,
                    problem,
                )
        else:
            accepted.append(name)
    assert not accepted, "\n".join(accepted)
    assert tried >= 300


@pytest.mark.parametrize("field", REQUIRED)
def test_nothing_needed_can_be_left_out(field, load):
    at = tuple(
        int(key) if key.isdigit() and not field.startswith("analysis") else key for key in field.split(".")
    )
    if field.startswith("analysis.H2.1"):
        at = ("analysis", "H2.1", at[-1])
    broken = copy.deepcopy(VALID)
    holder: Any = broken
    for key in at[:-1]:
        holder = holder[key]
    del holder[at[-1]]
    with pytest.raises(ProtocolError):
        load(broken)


@pytest.mark.parametrize("cut", range(0, 5000, 125))
def test_a_file_cut_short_anywhere_never_ends_in_a_traceback(cut, load):
    content = PAPER.read_bytes()[:cut]
    try:
        load(content)
    except ProtocolError as refused:
        assert all(str(problem.message) for problem in refused.problems)
