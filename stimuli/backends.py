"""Through which OpenGL MuJoCo is to draw, as `MUJOCO_GL` says; with a wrong one, importing MuJoCo fails."""

from __future__ import annotations

from collections.abc import Mapping

from stimuli.errors import InputError

BACKENDS = ("egl", "osmesa")  # those that need no screen, the better first


def backends(environment: Mapping[str, str]) -> tuple[str, ...]:
    """Those to try. InputError where `MUJOCO_GL` names none that draws without a screen."""
    chosen = environment.get("MUJOCO_GL", "")
    if chosen not in ("", *BACKENDS):
        raise InputError(
            f"MUJOCO_GL is {chosen!r}, which cannot draw without a screen. "
            "Unset it, or set it to egl or osmesa."
        )
    return (chosen,) if chosen else BACKENDS
