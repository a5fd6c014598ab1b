"""Processes that film one clip at a time, and are watched: one that dies or falls silent is replaced."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
import traceback
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from pathlib import Path

from stimuli.errors import InputError
from stimuli.filming import Filmed, render_clip
from stimuli.manifest import Clip
from stimuli.robots.model import Robot
from stimuli.spec import StimulusSpec
from stimuli.whole_files import sweep

ATTEMPTS = 2  # a clip whose worker died or hung is tried once more
Clock = Callable[[], float]  # seconds since whenever
SILENCE_S = 180.0  # without a new frame, after which a worker counts as hanging


def film_here(
    specs: Sequence[StimulusSpec],
    robots: Mapping[str, Robot],
    folder: Path,
    *,
    workers: int,
    silence_s: float = SILENCE_S,
    clock: Clock = time.monotonic,
) -> Iterator[Filmed]:
    """Clips as they are finished. Those whose workers failed twice are named when all others are done."""
    left, failures = deque(specs), Counter[str]()
    lost: dict[str, str] = {}
    team: list[Worker] = []
    try:
        while left or team:
            while left and len(team) < workers:
                team.append(Worker(robots, folder, clock, alone=workers == 1))
                team[-1].film(left.popleft())
            wait([worker.answers for worker in team], timeout=1.0)
            for worker in list(team):
                outcome = worker.look(silence_s)
                if outcome is None:
                    continue
                if isinstance(outcome, Clip):
                    worker.share = 0.0
                    yield outcome, sum(other.share for other in team)
                    if left:
                        worker.film(left.popleft())
                        continue
                elif failures[worker.spec.id] + 1 < ATTEMPTS:
                    failures[worker.spec.id] += 1
                    left.append(worker.spec)
                else:
                    lost[worker.spec.id] = outcome
                worker.end()
                team.remove(worker)
            yield None, sum(worker.share for worker in team)
    finally:
        for worker in team:
            worker.end()
        sweep(folder)
    if lost:
        names = ", ".join(f"{id_} ({failure})" for id_, failure in lost.items())
        raise InputError(
            f"The process that renders failed {ATTEMPTS} times; not rendered: {names}. "
            "Is memory short? Try fewer workers, and `study doctor`."
        )


class Worker:
    """A process that films, as its parent sees it."""

    def __init__(self, robots: Mapping[str, Robot], folder: Path, clock: Clock, *, alone: bool) -> None:
        self.clock = clock
        context = multiprocessing.get_context("spawn")  # a forked process would hang in OpenGL
        self.answers, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, robots, folder, alone), daemon=True)
        self.process.start()
        theirs.close()

    def film(self, spec: StimulusSpec) -> None:
        """Begin a clip."""
        self.spec, self.share, self.heard = spec, 0.0, self.clock()
        with suppress(OSError):  # it has died, which `look` will see
            self.answers.send(spec)

    def look(self, silence_s: float) -> Clip | str | None:
        """The clip if it is finished, or why there will be none. Raises what the worker raised."""
        try:
            while self.answers.poll():
                answer: Clip | float | Exception = self.answers.recv()
                self.heard = self.clock()
                if isinstance(answer, Exception):
                    raise answer
                if isinstance(answer, Clip):
                    return answer
                self.share = answer
        except (EOFError, ConnectionError):
            return "died"
        silent = self.clock() - self.heard > silence_s
        return f"no frame for {silence_s:g} s" if silent else None

    def end(self) -> None:
        """Stop the process now, whatever it is at."""
        self.process.kill()
        self.process.join()
        self.answers.close()


def _serve(parent: Connection, robots: Mapping[str, Robot], folder: Path, alone: bool) -> None:
    """What a worker does: film what it is sent until its parent has gone. Ctrl-C is the parent's to hear."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if not alone:
        os.environ.setdefault("LP_NUM_THREADS", "0")  # software rendering without threads of its own
    with suppress(EOFError, ConnectionError):  # the parent has gone
        while True:
            spec: StimulusSpec = parent.recv()
            try:
                parent.send(render_clip(spec, robots[spec.robot], folder, lambda k, of: parent.send(k / of)))
            except InputError as error:
                parent.send(error)
            except Exception:
                parent.send(RuntimeError(f"{spec.id}:\n{traceback.format_exc()}"))
