"""A real browser plays a clip to its end, for exactly as long as it is."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

from stimuli.filming import render_clip
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec

MakeSpec = Callable[..., StimulusSpec]

pytestmark = pytest.mark.xdist_group("browser")

PLAY = """
(address) => new Promise((resolve, reject) => {
    const video = document.createElement("video");
    video.muted = true;
    video.onerror = () => reject(video.error.message);
    video.onended = () => resolve({
        duration: video.duration, at: video.currentTime, width: video.videoWidth, height: video.videoHeight,
    });
    video.src = address;
    document.body.append(video);
    video.play().catch(reject);
})
"""


def test_a_browser_plays_a_rendered_clip_to_its_end(spec: MakeSpec, pepper: Robot, tmp_path: Path) -> None:
    clip = render_clip(spec("nod"), pepper, tmp_path)
    (tmp_path / "page.html").write_text("<!doctype html><title>clip</title>")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium-headless-shell") or shutil.which("chromium"),
            args=["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
        )
        page = browser.new_page()
        page.goto((tmp_path / "page.html").as_uri())
        seen = page.evaluate(PLAY, (tmp_path / clip.file).as_uri())
        browser.close()
    assert (seen["width"], seen["height"]) == (clip.width, clip.height)
    assert seen["duration"] == pytest.approx(clip.duration_s, abs=1e-3)
    assert seen["at"] == pytest.approx(clip.duration_s, abs=1e-3)
