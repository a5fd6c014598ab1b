"""Robots of the package `robot_descriptions`: fetched by git, at commits it pins."""

from __future__ import annotations

import shutil
import subprocess
import sys
from contextlib import redirect_stdout
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from stimuli.errors import InputError, nearest

PREFIX = "robot_descriptions/"
CACHE = "ROBOT_DESCRIPTIONS_CACHE"


@dataclass(frozen=True)
class Description:
    """Where a robot's model lies on this machine, and which version of it that is."""

    model: Path  # MJCF where there is one, else URDF
    search: tuple[Path, ...]  # folders that hold its packages
    origin: str  # its name and the commit


def find_description(name: str) -> Description:
    """The description `robot_descriptions/NAME`, fetched if it is not in the cache yet.

    InputError where the package is missing, knows no such name, or cannot fetch it. Only names on the
    package's own list are imported.
    """
    wanted = name.removeprefix(PREFIX)
    try:
        known = import_module("robot_descriptions").DESCRIPTIONS
    except ImportError as error:
        raise InputError(
            f"{name}: this needs the package robot_descriptions, which is not installed here: "
            "pip install robot_descriptions"
        ) from error
    if wanted not in known:
        raise InputError(f"{name}: {wanted!r} is not among the robot descriptions; {nearest(wanted, known)}")
    if shutil.which("git") is None:
        raise InputError(
            f"{name}: robot descriptions are fetched by git, which is not installed: apt-get install git"
        )
    try:
        with redirect_stdout(sys.stderr):  # it tells of its downloads
            module = import_module(f"robot_descriptions.{wanted}")
    except Exception as error:  # git, the network and the file system fail in ways of their own
        reason = (str(error).strip().splitlines() or [""])[-1].strip()
        raise InputError(
            f"{name}: cannot be fetched: {type(error).__name__}: {reason}. Fetched once, it is kept in the "
            f"folder that the variable {CACHE} names (~/.cache/robot_descriptions unless told). Without a "
            "network, copy that folder from a machine that has it."
        ) from error
    model = Path(getattr(module, "MJCF_PATH", None) or module.URDF_PATH)
    repository, package = Path(module.REPOSITORY_PATH), Path(module.PACKAGE_PATH)
    return Description(model, (package.parent, repository), f"{name} @{_commit(repository)}")


def _commit(repository: Path) -> str:
    done = subprocess.run(
        ["git", "-C", str(repository), "rev-parse", "HEAD"], capture_output=True, text=True, check=False
    )
    return done.stdout.strip() or "unknown commit"
