"""Where a robot's visible parts are: each as points whose hull holds it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from stimuli.trajectory import FloatArray


class Outline:
    """Points whose hull holds each visible part: the hull of its mesh, or the corners of its bounding box."""

    def __init__(self, points: Mapping[int, FloatArray]) -> None:
        self.points = points  # of each geom, in its own frame, (n, 3) m

    @classmethod
    def of(cls, model: mujoco.MjModel) -> Outline:
        """The outline of all a model has."""
        return cls({geom: hull(vertices(model, geom)) for geom in range(model.ngeom)})

    def placed(self, places: FloatArray, geoms: Iterable[int] | None = None) -> FloatArray:
        """The points (n, 3) in the world, of all geoms or of those named, where `places` says they are."""
        chosen = self.points if geoms is None else geoms
        return np.vstack([placed(self.points[geom], places[geom]) for geom in chosen])


def places(data: mujoco.MjData) -> FloatArray:
    """Where every geom is, shape (geoms, 12): rotation matrix by rows, and position."""
    return np.hstack([data.geom_xmat, data.geom_xpos])


def placed(points: FloatArray, place: FloatArray) -> FloatArray:
    """Points (n, 3) of a geom that is at this place, in the world."""
    moved: FloatArray = points @ place[:9].reshape(3, 3).T + place[9:]
    return moved


def vertices(model: mujoco.MjModel, geom: int) -> FloatArray:
    """Points (n, 3) of a geom in its own frame: those of its mesh, or the corners of its bounding box."""
    if model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_MESH:
        centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        corners: FloatArray = centre + half * np.array(list(itertools.product([-1, 1], repeat=3)))
        return corners
    mesh = model.geom_dataid[geom]
    points: FloatArray = model.mesh_vert[model.mesh_vertadr[mesh] :][: model.mesh_vertnum[mesh]]
    return points


def hull(points: FloatArray) -> FloatArray:
    """Those of the points that are corners of their convex hull."""
    try:
        corners: FloatArray = points[ConvexHull(points).vertices]
        return corners
    except QhullError:  # flat
        return points
