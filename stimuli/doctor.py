"""Can this machine draw and write clips? Each thing is tried, and each lack says what to do."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from stimuli.backends import backends
from stimuli.errors import InputError

State = Literal["good", "warning", "bad"]

PACKAGES = {
    "egl": "apt-get install --no-install-recommends libegl1 libopengl0 libgl1-mesa-dri",
    "osmesa": "apt-get install --no-install-recommends libosmesa6 libopengl0",
}
SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swrast")
BROWSERS = ("chromium", "google-chrome", "chromium-browser", "microsoft-edge")
CAN_PLAY = (
    "<script>document.write(document.createElement('video')"
    """.canPlayType('video/mp4; codecs="avc1.640020"'))</script>"""
)
NEEDED_MB = 500  # a study of 24 clips takes some 20 MB; the rest is for answers and reports
PROBE = """
import json, os
from stimuli.rendering import gl_renderer, open_context
context = open_context(64, 64)
print(json.dumps(gl_renderer()))
context.free()
"""


@dataclass(frozen=True)
class Line:
    """One thing examined: what it is, what was found, and what would help."""

    state: State
    what: str
    found: str
    remedy: str = ""

    def __str__(self) -> str:
        return f"{self.what}: {self.found}" + (f"\n    {self.remedy}" if self.remedy else "")


@dataclass(frozen=True)
class Report:
    """Everything examined."""

    lines: tuple[Line, ...]

    @property
    def good(self) -> bool:
        """Whether clips can be made here, be it slowly."""
        return all(line.state != "bad" for line in self.lines)

    def __str__(self) -> str:
        return "\n".join(f"{line.state:8}{line}" for line in self.lines)


def examine(
    folder: Path | None = None, environment: Mapping[str, str] | None = None, *, needed_mb: int = NEEDED_MB
) -> Report:
    """Try drawing, encoding, a browser and the disk; `folder` is where clips would go."""
    env = dict(os.environ if environment is None else environment)
    return Report((*_drawing(env), _encoder(), *_browser(env), _disk(folder or Path.cwd(), needed_mb)))


def _drawing(env: Mapping[str, str]) -> list[Line]:
    try:
        tried = {backend: _probe(backend, env) for backend in backends(env)}
    except InputError as error:
        found, _, remedy = str(error).partition(". ")
        return [Line("bad", "drawing", found, remedy)]
    works = {backend: name for backend, (name, _) in tried.items() if name}
    lacks = [
        Line("warning" if works else "bad", f"drawing through {backend}", problem, _remedy(backend, env))
        for backend, (_, problem) in tried.items()
        if backend not in works and (not works or backend == "egl")
    ]
    if not works:
        return lacks
    backend, name = next(iter(works.items()))
    if any(word in name.lower() for word in SOFTWARE_RENDERERS):
        remedy = (
            "Works; a clip of five seconds takes about ten. A graphics card and its driver would be faster."
        )
        return [*lacks, Line("warning", f"drawing through {backend}", f"in software, by {name}", remedy)]
    return [*lacks, Line("good", f"drawing through {backend}", name)]


def _remedy(backend: str, env: Mapping[str, str]) -> str:
    device = env.get("MUJOCO_EGL_DEVICE_ID")
    if backend == "egl" and device is not None:
        return f"MUJOCO_EGL_DEVICE_ID is {device!r}: unset it, or give the number of a device that is there."
    return f"On Debian or Ubuntu: {PACKAGES[backend]}"


def _probe(backend: str, env: Mapping[str, str]) -> tuple[str, str]:
    """The renderer's name, or why there is none. In its own process: a broken driver may take it along."""
    env = {**env, "MUJOCO_GL": backend, "PYOPENGL_PLATFORM": backend}
    try:
        done = subprocess.run(
            [sys.executable, "-c", PROBE], env=env, capture_output=True, text=True, timeout=60, check=False
        )
    except subprocess.TimeoutExpired:
        return "", "no answer within a minute: the driver hangs"
    if done.returncode == 0:
        return str(json.loads(done.stdout.splitlines()[-1])), ""
    if done.returncode < 0:
        return "", f"the driver crashed (signal {-done.returncode})"
    last = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "no message"
    return "", last.rpartition("Tried ")[2]


def _encoder() -> Line:
    """Whether a clip can be written and read back."""
    import av
    import numpy as np

    from stimuli.video import read_frames, write_video

    frames = [np.full((64, 64, 3), level, np.uint8) for level in (60, 120, 180)]
    try:
        with tempfile.TemporaryDirectory() as folder:
            write_video(Path(folder, "clip.mp4"), frames, fps=3)
            count = len(read_frames(Path(folder, "clip.mp4")))
    except (av.FFmpegError, ValueError, InputError) as error:
        remedy = "Install PyAV from its wheel, which brings libx264: pip install --force-reinstall av"
        return Line("bad", "video", f"PyAV {av.__version__} writes no H.264 ({error})", remedy)
    if count != len(frames):
        return Line("bad", "video", f"{count} of {len(frames)} frames came back from a clip")
    return Line("good", "video", f"H.264 by libx264 in PyAV {av.__version__}")


def _browser(env: Mapping[str, str]) -> list[Line]:
    """Whether the browser of this machine, if it is one that can be asked, plays such clips."""
    browser = next(filter(None, (shutil.which(name, path=env.get("PATH")) for name in BROWSERS)), None)
    if browser is None:
        return []
    asked = [
        browser,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--dump-dom",
        f"data:text/html,{CAN_PLAY}",
    ]
    what = f"browser {Path(browser).name}"
    try:
        said = subprocess.run(
            asked, env=dict(env), capture_output=True, text=True, timeout=30, check=False
        ).stdout
    except (subprocess.TimeoutExpired, OSError):
        return [Line("warning", what, "did not answer", "Try the study in it before the first participant.")]
    if "probably" in said:
        return [Line("good", what, "plays H.264")]
    remedy = "Take Chrome, Firefox, Safari or Edge, or on Debian the package chromium."
    return [Line("warning", what, "does not play H.264", remedy)]


def _disk(folder: Path, needed_mb: int) -> Line:
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    free = shutil.disk_usage(there).free // 2**20
    if free < needed_mb:
        return Line("bad", f"disk at {there}", f"{free} MB free", f"Free at least {needed_mb} MB.")
    return Line("good", f"disk at {there}", f"{free / 1024:.1f} GB free")
