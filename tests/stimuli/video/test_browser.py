"""A real browser plays a clip to its end, for exactly as long as it is."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import sync_playwright

from stimuli.video import write_video

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


def test_a_browser_plays_a_clip_to_its_end(tmp_path: Path) -> None:
    ramp = [np.full((48, 64, 3), level, np.uint8) for level in range(0, 240, 10)]
    write_video(tmp_path / "clip.mp4", ramp, fps=30)
    (tmp_path / "page.html").write_text("<!doctype html><title>clip</title>")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium-headless-shell") or shutil.which("chromium"),
            args=["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"],
        )
        page = browser.new_page()
        page.goto((tmp_path / "page.html").as_uri())
        seen = page.evaluate(PLAY, (tmp_path / "clip.mp4").as_uri())
        browser.close()
    assert (seen["width"], seen["height"]) == (64, 48)
    assert seen["duration"] == pytest.approx(24 / 30, abs=1e-3)
    assert seen["at"] == pytest.approx(24 / 30, abs=1e-3)
