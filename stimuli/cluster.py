"""Clips filmed on a Dask cluster: the same code on other machines, the same bytes as here.

Nothing is shared but the network: a demonstration travels to the worker, the clip comes back. Only a robot of
the user's own needs its files under the same path on every machine.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from stimuli.errors import InputError
from stimuli.filming import Filmed, render_clip, software
from stimuli.manifest import Clip
from stimuli.robots.facts import LOOK, sources_sha256
from stimuli.robots.model import Robot
from stimuli.spec import MOTION, StimulusSpec
from stimuli.whole_files import whole_or_nothing

ADDRESS = re.compile(r"\w+://\S+|\S+:\d+")
CONNECT_S = 10
RETRIES = 1  # of a clip whose worker was lost


def film_on_cluster(
    specs: Sequence[StimulusSpec], robots: Mapping[str, Robot], folder: Path, scheduler: str
) -> Iterator[Filmed]:
    """Clips as the cluster's workers finish them, written into the folder here."""
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError as error:
        raise InputError(
            "--scheduler needs Dask: pip install 'expressive-motion-study[cluster]', here and on the workers"
        ) from error
    if not ADDRESS.fullmatch(scheduler):
        raise InputError(
            f"--scheduler {scheduler}: is no address of a scheduler; `dask scheduler` prints one, such as "
            "tcp://10.0.0.1:8786"
        )
    try:
        client = Client(scheduler, timeout=CONNECT_S, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise InputError(
            f"--scheduler {scheduler}: no Dask scheduler answers there within {CONNECT_S} s. "
            "Start one with `dask scheduler`, and give the address it prints."
        ) from error
    with client:
        _compare(client.run(fingerprint), scheduler)
        futures = [
            client.submit(
                film_there,
                spec,
                robots[spec.robot],
                spec.gesture.read_bytes(),
                pure=False,
                retries=RETRIES,
                key=f"{spec.id}-{spec.sha256[:16]}",
            )
            for spec in specs
        ]
        try:
            for future in as_completed(futures, loop=client.loop):  # type: ignore[no-untyped-call]
                clip, content = future.result()
                with whole_or_nothing(folder / clip.file) as partial:
                    partial.write_bytes(content)
                yield clip, 0.0
        except KilledWorker as error:
            raise InputError(
                f"--scheduler {scheduler}: the workers that rendered {error.task} died. "
                "Is memory short there? `study doctor` on the worker's machine looks closer."
            ) from error
        finally:
            client.cancel(futures)  # type: ignore[no-untyped-call]


def film_there(spec: StimulusSpec, robot: Robot, gesture: bytes) -> tuple[Clip, bytes]:
    """Film one clip on the machine this runs on, out of nothing but its arguments; the clip and its file."""
    with tempfile.TemporaryDirectory() as scratch:
        demonstration = Path(scratch, spec.gesture.name)
        demonstration.write_bytes(gesture)
        clip = render_clip(spec.model_copy(update={"gesture": demonstration}), robot, Path(scratch))
        content = Path(scratch, clip.file).read_bytes()
    return clip.model_copy(update={"spec": spec.model_dump(mode="json")}), content


def fingerprint() -> dict[str, str]:
    """What must be the same everywhere for clips to be the same: versions, and the code of the picture."""
    return software() | {"motion": MOTION, "studio": sources_sha256(*LOOK)[:12]}


def _compare(theirs: Mapping[str, Mapping[str, str]], scheduler: str) -> None:
    if not theirs:
        raise InputError(
            f"--scheduler {scheduler}: it has no workers. Start some with `dask worker {scheduler}`."
        )
    ours = fingerprint()
    for worker, has in theirs.items():
        other = [
            f"{name} {has.get(name)} (here {ours[name]})" for name in ours if has.get(name) != ours[name]
        ]
        if other:
            raise InputError(
                f"--scheduler {scheduler}: {worker} has {', '.join(other)}, so its clips would differ. "
                "Install the same version and requirements.lock there."
            )
