"""The files a robot of one's own is made of, found without MuJoCo: its YAML, its model and what that names.

A model names meshes, pictures and further models. Where a compiler setting decides where they lie (`meshdir`,
`strippath`), every place it could mean is looked at, so that nothing MuJoCo may read is left out.
"""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.parsers.expat import ExpatError

from stimuli.errors import InputError
from stimuli.lines import read_xml
from stimuli.robots.descriptions import PREFIX
from stimuli.robots.packages import PACKAGE, folders_of, package_folders
from stimuli.robots.robot_file import read_robot_file

FOLDERS = ("meshdir", "texturedir", "assetdir")  # of an MJCF's compiler


def files_of_robot(path: Path) -> tuple[Path, ...]:
    """The robot's YAML, its model and the files that one names, as far as they are there.

    A robot that cannot be read is its YAML alone: what is wrong with it is said where it is loaded.
    """
    try:
        facts, _ = read_robot_file(path)
    except InputError:
        return (path,)
    if facts.model.startswith(PREFIX):  # it is known by its commit
        return (path,)
    model = path.parent / facts.model
    search = [path.parent / other for other in facts.search]
    return (path, *dict.fromkeys(Path(os.path.normpath(file)) for file in _named_from(model, search)))


def _named_from(model: Path, search: Sequence[Path]) -> Iterator[Path]:
    """A model and every file that it, or a model it names, may mean."""
    folders, documents, places = folders_of(model, search), {model: _elements(model)}, {model.parent}
    while True:
        within = {""} | {e.get(f, "") for elements in documents.values() for e in elements for f in FOLDERS}
        named = {name for elements in documents.values() for element in elements for name in _names(element)}
        found = {file for name in named for file in _meant(name, places, within, folders) if file.is_file()}
        further = {file for file in found if file.suffix in {".xml", ".mjcf"}} - documents.keys()
        if not further:
            break
        documents |= {file: _elements(file) for file in further}
        places |= {file.parent for file in further}
    yield from (model, *sorted(found))


def _elements(model: Path) -> list[ET.Element]:
    try:
        return list(read_xml(model)[0].iter())
    except (OSError, ExpatError):
        return []


def _names(element: ET.Element) -> Iterator[str]:
    """What an element names: `file` in an MJCF, `fileup` and the like too, and `filename` in a URDF."""
    return (value for name, value in element.items() if name.startswith("file") and value)


def _meant(name: str, places: set[Path], within: set[str], folders: Sequence[Path]) -> Iterator[Path]:
    """Where the file of that name may lie."""
    if name.startswith(PACKAGE):
        roots, rest = package_folders(name, folders)
        yield from [root / rest for root in roots if (root / rest).is_file()][:1]
        return
    for place in places:
        for folder in within:
            yield place / folder / name.removeprefix("file://")
            yield place / folder / Path(name).name
