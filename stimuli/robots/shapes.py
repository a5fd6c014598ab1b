"""Surfaces robots are made of: lofts through sections, lathed profiles, rings and capsules.

A body part is a `Mesh` in its link's frame. Lofts and lathes run along z; turn them with `Mesh.moved`.
Lengths in metres, angles in radians; roll, pitch, yaw about fixed axes as in URDF.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
from numpy.typing import NDArray

from stimuli.robots.model import Vector
from stimuli.trajectory import FloatArray

ALONG_X: Vector = (0, np.pi / 2, 0)  # turns a loft so that it runs along x, its section's x pointing down
ALONG_Y: Vector = (-np.pi / 2, 0, 0)


@dataclass(frozen=True)
class Mesh:
    """Triangles seen from the side from which they run anticlockwise; vertices not shared make a crease."""

    vertices: FloatArray  # (n, 3) m
    faces: NDArray[np.int64]  # (m, 3) indices of vertices

    def __add__(self, other: Mesh) -> Mesh:
        return Mesh(
            np.vstack([self.vertices, other.vertices]),
            np.vstack([self.faces, other.faces + len(self.vertices)]),
        )

    def moved(self, xyz: Sequence[float] | FloatArray = (0, 0, 0), rpy: Sequence[float] = (0, 0, 0)) -> Mesh:
        """Turned, then shifted."""
        from scipy.spatial.transform import Rotation  # late: slow to import, and only bodies need it

        return Mesh(Rotation.from_euler("xyz", rpy).apply(self.vertices) + np.asarray(xyz, float), self.faces)

    def facing(self, normal: FloatArray, xyz: FloatArray) -> Mesh:
        """Turned so that z points along `normal`, then shifted."""
        from scipy.spatial.transform import Rotation

        turn, _ = Rotation.align_vectors([normal], [[0, 0, 1]])
        return Mesh(turn.apply(self.vertices) + xyz, self.faces)

    def mirrored(self) -> Mesh:
        """Left becomes right: y changes sign."""
        return Mesh(self.vertices * (1, -1, 1), self.faces[:, ::-1])

    def bent(self, shape: Callable[[FloatArray], FloatArray]) -> Mesh:
        """Every vertex carried elsewhere."""
        return Mesh(shape(self.vertices), self.faces)


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    return reduce(Mesh.__add__, meshes)


Section = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class Loft:
    """Superellipse sections stacked along z, smooth and without overshoot between them.

    A section is (z, centre x, front radius, back radius, half width, exponent): exponent 2 is an ellipse,
    larger ones are squarer. Front is +x. Between sections PCHIP, then rounded by a Gaussian of width
    `fillet` (m): both keep what is monotone monotone, and the second hides jumps of curvature that
    would show as bands on a glossy shell.
    """

    sections: tuple[Section, ...]
    fillet: float = 0.004

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray]:
        from scipy.interpolate import PchipInterpolator
        from scipy.ndimage import gaussian_filter1d

        rows = np.array(self.sections, float)
        z = np.linspace(rows[0, 0], rows[-1, 0], 501)
        values = PchipInterpolator(rows[:, 0], rows[:, 1:], axis=0)(z)  # (501, 5)
        padded = np.pad(values, ((250, 250), (0, 0)), mode="reflect", reflect_type="odd")
        rounded = gaussian_filter1d(padded, self.fillet / (z[1] - z[0]), axis=0)[250:-250]
        return z, rounded

    def _at(self, z: FloatArray) -> FloatArray:
        grid, values = self._table
        return np.stack([np.interp(z, grid, column) for column in values.T], axis=-1)

    def points(self, angle: FloatArray, z: FloatArray) -> FloatArray:
        """Points on the surface at the section's angle (0 front, pi/2 left), shape (..., 3)."""
        centre, front, back, half, exponent = np.moveaxis(self._at(z), -1, 0)
        c, s = np.cos(angle), np.sin(angle)
        x = centre + np.where(c >= 0, front, back) * np.sign(c) * np.abs(c) ** (2 / exponent)
        y = half * np.sign(s) * np.abs(s) ** (2 / exponent)
        return np.stack([x, y, z + 0 * x], axis=-1)

    def front(self, y: float, z: float) -> tuple[FloatArray, FloatArray]:
        """The point at (y, z) on the front, and the surface's unit normal there."""

        def point(y: float, z: float) -> FloatArray:
            centre, front, _, half, exponent = self._at(np.array(z))
            x = centre + front * max(0.0, 1 - (abs(y) / half) ** exponent) ** (1 / exponent)
            return np.array([x, y, z])

        h = 1e-4
        normal = np.cross(point(y + h, z) - point(y - h, z), point(y, z + h) - point(y, z - h))
        return point(y, z), normal / np.linalg.norm(normal)

    def mesh(self, rings: int, segments: int) -> Mesh:
        """The closed surface; rings lie closer at both ends so that rounded ends stay round."""
        low, high = self.sections[0][0], self.sections[-1][0]
        t = np.linspace(0, 1, rings)
        t = 0.6 * (0.5 - 0.5 * np.cos(np.pi * t)) + 0.4 * t
        z = (low + (high - low) * t)[:, None]
        angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)[None, :]
        grid = self.points(angle + 0 * z, z + 0 * angle)  # (rings, segments, 3)
        return _tube(grid) + _fan(grid[-1]) + _fan(grid[0, ::-1])

    def pad(self, centre: tuple[float, float], size: tuple[float, float], lift: float, segments: int) -> Mesh:
        """A rounded plate of half sizes (x, y) lying on the top, lifted off it, its steep rim let into it."""
        angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
        c, s = np.cos(angle), np.sin(angle)
        outline = np.stack([np.sign(c) * np.sqrt(np.abs(c)), np.sign(s) * np.sqrt(np.abs(s))], axis=-1) * size
        radii = np.array([1.0, 0.985, 0.94, 0.5, 0.0])
        above = lift * np.array([-5.0, 0.6, 1.0, 1.0, 1.0])  # deeper than the shell's facets lie
        flat = np.asarray(centre) + radii[:, None, None] * outline  # (radii, segments, 2)
        height = self._top(flat) + above[:, None]
        return _tube(np.concatenate([flat, height[..., None]], axis=-1))

    def _top(self, xy: FloatArray) -> FloatArray:
        """Height of the upper half's surface over points (..., 2)."""
        grid, values = self._table
        centre, front, back, half, exponent = values[250:].T[:, :, None]
        x, y = xy.reshape(-1, 2).T
        level = (np.abs(x - centre) / np.where(x > centre, front, back)) ** exponent + (
            np.abs(y) / half
        ) ** exponent
        columns = [
            np.interp(1.0, column, grid[250:]) for column in level.T
        ]  # 1 on the surface, growing upwards
        return np.reshape(columns, xy.shape[:-1])

    def seam(self, path: Sequence[tuple[float, float]], width: float, lift: float = 0.0006) -> Mesh:
        """A narrow band along a path of (angle, z) on the surface."""
        from scipy.interpolate import PchipInterpolator

        rows = np.array(path, float)
        along = PchipInterpolator(np.linspace(0, 1, len(rows)), rows, axis=0)(
            np.linspace(0, 1, 8 * len(rows))
        )
        middle = self.points(along[:, 0], along[:, 1])  # (k, 3)
        h = 1e-4
        around = self.points(along[:, 0] + h, along[:, 1]) - self.points(along[:, 0] - h, along[:, 1])
        up = self.points(along[:, 0], along[:, 1] + h) - self.points(along[:, 0], along[:, 1] - h)
        normal = _unit(np.cross(around, up))
        side = _unit(np.cross(normal, np.gradient(middle, axis=0)))
        band = [middle + s * width / 2 * side + lift * normal for s in (-1.0, 1.0)]
        return _strip(band[0], band[1])


