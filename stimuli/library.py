"""A folder of clips kept complete: what is missing is rendered, what is there is not.

A clip's name is the hash of everything its picture depends on, so a changed stimulus has another name and an
unchanged one is found. A run that was stopped is taken up where it stopped: a clip appears only when it is
whole, and the manifest is written after each.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from stimuli.backends import backends
from stimuli.filming import Filmed
from stimuli.manifest import Clip, Framing, Manifest
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec
from stimuli.whole_files import sweep

AUTO = "auto"


@dataclass(frozen=True)
class Progress:
    """How far a run is: said at its start, after each clip, and as frames are drawn."""

    done: int  # clips
    total: int
    stimulus: str | None = None  # the one just finished
    under_way: float = 0.0  # of further clips, together


def render_missing(
    specs: Sequence[StimulusSpec],
    robots: Mapping[str, Robot],
    folder: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Manifest:
    """Render the clips the folder does not have, and return the folder's manifest.

    One worker a core of this machine, or the workers of the Dask cluster whose scheduler has that address.
    """
    backends(os.environ)  # a wrong one is said before MuJoCo is imported, which would fail
    folder.mkdir(parents=True, exist_ok=True)
    sweep(folder)
    manifest = Manifest.load(folder)
    framing, specs = _framed(specs, robots, manifest.framing)
    known = {clip.spec_sha256: clip for clip in (*manifest.unused, *manifest.stimuli.values())}
    wanted = {spec.sha256 for spec in specs}
    unused = tuple(c for s, c in known.items() if s not in wanted and (folder / c.file).is_file())
    whole = {s: known[s] for s in wanted if s in known and known[s].is_whole(folder)}
    missing = {spec.sha256: spec for spec in specs if spec.sha256 not in whole}
    told = progress or (lambda _: None)
    told(Progress(0, len(missing)))

    def listed() -> Manifest:
        return Manifest(
            stimuli={s.id: _as(s, whole[s.sha256], folder) for s in specs if s.sha256 in whole},
            framing=framing,
            unused=unused,
        )

    done = 0
    for clip, under_way in _filmed(list(missing.values()), robots, folder, workers, scheduler):
        if clip:
            done += 1
            whole[clip.spec_sha256] = clip
            listed().save(folder)
        told(Progress(done, len(missing), clip.spec["id"] if clip else None, under_way))
    if listed() != manifest:
        listed().save(folder)
    return listed()


def _filmed(
    specs: Sequence[StimulusSpec],
    robots: Mapping[str, Robot],
    folder: Path,
    workers: int | None,
    scheduler: str | None,
) -> Iterator[Filmed]:
    """Clips as they are finished, made where they are to be made."""
    if not specs:
        return iter(())
    if scheduler:
        from stimuli.cluster import film_on_cluster

        return film_on_cluster(specs, robots, folder, scheduler)
    from stimuli.workers import film_here

    return film_here(specs, robots, folder, workers=min(workers or os.cpu_count() or 1, len(specs)))


def _framed(
    specs: Sequence[StimulusSpec], robots: Mapping[str, Robot], known: Mapping[str, Framing]
) -> tuple[dict[str, Framing], list[StimulusSpec]]:
    """The specs with `auto` replaced by the camera that suits all of the same robot."""
    framing: dict[str, Framing] = {}
    for name in dict.fromkeys(spec.robot for spec in specs if spec.video.camera == AUTO):
        shown = [spec for spec in specs if spec.robot == name and spec.video.camera == AUTO]
        key = hashlib.sha256("".join(sorted(spec.sha256 for spec in shown)).encode()).hexdigest()
        framing[name] = (
            known[name]
            if name in known and known[name].stimuli_sha256 == key
            else Framing(stimuli_sha256=key, camera=_closest_camera(shown, robots[name]))
        )
    return framing, [
        spec.model_copy(
            update={"video": spec.video.model_copy(update={"camera": framing[spec.robot].camera})}
        )
        if spec.video.camera == AUTO
        else spec
        for spec in specs
    ]


def _closest_camera(specs: Sequence[StimulusSpec], robot: Robot) -> str:
    """The closest preset in which no motion leaves the frame."""
    from stimuli.framing import closest_camera
    from stimuli.motion import generate, learn

    lessons = {
        (gesture, learning): learn(gesture, robot, learning)
        for gesture, learning in {(spec.gesture, spec.learning) for spec in specs}
    }
    motions = [generate(spec, robot, lessons[spec.gesture, spec.learning]).trajectory for spec in specs]
    return closest_camera(robot, motions, width=specs[0].video.width, height=specs[0].video.height)


def _as(spec: StimulusSpec, clip: Clip, folder: Path) -> Clip:
    """The clip as this stimulus': another of the same picture may have been rendered.

    Its gesture's path is from the folder, so that it is the same from wherever the command was called.
    """
    gesture = Path(os.path.relpath(spec.gesture, folder)).as_posix()
    return clip.model_copy(update={"spec": spec.model_dump(mode="json") | {"gesture": gesture}})
