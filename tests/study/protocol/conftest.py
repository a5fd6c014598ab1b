"""Protocols to break and to bend."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from study.protocol import Protocol, load_protocol

PAPER = Path(__file__).parents[3] / "protocols" / "hielscher2025"


@pytest.fixture
def written() -> dict[str, Any]:
    """The paper's protocol as plain values."""
    values: dict[str, Any] = yaml.safe_load((PAPER / "protocol.yaml").read_text(encoding="utf-8"))
    return values


@pytest.fixture
def load(tmp_path: Path) -> Callable[[Any], Protocol]:
    """Write values or text as a protocol and read it."""

    def load(content: Any) -> Protocol:
        path = tmp_path / "protocol.yaml"
        if isinstance(content, bytes):
            path.write_bytes(content)
        elif isinstance(content, str):
            path.write_text(content, encoding="utf-8")
        else:
            path.write_text(json.dumps(content, ensure_ascii=False, indent=1), encoding="utf-8")
        return load_protocol(path)

    return load
