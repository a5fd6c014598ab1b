from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from analysis.alongside import alongside


def test_the_work_is_done_when_the_block_is_left(tmp_path: Path) -> None:
    with alongside((tmp_path / "work").touch):
        (tmp_path / "block").touch()
    assert {path.name for path in tmp_path.iterdir()} == {"work", "block"}


def test_a_fault_of_the_work_is_raised_here() -> None:
    def fails() -> None:
        raise OSError("no room")

    with pytest.raises(OSError, match="no room"), alongside(fails):
        pass


def test_a_fault_of_the_block_is_not_hidden_by_one_of_the_work() -> None:
    def fails() -> None:
        raise OSError("no room")

    with pytest.raises(ValueError, match="of the block"), alongside(fails):
        raise ValueError("of the block")


def test_next_to_a_thread_the_work_is_done_in_this_process() -> None:
    done, processes = threading.Event(), list[int]()
    thread = threading.Thread(target=done.wait)
    thread.start()
    try:
        with alongside(lambda: processes.append(os.getpid())):
            assert not processes
    finally:
        done.set()
        thread.join()
    assert processes == [os.getpid()]


def test_in_a_process_without_threads_the_work_is_done_by_a_copy_on_linux(tmp_path: Path) -> None:
    script = (
        "import os, sys\n"
        "from pathlib import Path\n"
        "from analysis.alongside import alongside\n"
        "with alongside(lambda: Path(sys.argv[1]).write_text(str(os.getppid()))):\n"
        "    print(os.getpid(), end='')\n"
    )
    told = tmp_path / "parent"
    ran = subprocess.run(
        [sys.executable, "-c", script, str(told)], check=True, capture_output=True, text=True
    )
    assert (told.read_text() == ran.stdout) == (sys.platform == "linux")
