"""KUKA LBR iiwa 14 R820: seven degrees of freedom, and a body of lathed links with orange joints.

Links 1, 3 and 5 turn about their own length and end in the next joint's fork; 2, 4 and 6 tilt.
The body is our own design; no part of the maker's meshes is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stimuli.robots.facts import assembled, read_facts
from stimuli.robots.model import Robot
from stimuli.robots.shapes import ALONG_Y, Mesh, ball, dome, joined, lathe, ring

if TYPE_CHECKING:
    import mujoco

# name, colour, specular, shininess, emission. Orange and grey as in B.
MATERIALS = (
    ("shell", (0.80, 0.81, 0.82), 0.4, 0.5, 0.0),
    ("orange", (1.0, 0.424, 0.039), 0.3, 0.5, 0.0),
    ("dark", (0.22, 0.225, 0.235), 0.3, 0.4, 0.0),
)


def load() -> Robot:
    """The arm with its elbow and wrist at right angles."""
    return assembled("iiwa14", build)


def build() -> mujoco.MjSpec:
    """The arm's body."""
    from stimuli.robots.skeleton import add_materials, dress, skeleton

    spec = skeleton("iiwa14", read_facts("iiwa14"))
    add_materials(spec, MATERIALS)
    dress(spec, "base", **base())
    for link, length, radius in (
        ("link1", 0.2025, 0.072),
        ("link3", 0.2155, 0.068),
        ("link5", 0.2155, 0.062),
    ):
        dress(spec, link, **turning(length, radius))
    for link, length, radius in (("link2", 0.2045, 0.072), ("link4", 0.1845, 0.066), ("link6", 0.081, 0.058)):
        dress(spec, link, **tilting(length, radius))
    dress(spec, "link7", **flange())
    return spec


def base() -> dict[str, Mesh]:
    """The foot, round above a plate."""
    column = lathe([(0.095, 0.02), (0.088, 0.05), (0.080, 0.09), (0.077, 0.130), (0.077, 0.150)], 40)
    plate = lathe([(0.130, 0.0), (0.130, 0.014)], 40) + lathe([(0.130, 0.014), (0.06, 0.024)], 40)
    return {"shell": column, "dark": plate, "orange": ring(0.0745, 0.006, 40).moved((0, 0, 0.1535))}


def turning(length: float, radius: float) -> dict[str, Mesh]:
    """Along z from a joint about z to one across it, which it holds between two cheeks."""
    profile = [
        (radius * 0.97, -0.005),
        (radius, 0.02),
        (radius * 0.94, length * 0.45),
        (radius * 0.98, length * 0.8),
    ]
    over = [(radius * np.cos(a), length + radius * np.sin(a)) for a in np.linspace(-0.3, np.pi / 2 - 0.02, 9)]
    return {"shell": lathe(profile + over, 36)}


def tilting(length: float, radius: float) -> dict[str, Mesh]:
    """About z at its origin, and along y to the next joint."""
    bowl = ball(radius * 1.06, 30)
    neck = lathe(
        [(radius * 0.9, 0.3 * length), (radius * 0.94, length - 0.022), (radius * 0.97, length - 0.012)], 36
    )
    caps = joined(*(cap(radius, side) for side in (1, -1)))
    seam = ring(radius * 0.945, 0.006, 36).moved((0, 0, length - 0.006))
    return {"shell": bowl + neck.moved(rpy=ALONG_Y), "dark": caps, "orange": seam.moved(rpy=ALONG_Y)}


def cap(radius: float, side: int) -> Mesh:
    """The round cover on a tilting joint's end."""
    rim, top = 0.80 * radius, radius * 0.72
    lid = lathe([(rim, top), (rim, top + 0.016)], 32) + dome(rim, 0.012, 32).moved((0, 0, top + 0.016))
    return lid if side > 0 else lid.moved(rpy=(np.pi, 0, 0))


def flange() -> dict[str, Mesh]:
    """The wrist's last ring, where a tool would sit."""
    body = lathe([(0.052, -0.010), (0.050, 0.010), (0.046, 0.030)], 32)
    plate = lathe([(0.044, 0.030), (0.044, 0.045)], 32) + dome(0.044, 0.0005, 32, 3).moved((0, 0, 0.045))
    return {"shell": body, "dark": plate, "orange": ring(0.050, 0.004, 32).moved((0, 0, 0.012))}
