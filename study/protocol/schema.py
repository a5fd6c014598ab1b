"""The protocol language as a JSON Schema, for completion and checking while one writes."""

from __future__ import annotations

import json
from typing import Any

from stimuli.principles import PRINCIPLES
from study.protocol.protocol import Protocol
from study.questions import ANY_QUESTION, QUESTIONS
from study.questions.scale import Scale


def json_schema() -> dict[str, Any]:
    """The schema of a protocol file, to be named in its first line for editors.

    `# yaml-language-server: $schema=protocol.schema.json`
    """
    schema = Protocol.model_json_schema(by_alias=True)
    intensities = {
        kind: {
            "title": principle.title,
            "description": (principle.__doc__ or "").split("\n")[0],
            "anyOf": [{"type": "number"}, {"type": "object"}],
        }
        for kind, principle in PRINCIPLES.items()
    }
    building = {word: {"type": "object"} for word in ("plus", "times", "grid")}
    schema["properties"]["modulations"] = {
        "type": "object",
        "additionalProperties": {
            "type": "object",
            "properties": {**intensities, **building, "extends": {"type": "string"}},
            "additionalProperties": False,
        },
    }
    schema["properties"]["levels"] = {
        "type": "object",
        "properties": {
            kind: {"anyOf": [{"type": "array", "minItems": 3, "maxItems": 3}, {"type": "object"}]}
            for kind in PRINCIPLES
        },
        "additionalProperties": False,
    }
    definitions = schema.setdefault("$defs", {})
    for kind, question in QUESTIONS.items():
        body = question.model_json_schema(by_alias=True, ref_template="#/$defs/{model}")
        definitions |= body.pop("$defs", {})
        if issubclass(question, Scale):  # a set brings what would have to be written
            body["anyOf"] = [{"required": body.pop("required")}, {"required": ["set"]}]
        definitions[kind] = body
    definitions["Question"] = {
        "type": "object",
        "properties": {kind: {"$ref": f"#/$defs/{kind}"} for kind in QUESTIONS},
        "additionalProperties": False,
        "minProperties": 1,
        "maxProperties": 1,
    }
    schema["required"] = [name for name in schema["required"] if name != "languages"]  # those of the title
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **_with_questions(schema)}


def schema_text() -> str:
    """The schema as the text of `protocol.schema.json`."""
    return json.dumps(json_schema(), indent=1, ensure_ascii=False) + "\n"


def _with_questions(schema: Any) -> Any:
    """The schema with every question pointing at the kinds there are."""
    if schema == ANY_QUESTION:
        return {"$ref": "#/$defs/Question"}
    if isinstance(schema, dict):
        return {key: _with_questions(value) for key, value in schema.items()}
    return [_with_questions(value) for value in schema] if isinstance(schema, list) else schema
