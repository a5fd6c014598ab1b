"""The JSON Schema for editors accepts what the reader accepts, and names the fields."""

from pathlib import Path

import jsonschema_rs
import pytest

from stimuli.principles import PRINCIPLES
from study.protocol.schema import json_schema, schema_text
from study.protocol.source import read_source
from study.questions import QUESTIONS

PROTOCOLS = sorted((Path(__file__).parents[3] / "protocols").glob("*/protocol.yaml"))


def test_the_published_schema_is_current():
    published = Path(__file__).parents[3] / "protocols" / "protocol.schema.json"
    assert published.read_text(encoding="utf-8") == schema_text(), f"study schema --out {published}"


@pytest.mark.parametrize("path", PROTOCOLS, ids=lambda path: path.parent.name)
def test_our_protocols_satisfy_the_schema(path):
    errors = jsonschema_rs.validator_for(json_schema()).iter_errors(read_source(path).value)
    assert [f"{error.instance_path}: {error.message}" for error in errors] == []


def test_the_schema_refuses_what_editors_should_underline(written):
    validator = jsonschema_rs.validator_for(json_schema())
    written["modulations"]["joy"]["tme"] = 1
    written["parts"]["recognition"]["ask"][0]["rate"]["pionts"] = 5
    assert len(list(validator.iter_errors(written))) >= 2


def test_the_schema_offers_every_kind():
    schema = json_schema()
    assert set(schema["$defs"]["Question"]["properties"]) == set(QUESTIONS)
    assert set(PRINCIPLES) <= set(schema["properties"]["modulations"]["additionalProperties"]["properties"])
