"""The joints of a stimulus over time: as demonstrated, dashed, and as the robot moves, solid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stimuli.motion import Motion
from stimuli.robots.model import Robot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOVES = 0.005  # of a joint's range: joints that move less are left out
COLUMNS = 3  # of panels at most
LEAST_IN = 6.0  # width that title and legend take beside each other
SHOWN = {
    "rad": ("°", np.degrees(1.0)),
    "m": ("cm", 100.0),
    "1": ("", 1.0),
}  # unit shown, and how many in ours


def draw_curves(motion: Motion, robot: Robot, out: Path, *, title: str) -> Path:
    """Write a picture with a panel for each joint that moves; dotted lines are the joint's limits."""
    figure = curves(motion, robot, title=title)
    figure.savefig(out, dpi=120)
    return out


def curves(motion: Motion, robot: Robot, *, title: str) -> Figure:
    """A panel for each joint that moves in the demonstration or in the stimulus."""
    from matplotlib.figure import Figure

    shown, made = motion.demonstration, motion.trajectory
    spans = {
        name: max(np.ptp(each.joint(name)) for each in (shown, made) if name in each.joints)
        for name in dict.fromkeys((*made.joints, *shown.joints))
    }
    names = [name for name, span in spans.items() if span > MOVES * robot.joint(name).range]
    columns = min(max(len(names), 1), COLUMNS)
    rows = max(1, -(-len(names) // columns))
    width_in = max(3.6 * columns, LEAST_IN)
    figure = Figure(figsize=(width_in, 0.7 + 2.0 * rows), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True).ravel()
    for panel, name in zip(panels, names, strict=False):
        joint = robot.joint(name)
        unit, scale = SHOWN[joint.unit]
        for motion_, style, label in ((shown, "--", "demonstrated"), (made, "-", "in the stimulus")):
            if name in motion_.joints:
                panel.plot(motion_.times, scale * motion_.joint(name), style, color="#1f4e79", label=label)
        low, high = panel.get_ylim()
        for limit in (scale * joint.lower, scale * joint.upper):
            if low <= limit <= high:
                panel.axhline(limit, color="#b03a2e", linewidth=0.8, linestyle=":")
        panel.set_title(f"{name} ({unit})" if unit else name, fontsize="medium", loc="left")
        panel.spines[["top", "right"]].set_visible(False)
    for panel in panels[len(names) :]:
        panel.set_visible(False)
    for panel in panels[max(0, len(names) - columns) : len(names)]:
        panel.tick_params(labelbottom=True)
        panel.set_xlabel("time (s)")
    if names:
        figure.legend(
            *panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=2, frameon=False
        )
    figure.suptitle(title if names else f"{title}: nothing moves", x=0.01, ha="left")
    return figure
