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
VALID: dict[str, Any] = yaml.safe_load(PAPER.read_text(encoding="utf-8"))
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


def put(at: tuple[Any, ...], value: Any) -> dict[str, Any]:
    broken = copy.deepcopy(VALID)
    holder: Any = broken
    for key in at[:-1]:
        holder = holder[key]
    holder[at[-1]] = value
    return broken


def is_text(at: tuple[Any, ...]) -> bool:
    """Whether anything that can be written may stand there: words people read."""
    return bool({"title", "text", "ends", "authors", "contact", "items", "options"} & set(map(str, at)))


def mutations() -> Iterator[tuple[str, dict[str, Any]]]:
    for at in places(VALID):
        name = ".".join(map(str, at))
        here = VALID
        for key in at:
            here = here[key]
        if isinstance(here, dict):
            yield f"{name}: unknown field", put((*at, "zzz-unknown!"), {"en": [1]})
        for wrong in WRONG if isinstance(here, (dict, list)) else ([], {"nonsense": 1}):
            if isinstance(here, (dict, list)) or not is_text(at):
                yield f"{name}: {wrong!r}", put(at, wrong)
        if isinstance(here, (int, float)) and not isinstance(here, bool):
            yield f"{name}: words", put(at, "many")
            yield f"{name}: far too small", put(at, -1e9)
        if isinstance(here, str) and not is_text(at):
            yield f"{name}: misspelt", put(at, here + "xqz")


def allowed(name: str) -> bool:
    """Changes that leave a protocol somebody could mean."""
    field, change = name.split(": ", 1)
    free = {
        "misspelt": r"study|robot|gestures\.\w+|video\.camera|parts\.\w+\.ask\.0\.choose\.item",
        "{}": r"video|analysis|modulations\.\w+",
        "[]": r"authors",
        "None": r"practice|modulations\.\w+\.goal.*",
    }
    return change in free and re.fullmatch(free[change], field) is not None


def test_a_valid_protocol_broken_in_hundreds_of_ways_is_refused_at_its_line(load):
    tried = 0
    accepted = []
    for name, broken in mutations():
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
    assert accepted == []
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
