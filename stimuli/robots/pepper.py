"""Pepper (SoftBank/Aldebaran): 17 degrees of freedom, and a body lofted from sections.

The body is our own design within the links' measured extents; no part of the maker's meshes is used.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from stimuli.robots.facts import assembled, read_facts
from stimuli.robots.model import Robot
from stimuli.robots.pepper_arms import add_fingers, dress_arm, phalanges
from stimuli.robots.shapes import ALONG_Y, Loft, Mesh, dome, joined, lathe, plate, ring

if TYPE_CHECKING:
    import mujoco


def load() -> Robot:
    """Pepper in its StandInit posture."""
    return assembled("pepper", build, drive_fingers)


def drive_fingers(positions: Mapping[str, float]) -> Mapping[str, float]:
    """MuJoCo joint positions: Hand becomes the angles of the fourteen finger joints."""
    fingers = read_facts("pepper").body["fingers"]
    angles = {name: value for name, value in positions.items() if not name.endswith("Hand")}
    for side in "LR":
        if f"{side}Hand" in positions:
            angle = fingers["curl"] * positions[f"{side}Hand"]
            angles |= dict.fromkeys(phalanges(side, fingers), angle)
    return angles


def build() -> mujoco.MjSpec:
    """Pepper's body, at most 20 000 triangles."""
    from stimuli.robots.skeleton import add_materials, dress, skeleton

    facts = read_facts("pepper")
    spec = skeleton("pepper", facts)
    add_materials(spec, MATERIALS)
    dress(spec, "Tibia", **base())
    dress(spec, "Pelvis", **pelvis())
    dress(spec, "Hip", **waist())
    dress(spec, "torso", **torso(facts.body["tablet"]))
    dress(spec, "Neck", joint=lathe([(0.031, -0.012), (0.029, 0.03), (0.027, 0.045)], 22))
    dress(spec, "Head", **head(facts.body["eyes"]))
    for side in "LR":
        dress_arm(spec, side, facts.body["fingers"]["Thumb"]["xyz"])
        add_fingers(spec, side, facts.body["fingers"])
    return spec


# name, colour, specular, shininess, emission. Colours: facts of the links' materials (A), else ours.
MATERIALS = (
    ("shell", (0.97, 0.972, 0.978), 0.35, 0.55, 0.0),
    ("trim", (0.74, 0.75, 0.77), 0.3, 0.5, 0.0),
    ("seam", (0.60, 0.61, 0.63), 0.1, 0.3, 0.0),
    ("joint", (0.20, 0.205, 0.22), 0.35, 0.4, 0.0),
    ("glass", (0.02, 0.022, 0.028), 0.8, 0.9, 0.0),
    ("screen", (0.06, 0.075, 0.10), 0.5, 0.9, 0.2),
    ("led", (0.50, 0.76, 1.0), 0.2, 0.5, 0.75),
    ("glint", (1.0, 1.0, 1.0), 0.0, 0.0, 1.0),
)

