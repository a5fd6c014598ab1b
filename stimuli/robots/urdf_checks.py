"""What a URDF must say before a robot is made of it; MuJoCo would fill some gaps in silence.

Every message has the file, the line, what is there and what would do.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from stimuli.errors import InputError, nearest
from stimuli.robots.limits import FURTHEST_M, Limits, beyond_belief

KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
BOUNDED = ("revolute", "prismatic")
ROUNDING = 1e-9  # what programs that compute inertias leave where there is none
SIZES = {  # attributes of shapes, and how many numbers each has
    "box": {"size": 3},
    "cylinder": {"radius": 1, "length": 1},
    "sphere": {"radius": 1},
    "mesh": {"scale": 3},
}


@dataclass(frozen=True)
class Places:
    """Where the elements of a file stand."""

    source: Path
    lines: Mapping[ET.Element, int]

    def of(self, element: ET.Element) -> str:
        """The element's file and line."""
        return f"{self.source}:{self.lines[element]}"


def check_urdf(root: ET.Element, places: Places) -> None:
    """InputError at the first thing that is missing, doubled, unknown or impossible."""
    for element in root.iter():
        if "xacro" in element.tag or any("${" in value for value in element.attrib.values()):
            tag = element.tag.rpartition(":")[2]
            raise InputError(f"{places.of(element)}: this is xacro still, at <{tag}>. Expand it first")
    if root.tag != "robot" or root.find("link") is None:
        raise InputError(
            f"{places.of(root)}: this is no URDF: <{root.tag}> where <robot> with links is needed"
        )
    links, joints = (_named_once(root, kind, places) for kind in ("link", "joint"))
    for name, link in links.items():
        _check_link(link, f"link {name!r}", places)
    for name, joint in joints.items():
        _check_joint(joint, f"joint {name!r}", places, links, joints)
    _check_tree(links, joints, places)


def _named_once(root: ET.Element, kind: str, places: Places) -> dict[str, ET.Element]:
    """All links or joints by their names."""
    named: dict[str, ET.Element] = {}
    for element in root.findall(kind):
        name = element.get("name", "")
        if not name:
            raise InputError(f"{places.of(element)}: this <{kind}> has no name; give it one")
        if name in named:
            first = places.lines[named[name]]
            raise InputError(f"{places.of(element)}: {kind} {name!r} is there in line {first} already")
        named[name] = element
    return named


def _check_link(link: ET.Element, what: str, places: Places) -> None:
    for attribute in ("value", "ixx", "iyy", "izz"):
        for element in link.findall("inertial/mass" if attribute == "value" else "inertial/inertia"):
            (value,) = _numbers(element, attribute, 1, "0", what, places)
            if value < -ROUNDING:
                problem = f"{element.tag}: {attribute} {value:g} is below zero"
                remedy = "give it as it is, or leave <inertial> out: nothing is simulated"
                raise InputError(f"{places.of(element)}: {what}: {problem}; {remedy}")
    for shape in (*link.findall("visual"), *link.findall("collision")):
        _check_origin(shape, what, places)
        for body in shape.findall("geometry/*"):
            _check_size(body, what, places)


def _check_size(body: ET.Element, what: str, places: Places) -> None:
    """Sizes above zero; a mesh may be mirrored."""
    for attribute, count in SIZES.get(body.tag, {}).items():
        sizes = _numbers(body, attribute, count, "1 1 1" if attribute == "scale" else "", what, places)
        if any(size == 0 or (size < 0 and attribute != "scale") or size > FURTHEST_M for size in sizes):
            problem = f"{body.tag}: {attribute} {body.get(attribute)!r}"
            remedy = f"sizes are above zero and at most {FURTHEST_M:g}, in m"
            raise InputError(f"{places.of(body)}: {what}: {problem}; {remedy}")


def _check_joint(
    joint: ET.Element,
    what: str,
    places: Places,
    links: Mapping[str, ET.Element],
    joints: Mapping[str, ET.Element],
) -> None:
    kind = joint.get("type", "")
    if kind not in KINDS:
        raise InputError(f"{places.of(joint)}: {what}: type {kind!r} is none; {nearest(kind, KINDS)}")
    for end in ("parent", "child"):
        ends = joint.findall(end)
        if len(ends) != 1:
            raise InputError(f"{places.of(joint)}: {what}: {len(ends)} <{end}>; it needs one, naming a link")
        element, link = ends[0], ends[0].get("link", "")
        if link not in links:
            raise InputError(
                f"{places.of(element)}: {what}: {end} {link!r} is no link; {nearest(link, links)}"
            )
    _check_origin(joint, what, places)
    for axis in joint.findall("axis"):
        if not any(_numbers(axis, "xyz", 3, "1 0 0", what, places)) and kind not in ("fixed", "floating"):
            raise InputError(f"{places.of(axis)}: {what}: axis 0 0 0 points nowhere; 0 0 1 is upwards")
    mimic = joint.find("mimic")
    if mimic is not None:
        _check_mimic(mimic, what, places, joints)
    _check_limit(joint, kind, what, places, follows=mimic is not None)


