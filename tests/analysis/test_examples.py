"""The examples in the docstrings of the public functions run and say what is printed there."""

from __future__ import annotations

import doctest
import sys

import pytest

import analysis


@pytest.mark.parametrize("name", analysis.__all__)
def test_every_public_function_is_documented_with_where_it_comes_from(name: str) -> None:
    assert (getattr(analysis, name).__doc__ or "").strip()


@pytest.mark.parametrize(
    "module",
    sorted(
        {"analysis"} | {getattr(analysis, name).__module__ for name in analysis.__all__} - {"analysis.apa"}
    ),
)
def test_examples_run(module: str) -> None:
    result = doctest.testmod(sys.modules[module])
    assert result.attempted > 0
    assert result.failed == 0
