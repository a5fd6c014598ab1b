"""The answers as a Psych-DS dataset (https://psych-ds.github.io, schema 1.5), which others' tools can read.

dataset_description.json                 what the dataset is, and what each column holds (schema.org)
data/study-NAME_task-…_data.csv          the table, named by keywords
materials/protocol.yaml …                the protocol, with the files it names
materials/versions/HASH/protocol.yaml …  the same as it was before amendments
documentation/responses.codebook.json    what each item and answer means
README.md  CHANGES.md
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from shutil import copyfile

from study.export import COLUMNS
from study.participants import Kind
from study.protocol import Protocol
from study.versions import FOLDER as VERSIONS
from study.versions import copy_protocol

KEY = "participant, part, stimulus and item"  # together name a row


def write_dataset(
    protocol: Protocol,
    table: Path,
    out: Path,
    *,
    kind: Kind = "participant",
    earlier: Mapping[str, Protocol] | None = None,
) -> Path:
    """Write a dataset of an exported table, beside which is its codebook, into a folder; gives the folder.

    `earlier` are the versions of the protocol that participants began with before amendments, by hash.
    """
    for name in ("data", "documentation", "materials"):
        (out / name).mkdir(parents=True, exist_ok=True)
    data = out / "data" / f"study-{_alphanumeric(protocol.study)}_task-{_task(kind)}_data.csv"
    copyfile(table, data)
    book = table.with_suffix(".codebook.json")
    copyfile(book, out / "documentation" / book.name)
    copy_protocol(protocol, out / "materials")
    for sha256, before in (earlier or {}).items():
        copy_protocol(before, out / "materials" / VERSIONS / sha256)
    description = json.dumps(_description(protocol, kind), indent=2, ensure_ascii=False)
    (out / "dataset_description.json").write_text(description + "\n", encoding="utf-8")
    (out / "README.md").write_text(_readme(protocol, data.name, kind), encoding="utf-8")
    (out / "CHANGES.md").write_text(_changes(protocol), encoding="utf-8")
    return out


def _description(protocol: Protocol, kind: Kind) -> dict[str, object]:
    return {
        "@context": "https://schema.org/",
        "@type": "Dataset",
        "name": protocol.study,
        "description": f"{protocol.title} {_what(kind)}",
        "author": [{"@type": "Person", "name": name} for name in protocol.authors],
        "keywords": ["human-robot interaction", "expressive robot motion", "questionnaire"],
        "variableMeasured": [
            {"@type": "PropertyValue", "name": name, "description": meaning}
            for name, meaning in COLUMNS.items()
        ],
    }


def _readme(protocol: Protocol, data: str, kind: Kind) -> str:
    return f"""# {protocol.title}

{_what(kind)} One row of `data/{data}` is one answered item; {KEY} together name it. Columns are
described in `dataset_description.json`, items and answers in `documentation/`. The protocol in `materials/`
has all that was asked and shown; its SHA-256 is {protocol.sha256}. Rows with another
`protocol_sha256` were gathered before an amendment (`CHANGES.md`), with the protocol in
`materials/{VERSIONS}/HASH`.

Participants bear random names. Nothing here says who they are.
"""


def _changes(protocol: Protocol) -> str:
    """The amendments made after the first participant had begun."""
    lines = [
        f"- {amendment.date}: {amendment.reason} (replaces {amendment.replaces})"
        for amendment in protocol.amendments
    ]
    return "\n".join(["# Changes to the protocol", "", *(lines or ["None."]), ""])


def _what(kind: Kind) -> str:
    return {
        "participant": "Answers of participants.",
        "test": "Answers of test runs, which are no data.",
        "simulated": "Answers of simulated participants, which are no data.",
    }[kind]


def _task(kind: Kind) -> str:
    return "questionnaire" if kind == "participant" else kind


def _alphanumeric(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]", "", name)
