"""URDF, with what MuJoCo leaves out: packages, COLLADA, velocity limits and joints that mimic others."""

from __future__ import annotations

import copy
import os
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.parsers.expat import ExpatError

from stimuli.errors import InputError
from stimuli.lines import read_xml
from stimuli.robots.belongings import keep_only_what_is_seen
from stimuli.robots.meshes import read_pieces
from stimuli.robots.mimics import Mimic, by_their_leaders
from stimuli.robots.packages import PACKAGE, folders_of, package_folders
from stimuli.robots.urdf_checks import Places, check_urdf


@dataclass(frozen=True)
class Urdf:
    """A URDF as MuJoCo is to read it, and what it would not keep."""

    xml: str
    meshes: Mapping[str, bytes]  # by the names they have in `xml`
    velocities: Mapping[str, float]  # per second; none where the file has none, or 0
    mimics: Mapping[str, Mimic]  # by the joint that follows


def read_urdf(source: Path, search: Sequence[Path] = ()) -> Urdf:
    """Read a URDF; its packages lie in the folders of `search`, or in one above the file."""
    try:
        root, lines = read_xml(source)
    except (OSError, ExpatError) as error:
        raise InputError(f"{source}: cannot be read as a URDF: {error}") from error
    places = Places(source, lines)
    check_urdf(root, places)
    folders = folders_of(source, search)
    keep_only_what_is_seen(root)
    meshes: dict[str, bytes] = {}
    for link in root.iterfind("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            mesh = shape.find("geometry/mesh")
            if mesh is not None:
                found = find_mesh(mesh.get("filename", ""), source.parent, folders, places.of(mesh))
                link.remove(shape)
                link.extend(_dressed(shape, found, meshes))
    options = root.find("mujoco")
    options = ET.SubElement(root, "mujoco") if options is None else options
    for compiler in options.findall("compiler"):
        options.remove(compiler)
    ET.SubElement(options, "compiler", discardvisual="false", fusestatic="false", strippath="true")
    return Urdf(ET.tostring(root, encoding="unicode"), meshes, _velocities(root), _mimics(root, places))


def find_mesh(filename: str, beside: Path, folders: Sequence[Path], place: str) -> Path:
    """The file a mesh's name means. InputError where it is not there, saying where it was looked for."""
    if not filename.startswith(PACKAGE):
        path = Path(os.path.normpath(beside / filename.removeprefix("file://")))
        if not path.is_file():
            raise InputError(f"{place}: the mesh {filename!r} is not there: {path}")
        return path
    roots, rest = package_folders(filename, folders)
    for path in (Path(os.path.normpath(root / rest)) for root in roots):
        if path.is_file():
            return path
    present = [root for root in roots if root.is_dir()]
    if present:
        raise InputError(f"{place}: the mesh {filename!r} is not in the package: {present[0] / rest}")
    package, looked = roots[0].name, ", ".join(map(str, folders))
    raise InputError(
        f"{place}: {filename!r}: there is no folder {package!r} in {looked}. Name the folder it lies in: "
        "`search: [PATH]` in the robot's YAML file."
    )


def _dressed(shape: ET.Element, path: Path, meshes: dict[str, bytes]) -> list[ET.Element]:
    """The shape once for each piece of its mesh."""
    shapes = []
    for piece in read_pieces(path):
        name = f"mesh{len(meshes)}{piece.suffix}"
        meshes[name] = piece.data
        shown = copy.deepcopy(shape)
        mesh = shown.find("geometry/mesh")
        assert mesh is not None
        mesh.set("filename", name)
        if piece.colour:
            for material in shown.findall("material"):
                shown.remove(material)
            material = ET.SubElement(shown, "material", name=f"{name} colour")
            ET.SubElement(material, "color", rgba=" ".join(f"{part:.6g}" for part in piece.colour))
        shapes.append(shown)
    return shapes


def _velocities(root: ET.Element) -> dict[str, float]:
    limits = {joint.get("name", ""): joint.find("limit") for joint in root.iterfind("joint")}
    velocities = {
        name: float(limit.get("velocity", 0)) for name, limit in limits.items() if limit is not None
    }
    return {name: velocity for name, velocity in velocities.items() if velocity > 0}


def _mimics(root: ET.Element, places: Places) -> dict[str, Mimic]:
    """Each joint that follows another, by the one that leads them all."""
    found = {joint.get("name", ""): joint.find("mimic") for joint in root.iterfind("joint")}
    mimics = {name: mimic for name, mimic in found.items() if mimic is not None}
    written = {
        name: Mimic(mimic.get("joint", ""), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0)))
        for name, mimic in mimics.items()
    }
    return by_their_leaders(written, lambda name: places.of(mimics[name]))
