"""Two pieces of work at once, on two cores."""

from __future__ import annotations

import os
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def alongside(work: Callable[[], None]) -> Iterator[None]:
    """Do some work in a copy of this process, while this one does what stands in the block.

    The copy begins with all that is in memory, so nothing is imported or computed for it again; it ends with
    its work, and what it changes in memory is lost. Where processes cannot be copied safely – outside Linux,
    or next to threads, whose locks nobody would open in the copy – the work is done after the block; also
    where the copy failed, so that faults are raised as ever.
    """
    copy = None
    if sys.platform == "linux" and threading.active_count() == 1:
        # newer Pythons warn of all threads, of BLAS's too, which end by themselves before a fork
        with warnings.catch_warnings(action="ignore", category=DeprecationWarning):
            copy = os.fork()
    if copy == 0:
        _end_with(work)
    done = False
    try:
        yield
    finally:
        if copy is not None:
            _, status = os.waitpid(copy, 0)
            done = status == 0
    if not done:
        work()


def _end_with(work: Callable[[], None]) -> None:
    """Do the work and end the process at once: whatever else is done at an end is for its parent to do."""
    status = 1
    try:
        work()
        status = 0
    finally:
        os._exit(status)