# z, centre x, front, back, half width, exponent (see Loft), in the link's frame.
BASE = Loft(
    (
        (-0.306, -0.030, 0.176, 0.188, 0.206, 2.5),
        (-0.300, -0.030, 0.196, 0.206, 0.226, 2.5),
        (-0.282, -0.030, 0.207, 0.217, 0.236, 2.5),
        (-0.245, -0.030, 0.208, 0.219, 0.237, 2.5),
        (-0.215, -0.030, 0.196, 0.204, 0.221, 2.45),
        (-0.185, -0.029, 0.168, 0.170, 0.188, 2.35),
        (-0.150, -0.024, 0.130, 0.129, 0.150, 2.3),
        (-0.110, -0.015, 0.098, 0.100, 0.121, 2.2),
        (-0.065, -0.006, 0.075, 0.081, 0.104, 2.2),
        (-0.020, 0.000, 0.064, 0.070, 0.097, 2.2),
        (-0.006, 0.000, 0.060, 0.066, 0.093, 2.2),
        (-0.003, 0.000, 0.056, 0.062, 0.089, 2.2),
    ),
    fillet=0.006,
)
PELVIS = Loft(
    (
        (0.004, 0.004, 0.054, 0.058, 0.086, 2.2),
        (0.009, 0.004, 0.060, 0.064, 0.093, 2.2),
        (0.030, 0.005, 0.064, 0.067, 0.098, 2.2),
        (0.080, 0.008, 0.071, 0.069, 0.107, 2.25),
        (0.140, 0.011, 0.079, 0.075, 0.116, 2.3),
        (0.200, 0.011, 0.084, 0.085, 0.119, 2.3),
        (0.240, 0.009, 0.084, 0.086, 0.115, 2.25),
        (0.272, 0.005, 0.080, 0.081, 0.104, 2.2),
        (0.298, 0.002, 0.070, 0.070, 0.086, 2.1),
        (0.318, 0.000, 0.056, 0.056, 0.066, 2.0),
        (0.330, 0.000, 0.042, 0.042, 0.048, 2.0),
        (0.335, 0.000, 0.030, 0.030, 0.034, 2.0),
    ),
    fillet=0.006,
)
TORSO = Loft(
    (
        (0.002, 0.000, 0.042, 0.044, 0.052, 2.1),
        (0.006, 0.000, 0.054, 0.055, 0.065, 2.15),
        (0.020, 0.001, 0.060, 0.060, 0.074, 2.2),
        (0.060, 0.002, 0.067, 0.064, 0.086, 2.25),
        (0.100, -0.001, 0.077, 0.073, 0.097, 2.3),
        (0.140, -0.010, 0.089, 0.087, 0.109, 2.35),
        (0.180, -0.022, 0.097, 0.098, 0.118, 2.4),
        (0.215, -0.033, 0.096, 0.100, 0.122, 2.4),
        (0.245, -0.040, 0.086, 0.095, 0.116, 2.35),
        (0.270, -0.042, 0.070, 0.080, 0.097, 2.25),
        (0.288, -0.041, 0.055, 0.063, 0.073, 2.15),
        (0.301, -0.040, 0.044, 0.048, 0.053, 2.1),
        (0.307, -0.039, 0.037, 0.039, 0.043, 2.0),
    ),
    fillet=0.006,
)
HEAD = Loft(
    (
        (0.010, 0.018, 0.024, 0.022, 0.022, 2.0),
        (0.014, 0.017, 0.040, 0.038, 0.037, 2.0),
        (0.026, 0.014, 0.063, 0.058, 0.057, 2.05),
        (0.045, 0.009, 0.085, 0.077, 0.075, 2.1),
        (0.070, 0.004, 0.101, 0.091, 0.090, 2.15),
        (0.100, 0.001, 0.108, 0.100, 0.0995, 2.15),
        (0.130, 0.000, 0.104, 0.102, 0.1015, 2.1),
        (0.155, -0.001, 0.094, 0.096, 0.095, 2.1),
        (0.180, -0.001, 0.077, 0.081, 0.080, 2.05),
        (0.200, 0.000, 0.056, 0.060, 0.058, 2.0),
        (0.2125, 0.000, 0.034, 0.037, 0.035, 2.0),
        (0.218, 0.000, 0.016, 0.017, 0.016, 2.0),
        (0.2195, 0.000, 0.004, 0.004, 0.004, 2.0),
    )
)


def base() -> dict[str, Mesh]:
    """The skirt over the wheels, its bumper line, and the lasers' window in front."""
    gap = Loft(((-0.322, -0.03, 0.17, 0.18, 0.20, 2.5), (-0.300, -0.03, 0.18, 0.19, 0.21, 2.5)))
    knee = Loft(((-0.02, 0, 0.050, 0.055, 0.082, 2.2), (0.02, 0, 0.050, 0.054, 0.082, 2.2)))
    around = [(a, -0.212) for a in np.linspace(-2.6, 2.6, 8)]
    window = [(a, -0.248) for a in np.linspace(-0.42, 0.42, 5)]
    return {
        "shell": BASE.mesh(20, 40),
        "joint": gap.mesh(2, 32) + knee.mesh(2, 24) + BASE.seam([(-0.16, -0.105), (0.16, -0.105)], 0.014),
        "seam": BASE.seam(around, 0.0030),
        "glass": BASE.seam(window, 0.020),
    }


def pelvis() -> dict[str, Mesh]:
    """The leg above the knee, with the Y-shaped joint of its front panels."""
    arm = [(1.25, 0.268), (0.80, 0.215), (0.30, 0.150), (0.06, 0.100), (0.0, 0.080)]
    other = [(-angle, z) for angle, z in arm]
    stem = [(0.0, 0.080), (0.0, 0.045), (0.0, 0.010)]
    return {
        "shell": PELVIS.mesh(19, 36),
        "seam": joined(*(PELVIS.seam(path, 0.0026) for path in (arm, other[::-1], stem))),
    }


