"""The figures of the method in Hielscher et al. (2025), drawn from this code: in 1-D, in 3-D, and phases.

Where the formula as printed does not give what the paper's text says (Slow In's start, Secondary Action at
0.05, Exaggeration of a reach), the panel says so and shows beside it the form that does.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from stimuli.dmp import Primitive
from stimuli.gestures.keyframes import between_keys
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.principles.slow import Slow
from stimuli.principles.time import sectors
from stimuli.robots.model import Joint, Relation, Robot
from stimuli.rollout import integrate, sampled
from stimuli.trajectory import FloatArray, Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Parameters = Mapping[str, Any]

_DURATION_S = 10.0
_DT_S = 0.01
_TAIL = 1.25  # shown of a motion, in durations


@dataclass(frozen=True)
class Panel:
    """One principle on one demonstration: labels of curves with the modulations that draw them."""

    title: str
    curves: tuple[tuple[str, Parameters], ...]
    note: str = ""  # where the formula as printed does not give what the paper says of it
    joint: str = "source"
    shown: Literal["bumps", "reach"] = "bumps"


# The paper's values; beside the formula as printed, the form that does what its text says.
PANELS = (
    Panel("a  Arc", (("p = 5", {"arc": 5}), ("p = -5", {"arc": -5}))),
    Panel(
        "b  Anticipation",
        (("p = 0.4", {"ant": 0.4}), ("mirror, p = 0.4", {"ant": {"intensity": 0.4, "form": "mirror"}})),
        note="As printed, the dip grows exponentially with p; mirrored it is in proportion.",
    ),
    Panel("c  Timing: scale", (("p = 0.75", {"time": 0.75}), ("p = 1.25", {"time": 1.25}))),
    Panel(
        "d  Timing: progression",
        (
            ("slow, fast", {"time": {"progression": ["slow", "fast"]}}),
            ("fast, slow", {"time": {"progression": ["fast", "slow"]}}),
        ),
    ),
    Panel(
        "d  Slow In and Slow Out",
        (
            ("p = 1 on the phase", {"slow": 1}),
            ("p = 1, retimed", {"slow": {"intensity": 1, "form": "retime"}}),
        ),
        note="As printed, on the phase, the start is less slow, and peaks and dips are lost.",
    ),
    Panel("e  Exaggeration", (("p = 0.5", {"exa": 0.5}), ("p = 1.5", {"exa": 1.5}), ("p = 0", {"exa": 0}))),
    Panel(
        "e  Exaggeration of a reach",
        (
            ("p = 1.5 around the goal", {"exa": 1.5}),
            ("p = 1.5 around a straight reach", {"exa": {"intensity": 1.5, "around": "straight"}}),
        ),
        note="As printed, around the goal, a reach sets out backwards.",
        shown="reach",
    ),
    Panel(
        "f  Secondary Action, target",
        (
            ("p = 0.05 on the output", {"sec": 0.05}),
            ("p = 0.05 on the state", {"sec": {"intensity": 0.05, "form": "state"}}),
        ),
        note="As printed, on the output, it is hardly seen.",
        joint="target",
    ),
    Panel("g  Follow Through, target", (("p = 3", {"follow": 3}),), joint="target"),
    Panel(
        "h  Randomization",
        tuple((f"p = 0.5, seed {i}", {"rand": {"intensity": 0.5, "seed": i}}) for i in range(4)),
    ),
)

# The same for paths over a sphere through this many places.
PATHS: tuple[tuple[str, int, tuple[tuple[str, Parameters], ...]], ...] = (
    ("Arc, rough path", 16, (("p = 2", {"arc": 2}), ("p = -2", {"arc": -2}))),
    (
        "Exaggeration and Anticipation, dense path",
        200,
        (("Exa 1.3", {"exa": 1.3}), ("Exa 0.7", {"exa": 0.7}), ("Ant 0.4", {"ant": 0.4})),
    ),
)


def draw_paper_figures(out: Path, dpi: int = 150) -> list[Path]:
    """Draw every figure into the folder `out`; returns the files."""
    out.mkdir(parents=True, exist_ok=True)
    drawn = {
        "principles_1d.png": principles_in_one_dimension(),
        "phases.png": phases(),
        "principles_3d.png": principles_in_three_dimensions(),
        "overview.png": overview(),
    }
    for name, figure in drawn.items():
        figure.savefig(out / name, dpi=dpi)
    return [out / name for name in drawn]


def one_dimension() -> Trajectory:
    """The demonstration of figure 1D: values change at both ends, slopes both ways, steep and gentle.

    The joint `target` moves as `source` does, less and in its own time.
    """
    times = np.linspace(0.0, _DURATION_S, round(_DURATION_S / _DT_S) + 1)
    moments, values = (
        np.array([0.0, 1.6, 3.0, 5.2, 6.4, 8.2, 10.0]),
        np.array([0.0, 0.7, 0.45, 1.0, -0.1, 0.35, 0.2]),
    )
    source = between_keys(moments, values, times)
    return Trajectory(times, np.stack([source, source], axis=1), ("source", "target"))


def reach() -> Trajectory:
    """A minimum-jerk reach by `source`, which `target` joins in."""
    times = np.linspace(0.0, _DURATION_S, round(_DURATION_S / _DT_S) + 1)
    s = times / _DURATION_S
    way = 10 * s**3 - 15 * s**4 + 6 * s**5
    return Trajectory(times, np.stack([way, way], axis=1), ("source", "target"))


def sphere(points: int, turns: float = 3.0) -> Trajectory:
    """Straight lines between `points` places on a unit sphere, from the top to the bottom."""
    share = np.linspace(0.02, 0.98, points)
    polar, around = np.pi * share, 2 * np.pi * turns * share
    places = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=1)
    times = np.linspace(0.0, _DURATION_S, round(_DURATION_S / _DT_S) + 1)
    positions = np.stack(
        [np.interp(times, _DURATION_S * (share - 0.02) / 0.96, along) for along in places.T], axis=1
    )
    return Trajectory(times, positions, ("x", "y", "z"))


def plain_robot(joints: tuple[str, ...], relations: tuple[Relation, ...] = ()) -> Robot:
    """Free coordinates without a body, each of range 2."""

    def build() -> Any:
        raise NotImplementedError("coordinates have no body")

    free = tuple(
        Joint(name, "world", name, "prismatic", (0, 0, 0), (0, 0, 0), (1, 0, 0), -1.0, 1.0, None)
        for name in joints
    )
    return Robot("coordinates", "Coordinates", free, dict.fromkeys(joints, 0.0), build, relations=relations)


def modulated(
    demonstration: Trajectory, parameters: Parameters, tail: float = _TAIL
) -> tuple[FloatArray, FloatArray]:
    """Times and positions (n, d) of a demonstration under a modulation."""
    relations = (Relation("source", "target", 1),) if "source" in demonstration.joints else ()
    course = Primitive.learn(demonstration).course(
        Modulation.model_validate(dict(parameters)), plain_robot(demonstration.joints, relations)
    )
    n = round(tail * course.tau_s / _DT_S)
    return sampled(n, _DT_S), integrate(course, _DT_S, n)[0]


def principles_in_one_dimension() -> Figure:
    """Figure 1D: each principle on one demonstrated motion, which is dashed."""
    figure = _figure(9.0, 12.0)
    for axes, panel in zip(figure.subplots(5, 2).ravel(), PANELS, strict=True):
        shown = reach() if panel.shown == "reach" else one_dimension()
        axes.plot(shown.times, shown.joint(panel.joint), "k--", linewidth=1, label="demonstrated")
        for label, parameters in panel.curves:
            times, positions = modulated(shown, parameters)
            axes.plot(times, positions[:, shown.joints.index(panel.joint)], label=label, linewidth=1.3)
        axes.set_xlim(0, _TAIL * _DURATION_S)
        _finish(axes, panel.title, "time (s)", "position")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=7)
        axes.text(1.04, 0.0, fill(panel.note, 24), transform=axes.transAxes, fontsize=7, style="italic")
    return figure


def phases() -> Figure:
    """The phase over time for Slow In and Out and for the progressions of Timing; dashed as learned."""
    figure = _figure(7.0, 3.0)
    s = np.linspace(0, 1, 201)
    slow = [(f"p = {p:g}", Slow(intensity=p).curve()) for p in (0.5, 1)]
    time = [("slow, fast", sectors((0.5, 1.5))), ("fast, slow", sectors((1.5, 0.5)))]
    panels = (("Slow In and Slow Out", slow), ("Timing: progression", time))
    for axes, (title, curves) in zip(figure.subplots(1, 2), panels, strict=True):
        axes.plot(s, 1 - s, "k--", linewidth=1, label="as learned")
        for label, curve in curves:
            axes.plot(s, 1 - curve.gone(s), label=label, linewidth=1.3)
        _finish(axes, title, "share of time", "phase x")
        axes.legend(frameon=False, fontsize=7)
    return figure


def principles_in_three_dimensions() -> Figure:
    """Figure 3D: Arc on a rough path over a sphere, Exaggeration and Anticipation on a dense one."""
    figure = _figure(9.0, 4.6)
    for at, (title, points, curves) in enumerate(PATHS, 1):
        axes: Any = figure.add_subplot(1, 2, at, projection="3d")
        shown = sphere(points)
        for label, parameters in curves:
            axes.plot(*modulated(shown, parameters)[1].T, label=label, linewidth=1.3)
        axes.plot(*shown.positions.T, "k--", linewidth=1, label="demonstrated", zorder=9)
        axes.set_title(title, fontsize=9, loc="left", pad=-6)
        axes.set(xlabel="x", ylabel="y", zlabel="z", xticks=(-1, 0, 1), yticks=(-1, 0, 1), zticks=(-1, 0, 1))
        axes.tick_params(labelsize=8, pad=0)
        axes.set_aspect("equal")
        axes.legend(frameon=False, fontsize=8)
    return figure


def overview() -> Figure:
    """Every principle in the folder, plain to see, on the joint it changes most; dashed as shown."""
    shown = one_dimension()
    robot = plain_robot(shown.joints, (Relation("source", "target", 1),))
    primitive = Primitive.learn(shown)
    figure = _figure(9.0, 1.0 + 2.4 * math.ceil(len(PRINCIPLES) / 3))
    for at, (kind, made) in enumerate(PRINCIPLES.items(), 1):
        axes = figure.add_subplot(math.ceil(len(PRINCIPLES) / 3), 3, at)
        moved = primitive.rollout(Modulation(principles=(made.example(robot),)), robot)
        changes = np.abs(moved.at(shown.times) - shown.positions).max(axis=0)
        joint = shown.joints[int(np.argmax(changes))]
        axes.plot(shown.times, shown.joint(joint), "k--", linewidth=1, label="demonstrated")
        axes.plot(moved.times, moved.joint(joint), linewidth=1.3, label="modulated")
        _finish(axes, f"{made.title}, {kind}: {made.strong:g}", "time (s)", "position")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower right", ncols=2, frameon=False)
    return figure


def _figure(width: float, height: float) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _finish(axes: Axes, title: str, x: str, y: str) -> None:
    axes.set_title(title, fontsize=9, loc="left")
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