def _check_mimic(mimic: ET.Element, what: str, places: Places, joints: Mapping[str, ET.Element]) -> None:
    for number, default in (("multiplier", "1"), ("offset", "0")):
        _numbers(mimic, number, 1, default, what, places)
    leader = mimic.get("joint", "")
    moving = [name for name, joint in joints.items() if joint.get("type") != "fixed"]
    if leader not in moving:
        is_none = "does not move" if leader in joints else "is no joint"
        raise InputError(
            f"{places.of(mimic)}: {what}: mimic: {leader!r} {is_none}; {nearest(leader, moving)}"
        )


def _check_limit(joint: ET.Element, kind: str, what: str, places: Places, *, follows: bool) -> None:
    """A range for every joint that needs one; a joint that follows another has that one's."""
    limit = joint.find("limit")
    ask = 'give <limit lower="…" upper="…"/> in ' + ("rad" if kind == "revolute" else "m")
    other = f'{ask}, or type="{"continuous" if kind == "revolute" else "fixed"}"'
    if limit is None:
        if kind in BOUNDED and not follows:
            raise InputError(f"{places.of(joint)}: {what}: a {kind} joint without <limit>; {other}")
        return
    (velocity,) = _numbers(limit, "velocity", 1, "0", what, places)
    if velocity < 0:
        remedy = "give the fastest in either direction, or 0 if it is unknown"
        raise InputError(f"{places.of(limit)}: {what}: limit: velocity {velocity:g} is below zero; {remedy}")
    (lower,), (upper,) = (_numbers(limit, end, 1, "0", what, places) for end in ("lower", "upper"))
    if kind in BOUNDED and not follows and lower >= upper:
        problem = f"lower {lower:g} is not below upper {upper:g}"
        raise InputError(f"{places.of(limit)}: {what}: limit: {problem}; {other}")
    limits = Limits(lower, upper, velocity) if kind in BOUNDED else Limits(0, 0, velocity)
    if absurd := beyond_belief("prismatic" if kind == "prismatic" else "revolute", limits):
        raise InputError(f"{places.of(limit)}: {what}: limit: {absurd}")


def _check_origin(element: ET.Element, what: str, places: Places) -> None:
    for origin in element.findall("origin"):
        _numbers(origin, "rpy", 3, "0 0 0", what, places)
        if max(map(abs, _numbers(origin, "xyz", 3, "0 0 0", what, places))) > FURTHEST_M:
            problem = f"origin: xyz {origin.get('xyz')!r} is further than {FURTHEST_M:g} m"
            raise InputError(f"{places.of(origin)}: {what}: {problem}; give it in m")


def _check_tree(links: Mapping[str, ET.Element], joints: Mapping[str, ET.Element], places: Places) -> None:
    """One link is the root, and every other hangs on one joint."""
    hangs: dict[str, tuple[str, str]] = {}  # link: the joint that carries it, and the link that one is on
    for name, element in joints.items():
        parent, child = (end.get("link", "") for tag in ("parent", "child") for end in element.findall(tag))
        if child in hangs:
            problem = f"child {child!r} hangs on joint {hangs[child][0]!r} already"
            raise InputError(f"{places.of(element)}: joint {name!r}: {problem}; a link hangs on one joint")
        hangs[child] = name, parent
    for name in links:
        link, above = name, {name}
        while link in hangs:
            joint, link = hangs[link]
            if link in above:
                raise InputError(
                    f"{places.of(joints[joint])}: joint {joint!r}: parent {link!r} hangs on it; nothing may"
                )
            above.add(link)
    root, *others = [name for name in links if name not in hangs]
    for name in others:
        problem = f"link {name!r} hangs on nothing, as {root!r} does"
        raise InputError(f"{places.of(links[name])}: {problem}; join them by a joint of type fixed")


def _numbers(
    element: ET.Element, attribute: str, count: int, default: str, what: str, places: Places
) -> tuple[float, ...]:
    """So many numbers of an attribute. InputError where there are others, or what is no number."""
    text = element.get(attribute, default)
    try:
        values = tuple(float(part) for part in text.split())
    except ValueError:
        values = (math.nan,)
    if len(values) != count or not all(map(math.isfinite, values)):
        wanted = "a number" if count == 1 else f"{count} numbers"
        raise InputError(
            f"{places.of(element)}: {what}: {element.tag}: {attribute} is {text!r}, not {wanted}"
        )
    return values
