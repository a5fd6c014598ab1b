"""Every example of the README and of docs/ is run.

A block in YAML is a piece of a protocol: it is completed, loaded, ordered and answered. Gestures and
robots among them, XML, CSV and Python are run by the tests that belong to their page. A command is parsed
as it stands, so it and its options exist; those of the README are also run (tests/test_readme.py). Exempt
are blocks for other programs, nginx and systemd, and commands that are not ours.
"""

import random
import re
import shlex
from pathlib import Path

import pytest
import typer
import yaml

from study.cli import app
from study.orders import draw_plan

ROOT = Path(__file__).parents[3]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FENCED = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(r"(?:^ {4}|^(?:ExecStart=/\S+/)?|`)(study [a-z]+\b[^`#\n]*)", re.MULTILINE)
LANGUAGES = {"yaml", "sh"}
RUN_BY_THEIR_PAGES = {
    "formats": ("tests/stimuli/motion/test_formats.py", {"csv", "xml", "python"}),
    "robots": ("tests/stimuli/robots/test_documentation.py", {"xml"}),
    "analysis": ("tests/analysis/test_examples.py", {"python"}),
    "sessions": (None, {"nginx", "ini"}),
}
BLOCKS = [(page.stem, *block) for page in PAGES for block in FENCED.findall(page.read_text(encoding="utf-8"))]
NO_PROTOCOL = {"joints", "model"}  # fields of gestures and of robots
PIECES = [
    pytest.param(text, id=f"{page} {text.strip().split(':')[0][:20].strip('# ')}")
    for page, language, text in BLOCKS
    if language == "yaml" and not NO_PROTOCOL & yaml.load(text, Loader=yaml.CSafeLoader).keys()
]
COMMANDS = sorted({found for page in PAGES for found in COMMAND.findall(page.read_text(encoding="utf-8"))})
REST = """
study: example
title: Example
contact: a@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
parts:
  only:
    title: Only
    stimuli: {gesture: wave, modulations: [neutral]}
    ask:
      - attention: {text: Choose b, options: [a, b], expected: b}
      - attention: {item: again, text: Choose a, options: [a, b], expected: a}
participants: {planned: 2}
"""


def test_every_block_is_of_a_kind_that_is_run_or_exempt():
    assert len(BLOCKS) >= 25 and len(PIECES) >= 15 and len(COMMANDS) >= 30
    for page, language, _ in BLOCKS:
        test, languages = RUN_BY_THEIR_PAGES.get(page, (None, set()))
        assert language in LANGUAGES | languages, (page, language)
        assert test is None or f"{page}.md" in (ROOT / test).read_text(encoding="utf-8")


@pytest.mark.parametrize("piece", PIECES)
def test_the_piece_of_a_protocol_runs(piece, load):
    fields = yaml.load(piece, Loader=yaml.CSafeLoader).keys()
    rest = {name: value for name, value in yaml.safe_load(REST).items() if name not in fields}
    protocol = load(piece + (yaml.safe_dump(rest, allow_unicode=True) if rest else ""))
    rng = random.Random(1)
    for slot in range(3):
        for trial in draw_plan(protocol, slot).trials:
            for question in protocol.parts[trial.part].questions:
                question.check(question.simulate(rng))


def test_every_command_shown_exists_with_its_options():
    study = typer.main.get_command(app)
    for shown in COMMANDS:
        _, name, *rest = shlex.split(shown)
        command = study.commands.get(name)
        assert command is not None, shown
        try:
            command.make_context(name, rest)
        except Exception as refused:
            if (
                type(refused).__name__ != "MissingParameter"
            ):  # in passing, a command is named without its protocol
                raise AssertionError(shown) from refused
