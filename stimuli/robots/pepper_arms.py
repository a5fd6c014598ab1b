"""Pepper's arms, from the shoulders to the fingertips, and the names of its finger joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from stimuli.robots.shapes import ALONG_X, Loft, Mesh, ball, capsule

if TYPE_CHECKING:
    import mujoco


def dress_arm(spec: mujoco.MjSpec, side: str, thumb: Sequence[float]) -> None:
    """Shoulder to palm, drawn for the left and mirrored for the right; `thumb` is where that begins."""
    from stimuli.robots.skeleton import dress

    def sided(mesh: Mesh) -> Mesh:
        return mesh if side == "L" else mesh.mirrored()

    def tube(*rows: tuple[float, float, float], rings: int, segments: int) -> Mesh:
        """Along x: distance, half height, half width."""
        sections = tuple((s, 0.0, height, height, width, 2.1) for s, height, width in rows)
        return Loft(sections, fillet=0.0025).mesh(rings, segments).moved(rpy=ALONG_X)

    dress(spec, f"{side}Shoulder", joint=ball(0.0395, 14))
    upper = tube(
        *(
            (-0.0415, 0.008, 0.008),
            (-0.039, 0.019, 0.019),
            (-0.030, 0.0325, 0.0325),
            (-0.014, 0.0415, 0.0415),
        ),
        *((0.010, 0.0437, 0.0437), (0.040, 0.0428, 0.0432), (0.080, 0.0397, 0.0405), (0.120, 0.0368, 0.0378)),
        *((0.152, 0.0350, 0.0358), (0.162, 0.0335, 0.0340), (0.1655, 0.0290, 0.0295)),
        rings=12,
        segments=24,
    ).bent(lambda p: p + np.stack([0 * p[:, 0], 0.015 * np.clip(p[:, 0] / 0.18, 0, 1), 0 * p[:, 0]], axis=-1))
    dress(spec, f"{side}Bicep", shell=sided(upper))
    dress(spec, f"{side}Elbow", joint=ball(0.0322, 16))
    lower = tube(
        *((0.008, 0.025, 0.025), (0.012, 0.0312, 0.0312), (0.022, 0.0345, 0.0350), (0.050, 0.0345, 0.0355)),
        *((0.080, 0.0335, 0.0348), (0.0855, 0.0320, 0.0332), (0.0875, 0.028, 0.029)),
        rings=9,
        segments=22,
    )
    band = tube((0.080, 0.0275, 0.0285), (0.100, 0.0275, 0.0285), rings=2, segments=18)
    dress(spec, f"{side}ForeArm", shell=lower, joint=band)
    cuff = tube(
        *(
            (-0.0605, 0.0275, 0.0285),
            (-0.058, 0.0320, 0.0330),
            (-0.050, 0.0330, 0.0342),
            (-0.020, 0.0322, 0.0360),
        ),
        *((0.005, 0.0312, 0.0385), (0.022, 0.0300, 0.0395), (0.0275, 0.0275, 0.0370), (0.0285, 0.022, 0.033)),
        rings=10,
        segments=22,
    )
    palm = tube(
        *((0.015, 0.0165, 0.0300), (0.035, 0.0172, 0.0335), (0.060, 0.0152, 0.0360), (0.076, 0.0122, 0.0360)),
        *((0.084, 0.0085, 0.0330), (0.087, 0.0040, 0.0280)),
        rings=7,
        segments=18,
    )
    dress(spec, f"{side.lower()}_wrist", shell=cuff, trim=sided(palm + thumb_ball(thumb)))


def thumb_ball(thumb: Sequence[float]) -> Mesh:
    """What joins the thumb to the palm."""
    inside = np.array([0.030, -0.012, -0.002])
    x, y, z = np.array(thumb) - inside
    return capsule(float(np.hypot(np.hypot(x, y), z)), 0.0130, 0.0098, 9).moved(
        inside, (0.0, -np.arctan2(z, np.hypot(x, y)), np.arctan2(y, x))
    )


def add_fingers(spec: mujoco.MjSpec, side: str, fingers: Mapping[str, Mapping[str, float]]) -> None:
    """Four fingers and a thumb of one hand, each phalanx a link with its own hinge."""
    from stimuli.robots.skeleton import add_link, dress

    mirror = np.array([1, 1, 1] if side == "L" else [1, -1, 1])
    turned = mirror[1] * np.array([1, mirror[1], 1])  # roll and yaw change sign with y, pitch does not
    for name in phalanges(side, fingers):
        finger, k = name[1:-1], int(name[-1])
        facts = fingers[finger]
        first = k == 1
        parent = f"{side.lower()}_wrist" if first else f"{name[:-1]}{k - 1}"
        xyz = facts["xyz"] * mirror if first else (facts["length"], 0, 0)
        rpy = facts["rpy"] * turned if first else (0, 0, fingers["fold"] * mirror[1])
        link = add_link(spec, parent, name, xyz=tuple(xyz), rpy=tuple(rpy))
        link.add_joint(name=name, axis=[0, 0, mirror[1]], range=[0, fingers["curl"]], limited=True)
        start, end = (0.0086 if finger == "Thumb" else 0.0080) - 0.0006 * np.array([k - 1, k])
        dress(spec, name, trim=capsule(facts["length"], start, end, 7))


def phalanges(side: str, fingers: Mapping[str, object]) -> list[str]:
    """Names of one hand's finger links, which are also their hinges', from the palm outwards."""
    return [
        f"{side}{finger}{k + 1}"
        for finger, facts in fingers.items()
        if isinstance(facts, dict)
        for k in range(facts["phalanges"])
    ]
