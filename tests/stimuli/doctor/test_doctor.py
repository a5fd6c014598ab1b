"""The doctor tries what it reports on: every bad case here is a real one, made with environment variables."""

from __future__ import annotations

import os
from pathlib import Path

from stimuli.doctor import Line, examine

NO_EGL = {"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent", "__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}


def lines(tmp_path: Path, **changed: str) -> dict[str, Line]:
    kept = {name: value for name, value in os.environ.items() if name != "MUJOCO_GL"}
    return {line.what: line for line in examine(tmp_path, {**kept, **changed}).lines}


def test_a_machine_that_can_render_is_told_what_draws(tmp_path: Path) -> None:
    found = lines(tmp_path, MUJOCO_GL="egl")
    drawing = found["drawing through egl"]
    assert drawing.state in ("good", "warning")
    assert ("llvmpipe" in drawing.found) == (drawing.state == "warning")
    assert found["video"].state == "good"


def test_a_setting_that_cannot_work_without_a_screen_is_named(tmp_path: Path) -> None:
    drawing = lines(tmp_path, MUJOCO_GL="glfw")["drawing"]
    assert drawing.state == "bad"
    assert "'glfw'" in drawing.found
    assert "egl or osmesa" in drawing.remedy


def test_without_egl_drivers_the_packages_to_install_are_named(tmp_path: Path) -> None:
    drawing = lines(tmp_path, MUJOCO_GL="egl", **NO_EGL)["drawing through egl"]
    assert drawing.state == "bad"
    assert "libegl1 libopengl0 libgl1-mesa-dri" in drawing.remedy
    assert not examine(tmp_path, {**os.environ, "MUJOCO_GL": "egl", **NO_EGL}).good


def test_a_folder_that_is_not_there_yet_is_judged_by_the_disk_it_will_be_on(tmp_path: Path) -> None:
    assert f"disk at {tmp_path}" in lines(tmp_path / "not" / "yet", MUJOCO_GL="glfw")


def test_too_full_a_disk_is_bad(tmp_path: Path) -> None:
    disk = examine(tmp_path, {"MUJOCO_GL": "glfw"}, needed_mb=10**9).lines[-1]
    assert disk.what == f"disk at {tmp_path}"
    assert disk.state == "bad"
    assert "Free at least" in disk.remedy


def test_a_graphics_device_that_is_not_there_is_named(tmp_path: Path) -> None:
    drawing = lines(tmp_path, MUJOCO_GL="egl", MUJOCO_EGL_DEVICE_ID="99")["drawing through egl"]
    assert drawing.state == "bad"
    assert "MUJOCO_EGL_DEVICE_ID is '99'" in drawing.remedy


def test_the_browser_of_this_machine_is_asked_whether_it_plays_clips(tmp_path: Path) -> None:
    assert lines(tmp_path, MUJOCO_GL="glfw")["browser chromium"].found == "plays H.264"
    mute = tmp_path / "chromium"
    mute.write_text("#!/bin/sh\necho '<html></html>'\n")
    mute.chmod(0o755)
    browser = lines(tmp_path, MUJOCO_GL="glfw", PATH=str(tmp_path))["browser chromium"]
    assert (browser.state, browser.found) == ("warning", "does not play H.264")


def test_a_machine_without_a_browser_is_told_nothing_of_it(tmp_path: Path) -> None:
    assert not [what for what in lines(tmp_path, MUJOCO_GL="glfw", PATH="") if what.startswith("browser")]
