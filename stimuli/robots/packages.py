"""Where the packages lie in which a URDF's `package://NAME/…` are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

PACKAGE = "package://"


def folders_of(model: Path, search: Sequence[Path]) -> list[Path]:
    """The folders that may hold a model's packages: those of `search`, then all above it.

    Links are not followed: what lies in a study's folder by a link counts as lying there.
    """
    return [*search, *model.absolute().parents]


def package_folders(filename: str, folders: Sequence[Path]) -> tuple[list[Path], str]:
    """Where the package of `package://NAME/REST` may lie, and the rest."""
    package, _, rest = filename.removeprefix(PACKAGE).partition("/")
    return [folder if folder.name == package else folder / package for folder in folders], rest
