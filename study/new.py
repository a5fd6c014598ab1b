"""A new study, written from the template: a protocol that runs as it is, with its schema for editors."""

from __future__ import annotations

import shutil
from pathlib import Path

from stimuli.errors import InputError
from study.protocol.schema import schema_text

_PACKAGED = Path(__file__).parent / "template"  # in a wheel
_CHECKED_OUT = Path(__file__).parent.parent / "protocols" / "template"


def new_study(folder: Path) -> Path:
    """Write the template into a new folder, the study named after it; returns the protocol's path."""
    if folder.exists() and any(folder.iterdir()):
        raise InputError(f"{folder} is there and not empty; choose a new folder")
    template = _PACKAGED if _PACKAGED.is_dir() else _CHECKED_OUT
    shutil.copytree(
        template,
        folder,
        dirs_exist_ok=True,
        ignore=shutil.ignore_patterns("stimuli", "data", "*.schema.json"),
    )
    protocol = folder / "protocol.yaml"
    name = "".join(c if c.isalnum() and c.isascii() else "-" for c in folder.resolve().name).strip("-")
    if name[:1].isalpha():
        text = protocol.read_text(encoding="utf-8")
        protocol.write_text(text.replace("study: my-study", f"study: {name}"), encoding="utf-8")
    (folder / "protocol.schema.json").write_text(schema_text(), encoding="utf-8")
    return protocol
