"""The server as the command line runs it: a process of its own, stopped kindly or killed."""

from __future__ import annotations

import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from uuid import uuid4

import httpx
import pytest

from stimuli.errors import InputError
from stimuli.manifest import Clip as ManifestClip
from stimuli.manifest import Manifest
from study.protocol import Protocol
from study.storage import open_store
from study.versions import Version
from study.web import serve
from study.web.app import create_app
from study.web.clip_files import require_earlier_clips
from study.web.credentials import open_credentials
from study.web.server import running
from study.web.site import Clip, Site

SERVE = """
import sys
from pathlib import Path
from stimuli.manifest import Manifest
from study.protocol import load_protocol
from study.web import serve

def announce(links):
    print(links.participant, links.passwords and links.passwords.edit, flush=True)

folder = Path(sys.argv[1])
clips = Path(sys.argv[2])
serve(load_protocol(folder), Manifest.load(clips), clips_folder=clips, data_folder=folder / "data",
      announce=announce, port=0, kind="simulated")
print("closed")
"""


@pytest.fixture
def manifest(clips: dict[str, Clip]) -> Manifest:
    made = Manifest(
        stimuli={
            stimulus: ManifestClip(
                file=clip.path.name,
                file_sha256=clip.sha256,
                spec={},
                spec_sha256="",
                frames=18,
                fps=30,
                duration_s=clip.duration_s,
                width=320,
                height=180,
                size_bytes=clip.size,
                software={},
                gl_renderer="none",
            )
            for stimulus, clip in clips.items()
        }
    )
    made.save(next(iter(clips.values())).path.parent)
    return made


@contextmanager
def serving(protocol: Protocol, clips_folder: Path) -> Iterator[tuple[subprocess.Popen[str], str, str]]:
    command = [sys.executable, "-c", SERVE, str(protocol.folder), str(clips_folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            address, password = process.stdout.readline().split()
            yield process, address, password
        finally:
            process.kill()


def test_ctrl_c_and_what_stops_services_end_it_well_and_the_password_is_made_once(
    protocol: Protocol, manifest: Manifest, video_folder: Path
) -> None:
    for start, stop in enumerate((signal.SIGINT, signal.SIGTERM)):
        with serving(protocol, video_folder) as (process, address, password):
            assert (password == "None") == (start == 1)
            assert httpx.get(address).status_code == 200
            process.send_signal(stop)
            said, _ = process.communicate(timeout=20)
            assert (process.returncode, said) == (0, "closed\n")


def test_two_servers_cannot_serve_one_study_and_a_killed_one_is_not_in_the_way(
    protocol: Protocol, manifest: Manifest, video_folder: Path
) -> None:
    with serving(protocol, video_folder) as (process, _, _):
        with pytest.raises(InputError, match=rf"study.db: is being served by process {process.pid} on "):
            serve(
                protocol,
                manifest,
                clips_folder=video_folder,
                data_folder=protocol.folder / "data",
                announce=print,
                port=0,
            )
        process.kill()
    with serving(protocol, video_folder) as (_, address, _):
        assert httpx.get(address).status_code == 200


def test_no_answer_that_was_acknowledged_is_lost_when_the_server_is_killed(
    protocol: Protocol, manifest: Manifest, video_folder: Path
) -> None:
    acknowledged: list[str] = []
    for _ in range(2):
        with serving(protocol, video_folder) as (process, address, _):
            enough = Event()
            before = len(acknowledged)

            def answer_until_it_dies(
                address: str = address, enough: Event = enough, before: int = before
            ) -> None:
                while True:
                    try:
                        with httpx.Client(base_url=address, follow_redirects=True) as browser:
                            browser.post("/start")
                            browser.post("/consent", data={"agreed": "yes", "language": "en"})
                            for step in ("demographics", "instructions:practice"):
                                sent = {"id": str(uuid4()), "step": step, "on_page_ms": 1.0}
                                if browser.post("/study/answers", json=sent).status_code == 200:
                                    acknowledged.append(sent["id"])
                    except httpx.TransportError:
                        return
                    if len(acknowledged) > before + 30:
                        enough.set()

            with ThreadPoolExecutor(4) as crowd:
                for _ in range(4):
                    crowd.submit(answer_until_it_dies)
                assert enough.wait(timeout=60)
                process.kill()
    store = open_store(f"sqlite:///{protocol.folder}/data/study.db")
    stored = [
        str(response.submission.id) for _, responses in store.responses("simulated") for response in responses
    ]
    store.close()
    assert len(acknowledged) > 60
    assert set(acknowledged) <= set(stored)
    assert len(stored) == len(set(stored))


def test_a_study_without_its_clips_is_not_served(protocol: Protocol, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"5 of 6 clips are not there|6 of 6 clips are not there"):
        serve(protocol, Manifest(), clips_folder=tmp_path, data_folder=tmp_path, announce=print)


def test_a_manifest_names_files_of_its_own_folder_only(manifest: Manifest, tmp_path: Path) -> None:
    told = manifest.model_dump_json().replace("joy.mp4", "../joy.mp4")
    (tmp_path / "manifest.json").write_text(told)
    with pytest.raises(InputError, match="this is not a manifest of clips"):
        Manifest.load(tmp_path)


def test_passwords_are_not_made_where_nobody_is_shown_them(
    protocol: Protocol, manifest: Manifest, video_folder: Path, tmp_path: Path
) -> None:
    with socket.socket() as other, pytest.raises(InputError, match="Is another study running"):
        other.bind(("127.0.0.1", 0))
        other.listen()
        serve(
            protocol,
            manifest,
            clips_folder=video_folder,
            data_folder=tmp_path / "data",
            announce=print,
            port=other.getsockname()[1],
        )
    assert not (tmp_path / "data" / "experimenter.json").exists()


@pytest.mark.parametrize("ill", ["missing", "a link to another folder", "changed"])
def test_clips_that_are_not_as_rendered_are_not_served(
    protocol: Protocol, manifest: Manifest, video_folder: Path, tmp_path: Path, ill: str
) -> None:
    folder = shutil.copytree(video_folder, tmp_path / "clips")
    (folder / "joy.mp4").unlink()
    if ill == "a link to another folder":
        (folder / "joy.mp4").symlink_to(video_folder / "joy.mp4")
    elif ill == "changed":
        (folder / "joy.mp4").write_bytes(b"")
    with pytest.raises(InputError, match=rf"1 of 6 clips are not there as rendered \(joy: {ill}\)"):
        serve(protocol, manifest, clips_folder=folder, data_folder=tmp_path / "data", announce=print)


def test_clips_of_an_earlier_version_are_missed_as_long_as_somebody_has_yet_to_see_them(
    site: Site, protocol: Protocol, manifest: Manifest, tmp_path: Path
) -> None:
    before = [Version(protocol.sha256, protocol, manifest)]
    require_earlier_clips(before, site.store, tmp_path)
    with (
        running(create_app(site)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        client.post("/start")
        client.post("/consent", data={"agreed": "yes", "language": "en"})
        with pytest.raises(InputError, match=r"joy: missing.*began before.*protocol\.yaml` makes them"):
            require_earlier_clips(before, site.store, tmp_path)


def test_damaged_credentials_are_said_and_half_written_ones_not_left(tmp_path: Path) -> None:
    (tmp_path / "experimenter.json").write_text("")
    with pytest.raises(InputError, match=r"experimenter.json: is damaged\. Delete it"):
        open_credentials(tmp_path)
