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
from stimuli.robots.robot_file import RobotFile, read_robot_file

MODELS = ("include", "model")  # elements of an MJCF that name another
FOLDERS = ("meshdir", "texturedir", "assetdir")  # of an MJCF's compiler


def files_of_robot(path: Path) -> tuple[Path, ...]:
    """The robot's YAML, its model and the files that one names, as far as they are there.

    A robot that cannot be read is its YAML alone: what is wrong with it is said where it is loaded.
    """
    facts = _with_a_model(path)
    if facts is None:
        return (path,)
    named = {file for _, file in _named_from(*_begun_with(facts, path))}
    return (path, _plain(path.parent / facts.model), *sorted(named))


def bound_names(path: Path, study: Path) -> Iterator[tuple[str, str]]:
    """Names that lead to a robot's files only while the study's folder lies where it does, or is called so.

    Each with what would do.
    """
    facts = _with_a_model(path)
    if facts is None:
        return
    for name in (facts.model, *map(str, facts.search)):
        if Path(name).is_absolute():
            yield name, "write it as seen from the robot's YAML"
    home = _plain(study.absolute())
    for name, file in sorted(_named_from(*_begun_with(facts, path))):
        package, _, rest = name.removeprefix(PACKAGE).partition("/")
        if not name.startswith(PACKAGE):
            if Path(_local(name)).is_absolute() and file == _plain(Path(_local(name))):
                yield name, "write it as seen from the model"
        elif package == home.name and _plain(file.absolute()) == _plain(home / rest):
            yield name, f"put the package into a folder {package} within the study"


def _with_a_model(path: Path) -> RobotFile | None:
    """What a robot's YAML says, if it names files: a description by name is known by its commit."""
    try:
        facts, _ = read_robot_file(path)
    except InputError:
        return None
    return None if facts.model.startswith(PREFIX) else facts


def _begun_with(facts: RobotFile, path: Path) -> tuple[Path, list[Path]]:
    """The model, and where its packages are looked for first."""
    return _plain(path.parent / facts.model), [path.parent / other for other in facts.search]


def _named_from(model: Path, search: Sequence[Path]) -> set[tuple[str, Path]]:
    """Every name in a model, or in a model it names, with each file that it may mean."""
    folders, documents, places = folders_of(model, search), {model: _elements(model)}, {model.parent}
    while True:
        elements = [element for document in documents.values() for element in document]
        within = {""} | {_slashed(element.get(folder, "")) for element in elements for folder in FOLDERS}
        found = {
            (name, file): element.tag in MODELS
            for element in elements
            for name in _names(element)
            for file in _meant(name, places, within, folders)
            if file.is_file()
        }
        further = {file for (_, file), is_model in found.items() if is_model} - documents.keys()
        if not further:
            return set(found)
        documents |= {file: _elements(file) for file in further}
        places |= {file.parent for file in further}


def _elements(model: Path) -> list[ET.Element]:
    try:
        root, _ = read_xml(model)
    except (OSError, ExpatError):
        return []
    if model.suffix.lower() == ".urdf":  # else it is MuJoCo that reads it, whole
        keep_only_what_is_seen(root)
    return list(root.iter())


def keep_only_what_is_seen(root: ET.Element) -> None:
    """Leave out a URDF's collision shapes where it has visible ones."""
    if root.find("link/visual") is not None:
        for link in root.iterfind("link"):
            for collision in link.findall("collision"):
                link.remove(collision)


def _names(element: ET.Element) -> Iterator[str]:
    """What an element names: `file` in an MJCF, `fileup` and the like too, and `filename` in a URDF."""
    return (value for name, value in element.items() if name.startswith("file") and value)


def _meant(name: str, places: set[Path], within: set[str], folders: Sequence[Path]) -> Iterator[Path]:
    """Where the file of that name may lie."""
    if name.startswith(PACKAGE):
        roots, rest = package_folders(name, folders)
        yield from [_plain(root / rest) for root in roots if _plain(root / rest).is_file()][:1]
        return
    path = _local(name)
    for place in places:
        for folder in within:
            yield _plain(place / folder / path)
            yield _plain(place / folder / Path(path).name)


def _local(name: str) -> str:
    return _slashed(name.removeprefix("file://"))


def _slashed(name: str) -> str:
    """As MuJoCo takes it: separated by slashes."""
    return name.replace("\\", "/")


def _plain(path: Path) -> Path:
    """Without `..`, as MuJoCo takes it: a link is not followed."""
    return Path(os.path.normpath(path))
