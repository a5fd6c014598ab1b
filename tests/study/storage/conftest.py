"""An empty database of every kind that can be started here."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from study.storage import Store, open_store


@pytest.fixture(params=["sqlite", "postgresql"])
def url(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """An empty database."""
    if request.param == "postgresql":
        address: str = request.getfixturevalue("postgresql").new_database()
        return address
    return f"sqlite:///{tmp_path}/study.db"


@pytest.fixture
def store(url: str) -> Iterator[Store]:
    opened = open_store(url)
    yield opened
    opened.close()
