"""The figures of the method in Hielscher et al. (2025), drawn from this code: in 1-D, in 3-D, and phases.

Where the paper's formula does not give what its text says (Slow In's start, Secondary Action at 0.05), the
panel shows beside it the form that does.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

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

# Panel: title, label of the curve and the modulation that draws it. The paper's values.
PANELS: tuple[tuple[str, tuple[tuple[str, Parameters], ...]], ...] = (
    ("a  Arc", (("p = 5", {"arc": 5}), ("p = -5", {"arc": -5}))),
    (
        "b  Anticipation",
        (("p = 0.4", {"ant": 0.4}), ("mirror, p = 0.4", {"ant": {"intensity": 0.4, "form": "mirror"}})),
    ),
    ("c  Timing: scale", (("p = 0.75", {"time": 0.75}), ("p = 1.25", {"time": 1.25}))),
    (
        "d  Timing: progression; Slow In and Out",
        (
            ("slow, fast", {"time": {"progression": ["slow", "fast"]}}),
            ("fast, slow", {"time": {"progression": ["fast", "slow"]}}),
            ("Slow", {"slow": 1}),
            ("Slow, retimed", {"slow": {"intensity": 1, "form": "retime"}}),
        ),
    ),
    ("e  Exaggeration", (("p = 0.5", {"exa": 0.5}), ("p = 1.5", {"exa": 1.5}), ("p = 0", {"exa": 0}))),
    (
        "f  Secondary Action (target)",
        (
            ("p = 0.05 as printed", {"sec": 0.05}),
            ("p = 0.05 on the state", {"sec": {"intensity": 0.05, "form": "state"}}),
        ),
    ),
    ("g  Follow Through (target)", (("p = 3", {"follow": 3}),)),
    ("h  Randomization", tuple((f"seed {i}", {"rand": {"intensity": 0.5, "seed": i}}) for i in range(4))),
)

# The same for paths over a sphere through this many places.
PATHS: tuple[tuple[str, int, tuple[tuple[str, Parameters], ...]], ...] = (
    ("Arc", 16, (("p = 2", {"arc": 2}), ("p = -2", {"arc": -2}))),
    (
        "Exaggeration, Anticipation",
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
    figure = _figure(9.0, 10.0)
    shown = one_dimension()
    for at, (title, curves) in enumerate(PANELS, 1):
        axes = figure.add_subplot(4, 2, at)
        axes.plot(shown.times, shown.joint("target"), "k--", linewidth=1)
        for label, parameters in curves:
            times, positions = modulated(shown, parameters)
            column = 1 if "target" in title else 0
            axes.plot(times, positions[:, column], label=label, linewidth=1.3)
        _finish(axes, title, "time (s)", "position")
    return figure


def phases() -> Figure:
    """The phase over time for Slow In and Out and for the progressions of Timing; dashed as learned."""
    figure = _figure(7.0, 3.0)
    s = np.linspace(0, 1, 201)
    slow = figure.add_subplot(1, 2, 1)
    slow.plot(s, 1 - s, "k--", s, 1 - Slow(intensity=1).curve().gone(s), linewidth=1.3)
    _finish(slow, "Slow In and Slow Out", "share of time", "phase x", legend=False)
    time = figure.add_subplot(1, 2, 2)
    time.plot(s, 1 - s, "k--", linewidth=1)
    for label, speeds in (("slow, fast", (0.5, 1.5)), ("fast, slow", (1.5, 0.5))):
        time.plot(s, 1 - sectors(speeds).gone(s), label=label, linewidth=1.3)
    _finish(time, "Timing", "share of time", "phase x")
    return figure


def principles_in_three_dimensions() -> Figure:
    """Figure 3D: Arc on a rough path over a sphere, Exaggeration and Anticipation on a dense one."""
    figure = _figure(9.0, 4.5)
    for at, (title, points, curves) in enumerate(PATHS, 1):
        axes: Any = figure.add_subplot(1, 2, at, projection="3d")
        shown = sphere(points)
        axes.plot(*shown.positions.T, "k--", linewidth=1)
        for label, parameters in curves:
            axes.plot(*modulated(shown, parameters)[1].T, label=label, linewidth=1.3)
        axes.set_title(title)
        axes.legend(frameon=False, fontsize=8)
    return figure


def overview(demonstration: Trajectory, robot: Robot, joint: str) -> Figure:
    """Every principle, plain to see, on one joint of a gesture; the demonstration is dashed."""
    figure = _figure(9.0, 9.0)
    primitive = Primitive.learn(demonstration)
    for at, (kind, made) in enumerate(PRINCIPLES.items(), 1):
        axes = figure.add_subplot(3, 3, at)
        shown = primitive.rollout(Modulation(principles=(made.example(robot),)), robot)
        axes.plot(demonstration.times, demonstration.joint(joint), "k--", linewidth=1)
        axes.plot(shown.times, shown.joint(joint), label=f"{kind} {made.strong:g}", linewidth=1.3)
        _finish(axes, made.title, "time (s)", f"{joint} ({robot.joint(joint).unit})")
    return figure


def _figure(width: float, height: float) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _finish(axes: Axes, title: str, x: str, y: str, *, legend: bool = True) -> None:
    axes.set_title(title, fontsize=9, loc="left")
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
    if legend:
        axes.legend(frameon=False, fontsize=7)
