"""Clips from a real Dask cluster of two processes are those made here, to the byte."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from distributed import LocalCluster

from stimuli import cluster
from stimuli.errors import InputError
from stimuli.library import render_missing
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec

pytestmark = pytest.mark.xdist_group("cluster")

MakeSpec = Callable[..., StimulusSpec]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0") as running:
        yield running.scheduler_address


def test_a_cluster_makes_the_same_bytes(
    study: list[StimulusSpec], pepper: Robot, address: str, tmp_path: Path
) -> None:
    there = render_missing(study, {"pepper": pepper}, tmp_path / "there", scheduler=address)
    here = render_missing(study, {"pepper": pepper}, tmp_path / "here", workers=1)
    assert there == here
    for clip in there.clips.values():
        assert (tmp_path / "there" / clip.file).read_bytes() == (tmp_path / "here" / clip.file).read_bytes()


def test_a_motion_the_robot_cannot_do_stops_the_cluster_with_its_reason(
    spec: MakeSpec, pepper: Robot, address: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"^wild: HeadPitch at .* limit"):
        render_missing([spec("wild", exa=9)], {"pepper": pepper}, tmp_path, scheduler=address)
    assert not list(tmp_path.glob("*.mp4"))


def test_a_cluster_with_other_software_is_refused(
    spec: MakeSpec, pepper: Robot, address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "MOTION", "motion/0")
    with pytest.raises(
        InputError, match=r"has motion motion/\d+ \(here motion/0\), so its clips would differ"
    ):
        render_missing([spec("one")], {"pepper": pepper}, tmp_path, scheduler=address)


def test_what_is_no_address_of_a_scheduler_is_said_at_once(
    spec: MakeSpec, pepper: Robot, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"--scheduler 10\.0\.0\.1: .* such as tcp://10\.0\.0\.1:8786"):
        render_missing([spec("one")], {"pepper": pepper}, tmp_path, scheduler="10.0.0.1")


def test_a_scheduler_that_is_not_there_is_named(
    spec: MakeSpec, pepper: Robot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    with pytest.raises(InputError, match=r"--scheduler tcp://127\.0\.0\.1:9: no Dask scheduler answers"):
        render_missing([spec("one")], {"pepper": pepper}, tmp_path, scheduler="tcp://127.0.0.1:9")
