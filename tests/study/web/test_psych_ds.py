"""Exported datasets keep to the rules of Psych-DS 1.5 (github.com/psych-ds/psych-DS, schema_model).

The official validator (psychds-validator 1.5.0) finds such a folder compatible and misses only what is
optional; as it needs Deno, its rules are checked here one by one.
"""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest

from study.protocol import Protocol, load_protocol
from study.psych_ds import write_dataset
from study.simulation import rehearse

OFFICIAL_KEYWORDS = {"study", "site", "subject", "session", "task", "condition", "trial", "stimulus"}


@pytest.fixture
def dataset(protocol: Protocol, tmp_path: Path) -> Path:
    table = rehearse(protocol, 1, tmp_path / "export")
    return write_dataset(protocol, table, tmp_path / "psych-ds", kind="simulated")


def test_what_must_and_should_be_there_is(dataset: Path) -> None:
    assert {path.name for path in dataset.iterdir()} == {
        *("dataset_description.json", "README.md", "CHANGES.md", "data", "documentation", "materials")
    }
    assert all(path.stat().st_size > 0 for path in dataset.rglob("*"))


def test_the_protocol_is_there_whole_and_as_it_was_before_amendments(
    dataset: Path, protocol: Protocol, tmp_path: Path
) -> None:
    table = tmp_path / "export" / "responses.csv"
    write_dataset(protocol, table, dataset, kind="simulated", earlier={protocol.sha256: protocol})
    for kept in (dataset / "materials", dataset / "materials" / "versions" / protocol.sha256):
        assert load_protocol(kept).sha256 == protocol.sha256
    assert "`materials/versions/HASH`" in (dataset / "README.md").read_text("utf-8")


def test_data_files_are_named_by_official_keywords(dataset: Path) -> None:
    [data] = (dataset / "data").iterdir()
    assert re.fullmatch(r"([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv", data.name)
    pairs = data.name.removesuffix("_data.csv").split("_")
    assert {pair.partition("-")[0] for pair in pairs} <= OFFICIAL_KEYWORDS
    assert data.name == "study-small_task-simulated_data.csv"


def test_the_description_is_a_dataset_of_schema_org_that_names_every_column(dataset: Path) -> None:
    description = json.loads((dataset / "dataset_description.json").read_text("utf-8"))
    assert (description["@context"], description["@type"]) == ("https://schema.org/", "Dataset")
    assert description["name"]
    assert "no data" in description["description"]
    [data] = (dataset / "data").iterdir()
    with data.open(newline="", encoding="utf-8") as file:
        header, *rows = list(csv.reader(file))
    assert header == [measured["name"] for measured in description["variableMeasured"]]
    assert len(set(header)) == len(header)
    assert {len(row) for row in rows} == {len(header)}


def test_the_key_that_the_readme_names_is_one(dataset: Path) -> None:
    assert "participant, part, stimulus and item" in (dataset / "README.md").read_text("utf-8")
    [data] = (dataset / "data").iterdir()
    with data.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    keys = {tuple(row[name] for name in ("participant", "part", "stimulus", "item")) for row in rows}
    assert len(keys) == len(rows) > 0
