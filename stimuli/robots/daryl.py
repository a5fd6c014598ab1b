"""A robot like Daryl (Social Robotics Lab, Freiburg): ten degrees of freedom, no arms, speaking ears.

A reconstruction: its joints' number and its nodding head are known, its shape is ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from stimuli.robots.facts import assembled, read_facts
from stimuli.robots.model import Robot
from stimuli.robots.shapes import Loft, Mesh, ball, dome, joined, lathe, ring
from stimuli.trajectory import FloatArray

if TYPE_CHECKING:
    import mujoco

# name, colour, specular, shininess, emission
MATERIALS = (
    ("shell", (0.93, 0.93, 0.92), 0.3, 0.5, 0.0),
    ("blue", (0.20, 0.34, 0.52), 0.3, 0.5, 0.0),
    ("dark", (0.16, 0.165, 0.175), 0.3, 0.4, 0.0),
    ("light", (0.45, 0.80, 1.0), 0.2, 0.5, 0.75),
    ("eye", (0.02, 0.022, 0.028), 0.8, 0.9, 0.0),
    ("glint", (1.0, 1.0, 1.0), 0.0, 0.0, 1.0),
)
CHEST = Loft(
    (
        (0.000, 0.00, 0.105, 0.105, 0.125, 2.2),
        (0.010, 0.00, 0.120, 0.120, 0.140, 2.3),
        (0.150, 0.00, 0.130, 0.125, 0.165, 2.4),
        (0.260, -0.01, 0.125, 0.120, 0.170, 2.4),
        (0.340, -0.01, 0.095, 0.095, 0.130, 2.3),
        (0.385, -0.01, 0.055, 0.055, 0.070, 2.1),
        (0.395, -0.01, 0.035, 0.035, 0.045, 2.0),
    ),
    fillet=0.010,
)
EAR = Loft(
    (
        (-0.010, 0.0, 0.016, 0.016, 0.012, 2.0),
        (0.030, 0.0, 0.036, 0.034, 0.014, 2.0),
        (0.080, -0.006, 0.034, 0.034, 0.012, 2.0),
        (0.130, -0.016, 0.018, 0.020, 0.008, 2.0),
        (0.150, -0.022, 0.004, 0.005, 0.003, 2.0),
    )
)


def load() -> Robot:
    """The reconstruction at rest."""
    return assembled("daryl", build)


def build() -> mujoco.MjSpec:
    """The reconstruction's body."""
    from stimuli.robots.skeleton import add_materials, dress, skeleton

    facts = read_facts("daryl")
    spec = skeleton("daryl", facts)
    add_materials(spec, MATERIALS)
    dress(spec, "base", **base(facts.body["base_radius"]))
    dress(spec, "torso", dark=lathe([(0.075, -0.02), (0.072, 0.08), (0.085, 0.16)], 32))
    dress(spec, "chest", shell=CHEST.mesh(22, 40), light=CHEST.seam([(-0.5, 0.27), (0.5, 0.27)], 0.014))
    dress(spec, "neck", dark=lathe([(0.038, -0.06), (0.034, 0.0), (0.034, 0.07)], 24))
    dress(spec, "head", **head(facts.body["head"]))
    dress(spec, "eyes", **eyes())
    for link in ("ear_l", "ear_r"):
        dress(spec, link, blue=EAR.mesh(14, 22))
    return spec


def base(radius: float) -> dict[str, Mesh]:
    """A round drive with a bumper, rising to the torso."""
    skirt = [(1.0, 0.06), (0.99, 0.16), (0.93, 0.22), (0.72, 0.27), (0.46, 0.32), (0.36, 0.40), (0.34, 0.45)]
    return {
        "shell": lathe([(radius * r, z) for r, z in skirt], 48),
        "dark": lathe([(0.88 * radius, 0.0), (0.9 * radius, 0.06)], 48),
        "blue": ring(radius, 0.012, 48, 8).moved((0, 0, 0.09)),
    }


def head(half_axes: Sequence[float]) -> dict[str, Mesh]:
    """An ellipsoid above the tilting joint, with a dark face."""
    lifted = np.array([0.0, 0.0, 0.08])
    skull = ball(1.0, 64).bent(lambda points: points * half_axes + lifted)

    def on_the_skull(points: FloatArray) -> FloatArray:
        """The unit disc laid over the front as a mask, its rim sunk into the skull."""
        side, up = 0.86 * points[:, 1], 0.44 * points[:, 2] - 0.02
        out = np.where(np.hypot(points[:, 1], points[:, 2]) > 0.99, 0.99, 1.008)
        towards = np.stack([np.cos(up) * np.cos(side), np.cos(up) * np.sin(side), np.sin(up)], axis=-1)
        over: FloatArray = out[:, None] * towards * half_axes + lifted
        return over

    face = dome(1.0, 1.0, 64, 16).facing(np.array([1.0, 0.0, 0.0]), np.zeros(3)).bent(on_the_skull)
    return {"shell": skull, "dark": face}


def eyes() -> dict[str, Mesh]:
    """Two round lights that look up and down together."""
    forward = np.array([1.0, 0.0, 0.0])
    places = [np.array([0.055, y, 0.0]) for y in (0.040, -0.040)]
    glint = np.array([0.0055, 0.006, 0.008])
    return {
        "light": joined(*(ring(0.021, 0.005, 28, 6).facing(forward, place) for place in places)),
        "eye": joined(*(dome(0.020, 0.006, 24, 4).facing(forward, place) for place in places)),
        "glint": joined(*(dome(0.004, 0.001, 10, 3).facing(forward, place + glint) for place in places)),
    }