def waist() -> dict[str, Mesh]:
    """Dark bellows between pelvis and torso, round about both hip axes."""
    heights = np.linspace(-0.002, 0.090, 13)
    folds = 0.0022 * np.cos(2 * np.pi * (heights - 0.050) / 0.0128)
    profile = [(0.046 + fold, height) for height, fold in zip(heights, folds, strict=True)]
    return {"joint": lathe(profile, 22).bent(lambda points: points * (1, 1.14, 1))}


def torso(tablet: Mapping[str, list[float]]) -> dict[str, Mesh]:
    """Chest, shoulder yokes with their lights, and the tablet."""
    yoke = Loft(
        (
            (0.050, 0.000, 0.054, 0.056, 0.048, 2.2),
            (0.085, 0.000, 0.055, 0.057, 0.050, 2.2),
            (0.108, 0.001, 0.050, 0.050, 0.0475, 2.1),
            (0.1165, 0.001, 0.046, 0.046, 0.0455, 2.0),
            (0.119, 0.001, 0.040, 0.040, 0.040, 2.0),
        )
    ).mesh(6, 24)
    left = yoke.moved((-0.056, 0, 0.2258), ALONG_Y)
    light = ring(0.0445, 0.0020, 26, 4).moved((-0.057, 0.1185, 0.2258), ALONG_Y)
    collar = ring(0.0335, 0.0045, 24, 5).moved((-0.0385, 0, 0.3075))
    bracket = Loft(((-0.06, 0, 0.05, 0.05, 0.07, 3), (0.04, 0, 0.05, 0.05, 0.085, 3))).mesh(2, 20)

    def on_tablet(mesh: Mesh, lift: float = 0.0) -> Mesh:
        return mesh.moved((lift, 0, 0)).moved(rpy=tablet["rpy"]).moved(tablet["xyz"])

    return {
        "shell": joined(
            TORSO.mesh(22, 36), left, left.mirrored(), on_tablet(plate(0.0885, 0.124, 0.0085, 7, 40))
        ),
        "trim": on_tablet(bracket, -0.045),
        "joint": collar,
        "led": light + light.mirrored(),
        "glass": on_tablet(plate(0.0800, 0.1155, 0.0015, 8, 32), 0.0082),
        "screen": on_tablet(plate(0.0670, 0.1040, 0.0004, 20, 16), 0.0097),
    }


def head(eyes: Mapping[str, float]) -> dict[str, Mesh]:
    """The face looks along +x; every feature sits on the head's surface, along its normal."""
    point, normal = HEAD.front(eyes["y"], eyes["z"])
    socket = ring(0.0236, 0.0032, 26, 4).facing(normal, point + 0.0002 * normal)
    iris = ring(0.0206, 0.0027, 26, 4).facing(normal, point + 0.0014 * normal)
    pupil = dome(0.0198, 0.0052, 22).facing(normal, point + 0.0010 * normal)
    glint = dome(0.0038, 0.0010, 10, 3).facing(
        normal, point + 0.0052 * normal + np.array([0, 0.0062, 0.0070])
    )
    ear = lathe([(0.036, -0.012), (0.0365, 0.003), (0.0345, 0.0082), (0.030, 0.0098), (0.012, 0.0105)], 24)
    cover = dome(0.0215, 0.0035, 20, 3).moved((0, 0, 0.0088))
    glow = ring(0.0262, 0.0024, 22, 4).moved((0, 0, 0.0098))
    left = np.array([-0.008, 0.0965, 0.122])

    def spot(y: float, z: float, width: float, height: float) -> Mesh:
        at, out = HEAD.front(y, z)
        disc = dome(1, 0.0016, 14, 3).bent(lambda p: p * (height, width, 1))
        return disc.facing(out, at + 0.0002 * out)

    def both(mesh: Mesh) -> Mesh:
        return mesh + mesh.mirrored()

    return {
        "shell": HEAD.mesh(26, 44),
        "joint": both(socket),
        "led": both(iris) + both(glow.moved(left, ALONG_Y)),
        "glass": both(pupil) + spot(0, 0.064, 0.0105, 0.0042) + spot(0, 0.163, 0.0048, 0.0048),
        "glint": both(glint),
        "trim": joined(
            both(ear.moved(left, ALONG_Y)),
            both(cover.moved(left, ALONG_Y)),
            *(HEAD.pad((x, 0), (0.0165, 0.030), 0.0007, 20) for x in (-0.038, 0.0, 0.038)),
        ),
    }
