"""The examples in the docstrings of the public functions and in the manual say what is printed there."""

from __future__ import annotations

import doctest
import sys
from pathlib import Path

import pytest

import analysis

MANUAL = Path(__file__).parents[2] / "docs" / "analysis.md"


@pytest.mark.parametrize("name", analysis.__all__)
def test_every_public_function_is_documented_with_where_it_comes_from(name: str) -> None:
    assert (getattr(analysis, name).__doc__ or "").strip()


@pytest.mark.parametrize(
    "module",
    sorted({"analysis"} | {getattr(analysis, name).__module__ for name in analysis.__all__}),
)
def test_examples_run(module: str) -> None:
    result = doctest.testmod(sys.modules[module])
    assert result.attempted > 0
    assert result.failed == 0


def test_the_manual_runs(tmp_path: Path) -> None:
    plain = tmp_path / "manual.txt"  # without its fences, which would end up in the expected output
    lines = MANUAL.read_text(encoding="utf-8").splitlines()
    plain.write_text("\n".join("" if line.startswith("```") else line for line in lines), encoding="utf-8")
    result = doctest.testfile(str(plain), module_relative=False, encoding="utf-8")
    assert result.attempted > 25
    assert result.failed == 0
