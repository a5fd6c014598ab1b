"""Many small writes, each on disk before it is acknowledged, for the price of few commits.

One thread writes. What comes in while a commit is on its way to the disk waits together and is the next
transaction, so that a hundred answers at once cost hardly more than one. Whoever asked for a write hears of
it only when its transaction is committed. Where one write fails, each of its transaction is tried again
alone: nobody's answer is lost for a neighbour's fault.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from queue import SimpleQueue
from typing import Any, Generic, TypeVar

from sqlalchemy import Connection, Engine, Executable

Row = Mapping[str, object]
T = TypeVar("T")

BUSY = 4  # writes in one transaction, after which the next waits for company
GATHER_S = 0.01


class Transaction:
    """What several jobs write together."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._rows: dict[Executable, list[Row]] = {}

    @property
    def db(self) -> Connection:
        """The database, with all that was added so far."""
        self.flush()
        return self._connection

    def add(self, statement: Executable, row: Row) -> None:
        """Have a statement executed with that row, together with those that other jobs add."""
        self._rows.setdefault(statement, []).append(row)

    def flush(self) -> None:
        """Execute what was added."""
        for statement, rows in self._rows.items():
            self._connection.execute(statement, rows)
        self._rows = {}


Job = Callable[[Transaction], T]  # may be run again, in another transaction


@dataclass(frozen=True)
class Task(Generic[T]):
    """Something to be written, and whoever waits for it."""

    job: Job[T]
    then: Callable[[T], object]  # once it is on disk
    done: Future[T] = field(default_factory=Future)

    def fulfil(self, result: T) -> None:
        """Say that it is on disk."""
        self.then(result)
        self.done.set_result(result)


class Writer:
    """The only one who writes to a database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._waiting: SimpleQueue[Task[Any] | None] = SimpleQueue()
        self.is_preparing = False  # a transaction; not while one is on its way to the disk
        self._thread = threading.Thread(target=self._run, name="writer", daemon=True)
        self._thread.start()

    def soon(self, job: Job[T], then: Callable[[T], object] = lambda _: None) -> Future[T]:
        """Have a job done in a transaction; the future has its result once that is on disk."""
        task = Task(job, then)
        task.done.set_running_or_notify_cancel()  # who stops waiting does not undo what they sent
        if not self._thread.is_alive():
            raise RuntimeError("the store is closed")
        self._waiting.put(task)
        return task.done

    def now(self, job: Job[T], then: Callable[[T], object] = lambda _: None) -> T:
        """Have a job done, and wait for it."""
        return self.soon(job, then).result()

    def close(self) -> None:
        """Write what is waiting, and end."""
        self._waiting.put(None)
        self._thread.join()

    def _run(self) -> None:
        waiting: list[Task[Any] | None] = []
        while None not in waiting:
            first = self._waiting.get()
            if len(waiting) >= BUSY:
                time.sleep(GATHER_S)
            waiting = [first]
            while not self._waiting.empty():
                waiting.append(self._waiting.get())
            self._write([task for task in waiting if task is not None])

    def _write(self, tasks: list[Task[Any]]) -> None:
        try:
            with self._engine.begin() as db:
                results = self._prepare(Transaction(db), tasks)
        except Exception as err:
            if len(tasks) == 1:
                tasks[0].done.set_exception(err)
                return
            for task in tasks:
                self._write([task])
        else:
            for task, result in zip(tasks, results, strict=True):
                task.fulfil(result)

    def _prepare(self, transaction: Transaction, tasks: list[Task[Any]]) -> list[Any]:
        """Do the jobs; what they give."""
        self.is_preparing = True
        try:
            results = [task.job(transaction) for task in tasks]
            transaction.flush()
        finally:
            self.is_preparing = False
        return results
