"""Mesh files as MuJoCo can read them: STL and OBJ as they are, COLLADA taken apart by material."""

from __future__ import annotations

import re
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from stimuli.errors import InputError
from stimuli.trajectory import FloatArray, IndexArray

Colour = tuple[float, float, float, float]


@dataclass(frozen=True)
class Piece:
    """One mesh of one colour."""

    suffix: str  # .stl or .obj
    data: bytes
    colour: Colour | None = None  # None: as the robot's own file says


def read_pieces(path: Path) -> list[Piece]:
    """The meshes in a file. InputError where it is none, or needs what is not installed."""
    suffix = path.suffix.lower()
    try:
        data = path.read_bytes()
        if suffix == ".stl":
            is_text = len(data) != 84 + 50 * int.from_bytes(data[80:84], "little")
            return [_from_text(data) if is_text else Piece(".stl", data)]
        if suffix == ".obj":
            return [Piece(".obj", data)]
        if suffix == ".dae":
            return _from_collada(data)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a mesh: {error}") from error
    except ImportError as error:
        raise InputError(
            f"{path}: COLLADA meshes need an optional part: pip install 'expressive-motion-study[meshes]'"
        ) from error
    raise InputError(
        f"{path}: {suffix or 'a file without a suffix'} is no known mesh; .stl, .obj and .dae are"
    )


def _from_text(data: bytes) -> Piece:
    """From an STL written as text, which MuJoCo does not read."""
    corners = np.array(re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data), dtype=np.float64).reshape(-1, 3)
    if not len(corners):
        raise ValueError("it holds no triangles")
    vertices, faces = np.unique(corners, axis=0, return_inverse=True)
    return _piece(vertices, faces.reshape(-1, 3), None)


def _from_collada(data: bytes) -> list[Piece]:
    """One piece for each material. Units are applied; the upward axis is not, as robot viewers do."""
    import collada

    try:
        document = collada.Collada(BytesIO(data))
    except collada.DaeError as error:
        raise ValueError(error) from error
    unit = document.assetInfo.unitmeter or 1.0
    pieces = []
    for geometry in document.scene.objects("geometry"):
        for surface in geometry.primitives():
            if not hasattr(surface, "triangleset") and type(surface).__name__ != "BoundTriangleSet":
                continue  # lines
            triangles = surface.triangleset() if hasattr(surface, "triangleset") else surface
            if len(triangles.vertex_index):
                pieces.append(
                    _piece(unit * triangles.vertex, triangles.vertex_index, _colour(triangles.material))
                )
    if not pieces:
        raise ValueError("it holds no triangles")
    return pieces


def _colour(material: Any) -> Colour | None:
    diffuse = getattr(getattr(material, "effect", None), "diffuse", None)
    if not isinstance(diffuse, tuple):  # a picture, or nothing
        return None
    red, green, blue = (float(part) for part in diffuse[:3])
    return red, green, blue, 1.0


def _piece(vertices: FloatArray, faces: IndexArray, colour: Colour | None) -> Piece:
    used, renumbered = np.unique(faces, return_inverse=True)
    lines = ["v {:.7g} {:.7g} {:.7g}".format(*vertex) for vertex in vertices[used].tolist()]
    lines += ["f {} {} {}".format(*face) for face in (renumbered.reshape(-1, 3) + 1).tolist()]
    return Piece(".obj", ("\n".join(lines) + "\n").encode(), colour)