def lathe(profile: Sequence[tuple[float, float]], segments: int) -> Mesh:
    """The surface of revolution about z of a profile of (radius, z), from bottom to top for an outside."""
    angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    rows = np.array(profile, float)[:, None, :]
    grid = np.stack(
        [rows[..., 0] * np.cos(angle), rows[..., 0] * np.sin(angle), rows[..., 1] + 0 * angle], axis=-1
    )
    return _tube(grid)


def ring(radius: float, thickness: float, segments: int, sides: int = 8) -> Mesh:
    """A torus about z."""
    angles = np.linspace(0, 2 * np.pi, sides + 1)
    return lathe([(radius + thickness * np.cos(a), thickness * np.sin(a)) for a in angles], segments)


def dome(radius: float, height: float, segments: int, rings: int = 6) -> Mesh:
    """A flat cap on the plane z = 0."""
    angles = np.linspace(0, np.pi / 2, rings)
    return lathe([(radius * np.cos(a), height * np.sin(a)) for a in angles], segments)


def ball(radius: float, segments: int) -> Mesh:
    """A sphere."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)
    return lathe([(radius * np.cos(a), radius * np.sin(a)) for a in angles], segments)


def capsule(length: float, start: float, end: float, segments: int) -> Mesh:
    """A rod along x from the origin, with round ends of the given radii."""
    low = [(start * np.cos(a), start * np.sin(a)) for a in np.linspace(-np.pi / 2, 0, 4)]
    high = [(end * np.cos(a), length + end * np.sin(a)) for a in np.linspace(0, np.pi / 2, 4)]
    return lathe(low + high, segments).moved(rpy=ALONG_X)


def plate(half_height: float, half_width: float, half_depth: float, exponent: float, segments: int) -> Mesh:
    """A flat rounded rectangle facing +x."""
    edge = 0.4 * half_depth
    face = [
        (z, 0, half_height - inset, half_height - inset, half_width - inset, exponent)
        for z, inset in (
            (-half_depth, 0.9 * edge),
            (-half_depth + 0.3 * edge, 0.3 * edge),
            (-half_depth + edge, 0),
            (half_depth - edge, 0),
            (half_depth - 0.3 * edge, 0.3 * edge),
            (half_depth, 0.9 * edge),
        )
    ]
    outline = Loft(tuple(face))
    angle = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    grid = np.stack([outline.points(angle, np.full(segments, z)) for z, *_ in face])
    return (_tube(grid) + _fan(grid[-1]) + _fan(grid[0, ::-1])).moved(rpy=ALONG_X)


def _tube(grid: FloatArray) -> Mesh:
    """Quads between closed rings of points, shape (rings, segments, 3)."""
    rings, segments, _ = grid.shape
    index = np.arange(rings * segments).reshape(rings, segments)
    a, b = index[:-1], np.roll(index[:-1], -1, axis=1)
    d, c = index[1:], np.roll(index[1:], -1, axis=1)
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    points = grid.reshape(-1, 3)
    corners = points[faces]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return Mesh(points, faces[area > 1e-12])


def _fan(loop: FloatArray) -> Mesh:
    """A flat lid on a closed loop of points, creased against its rim."""
    n = len(loop)
    around = np.arange(n)
    return Mesh(
        np.vstack([loop, loop.mean(axis=0)]), np.stack([around, np.roll(around, -1), np.full(n, n)], axis=-1)
    )


def _strip(left: FloatArray, right: FloatArray) -> Mesh:
    """Quads between two lines of points."""
    n = len(left)
    a = np.arange(n - 1)
    faces = np.concatenate([np.stack([a, a + 1, a + n], -1), np.stack([a + 1, a + n + 1, a + n], -1)])
    return Mesh(np.vstack([left, right]), faces)


def _unit(vectors: FloatArray) -> FloatArray:
    lengths: FloatArray = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / lengths
