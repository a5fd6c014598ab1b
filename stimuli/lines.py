"""Where things stand in a file: lines of YAML entries and XML elements, for messages."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.parsers import expat

import yaml

from stimuli.errors import InputError


def line_of(node: yaml.Node | None, location: Sequence[Any]) -> int:
    """Line in the file, from 1, of the innermost entry on the way to a location."""
    line = 1
    for part in location:
        if isinstance(node, yaml.SequenceNode) and isinstance(part, int):
            node = node.value[part]
            line = node.start_mark.line + 1
        elif isinstance(node, yaml.MappingNode):
            entry = next(((key, value) for key, value in node.value if key.value == str(part)), None)
            if entry is None:
                break
            line, node = entry[0].start_mark.line + 1, entry[1]
        else:
            break
    return line


def refuse_doubles(node: yaml.Node | None, path: Path) -> None:
    """InputError where a name stands twice in a mapping: which was meant is not for us to say."""
    if isinstance(node, yaml.SequenceNode):
        for value in node.value:
            refuse_doubles(value, path)
    elif isinstance(node, yaml.MappingNode):
        first: dict[str, int] = {}
        for key, value in node.value:
            name, line = str(key.value), key.start_mark.line + 1
            if name in first:
                said = f"{name} stands there twice, first in line {first[name]}; keep one of them"
                raise InputError(f"{path}:{line}: {said}")
            first[name] = line
            refuse_doubles(value, path)


def read_xml(path: Path) -> tuple[ET.Element, Mapping[ET.Element, int]]:
    """The root of an XML file, and the line each element begins in. Raises ExpatError."""
    builder, lines = ET.TreeBuilder(), dict[ET.Element, int]()
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        lines[builder.start(tag, attributes)] = parser.CurrentLineNumber

    parser.StartElementHandler = start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.Parse(path.read_bytes(), True)
    return builder.close(), lines
