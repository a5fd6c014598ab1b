"""Motions as Pepper animations (`.qianim`): what `stimuli.gestures.qianim` reads back.

Samples are thinned to a key per frame of 25 per second; each key's tangents are those of the motion there, so
that the cubic pieces between keys follow it closely.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from stimuli.export.bezier import bezier_keys
from stimuli.robots.model import Robot
from stimuli.trajectory import Trajectory

FPS = 25
_NAMESPACE = "http://www.ald.softbankrobotics.com/animation/editor"
_UNITS = {"revolute": ("degree", 180 / np.pi), "dimensionless": ("dimensionless", 1.0)}


def write_qianim(trajectory: Trajectory, robot: Robot, path: Path) -> None:
    """Write the animation; joints that slide cannot be in one and are left out."""
    ET.register_namespace("editor", _NAMESPACE)
    root = ET.Element("Animation", {"typeVersion": "2.0", f"{{{_NAMESPACE}}}fps": str(FPS)})
    frames, values, slopes = bezier_keys(trajectory, 1 / FPS)
    for column, name in enumerate(trajectory.joints):
        kind = robot.joint(name).kind
        if kind not in _UNITS:
            continue
        unit, scale = _UNITS[kind]
        curve = ET.SubElement(root, "ActuatorCurve", actuator=name, fps=str(FPS), mute="0", unit=unit)
        for frame, value, slope in zip(
            (frames * FPS).tolist(), values[:, column] * scale, slopes[:, column] * scale, strict=True
        ):
            key = ET.SubElement(curve, "Key", frame=f"{frame:.9g}", value=f"{value:.9g}")
            for side, sign in (("left", -1), ("right", 1)):
                reach = sign / 3  # frames; a third of the way makes the piece follow the slopes
                ET.SubElement(
                    key,
                    "Tangent",
                    side=side,
                    abscissaParam=f"{reach:.9g}",
                    ordinateParam=f"{slope / FPS * reach:.9g}",
                )
    ET.indent(root)
    ET.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
