from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

import av
import numpy as np
import pytest

from study.protocol import Protocol, load_protocol
from study.storage import open_store
from study.web.app import create_app
from study.web.credentials import new_credentials
from study.web.server import running
from study.web.site import Clip, Site

PASSWORD = "correct horse"

SMALL = """
study: small
title: {en: "How does the robot move?", de: "Wie bewegt sich der Roboter?"}
contact: lab@example.org
robot: pepper
seed: 1
gestures: {wave: wave.yaml}
modulations: {joy: {time: 0.8}, sadness: {time: 1.5}}
levels: {time: [1.4, 1.0, 0.7]}
practice: {stimulus: {gesture: wave}, ask: recognition}
parts:
  recognition:
    title: {en: "What does the robot express?", de: "Was drückt der Roboter aus?"}
    stimuli: {gesture: wave, modulations: [joy, sadness]}
    order: williams
    ask:
      - rate:
          text: {en: To which extent does the robot express …, de: Wie stark drückt der Roboter aus …}
          items:
            joy: {en: Joy, de: Freude}
            sadness: {en: Sadness, de: Trauer}
            anger: {en: Anger, de: Ärger}
            fear: {en: Fear, de: Angst}
            shame: {en: Shame, de: Scham}
            hurry: {en: Hurry, de: Eile}
          points: 5
          ends: {en: [not at all, very strongly], de: [gar nicht, sehr stark]}
  intensity:
    title: {en: "How intense is the motion?", de: "Wie intensiv ist die Bewegung?"}
    stimuli: {gesture: wave, levels: [time]}
    reference: medium
    order: {principles: williams, levels: balanced}
    ask:
      - choose:
          item: intensity
          text: {en: "Compared with the first video, the motion in the second video has a …",
                 de: "Verglichen mit dem ersten Video hat die Bewegung im zweiten Video eine …"}
          options:
            lower: {en: lower intensity, de: geringere Intensität}
            higher: {en: higher intensity, de: höhere Intensität}
          sides: balanced
participants: {planned: 4}
analysis:
  H1: {part: recognition, test: one-sample t, of: target, against: midpoint, alternative: greater}
  H2: {part: intensity, test: independent t, compare: [high, low], outcome: higher, alternative: greater}
"""

WAVE = """
gesture: wave
robot: pepper
title: {en: Greeting wave}
unit: deg
duration: 1.0 s
joints:
  RShoulderPitch: {0.0: home, 0.5: -40, 1.0: home}
"""


@pytest.fixture
def protocol(tmp_path: Path) -> Protocol:
    """A small study of both parts: 1 practice, 2 + 2 trials."""
    folder = tmp_path / "small"
    folder.mkdir()
    (folder / "protocol.yaml").write_text(SMALL, encoding="utf-8")
    (folder / "wave.yaml").write_text(WAVE, encoding="utf-8")
    return load_protocol(folder)


@pytest.fixture(scope="session")
def video_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("clips")


def write_clip(path: Path, *, shade: int, frames: int = 18, fps: int = 30) -> None:
    """A real, short H.264 clip: a bar that moves over a grey ground."""
    with av.open(path, "w", options={"movflags": "faststart"}) as container:
        stream = container.add_stream("libx264", rate=fps)
        stream.width, stream.height, stream.pix_fmt = 320, 180, "yuv420p"
        for number in range(frames):
            picture = np.full((180, 320, 3), shade, np.uint8)
            picture[:, 10 * number : 10 * number + 20] = 255 - shade
            for packet in stream.encode(av.VideoFrame.from_ndarray(picture, "rgb24")):
                container.mux(packet)
        for packet in stream.encode():
            container.mux(packet)


@pytest.fixture
def clips(protocol: Protocol, video_folder: Path) -> dict[str, Clip]:
    """A clip of 0.6 s for every stimulus of the study."""
    made = {}
    for number, stimulus in enumerate(protocol.stimuli):
        path = video_folder / f"{stimulus}.mp4"
        if not path.exists():
            write_clip(path, shade=60 + 10 * number)
        content = path.read_bytes()
        made[stimulus] = Clip(path, hashlib.sha256(content).hexdigest(), len(content), duration_s=18 / 30)
    return made


@pytest.fixture
def site(protocol: Protocol, clips: dict[str, Clip], tmp_path: Path) -> Iterator[Site]:
    store = open_store(f"sqlite:///{tmp_path}/data/study.db")
    yield Site(protocol, store, clips, new_credentials(PASSWORD), "software 1")
    store.close()


@pytest.fixture
def address(site: Site) -> Iterator[str]:
    """The study on a real server."""
    with running(create_app(site)) as url:
        yield url
