"""The server: uvicorn with this application, in the foreground for a study or in a thread for a rehearsal."""

from __future__ import annotations

import errno
import gc
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

import uvicorn
from fastapi import FastAPI

from stimuli.errors import InputError
from study.participants import Kind
from study.storage import Store, open_store
from study.storage.backups import BackupTimer, back_up
from study.versions import earlier_versions, keep_version, refuse_undeclared
from study.web.app import create_app
from study.web.clip_files import require_clips, require_earlier_clips
from study.web.credentials import Passwords, open_credentials
from study.web.site import Door, Site, clips_of, utc_now

if TYPE_CHECKING:
    from stimuli.manifest import Manifest
    from study.protocol import Protocol

SOFTWARE = f"expressive-motion-study {version('expressive-motion-study')}"
BACKUP_EVERY_S = 30 * 60
EVERYWHERE = "0.0.0.0"
ELSEWHERE = "192.0.2.1"  # of the addresses that are nobody's (RFC 5737)
GRACE_S = 5  # for requests under way when the server is told to stop
KEEP_ALIVE_S = 75  # people look at a page for longer than uvicorn's 5 s, and so do proxies at a connection
COLLECT_AFTER = 20_000  # objects; a page makes hundreds, nearly none of them in cycles


@dataclass(frozen=True)
class Links:
    """Where a running study is found."""

    participant: str
    experimenter: str
    passwords: Passwords | None  # only at the first start, when they were made


def serve(
    protocol: Protocol,
    manifest: Manifest,
    *,
    clips_folder: Path,
    data_folder: Path,
    announce: Callable[[Links], None],
    url: str | None = None,
    host: str = "127.0.0.1",
    port: int = 8000,
    kind: Kind = "participant",
    door: Door = "open",
    analyse: Callable[[Path, Path], object] | None = None,
) -> None:
    """Serve a study until Ctrl-C or SIGTERM; `announce` is called once it can be visited.

    Answers are kept in `data_folder` (SQLite), or in the database at `url`. With `kind="test"` whoever enters
    without a link is a test, kept apart from the data. `analyse` makes the report the experimenter may see.
    """
    require_clips(protocol, manifest, clips_folder)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # what stops services ends it like Ctrl-C
    store = open_store(url or f"sqlite:///{data_folder / 'study.db'}")
    backups = _backups(store, data_folder / "backups")
    with closing(store), store.held(), backups or nullcontext(), closing(_listener(host, port)) as listener:
        refuse_undeclared(protocol, store.protocol_hashes())
        keep_version(protocol, manifest, data_folder)
        earlier = list(earlier_versions(protocol, data_folder))
        require_earlier_clips(earlier, store, clips_folder)
        credentials, passwords = open_credentials(data_folder)  # last: passwords that are made are also shown
        site = Site(
            protocol,
            store,
            clips_of(manifest, clips_folder),
            credentials,
            SOFTWARE,
            kind=kind,
            door=door,
            analyse=analyse,
            backup_fault=lambda: backups.fault if backups else None,
        ).with_earlier(earlier, clips_folder)
        server = _server(create_app(site))
        address = f"http://{_reached_by(host)}:{listener.getsockname()[1]}"
        links = Links(f"{address}/", f"{address}/experimenter", passwords)
        threading.Thread(target=lambda: _when_started(server, lambda: announce(links)), daemon=True).start()
        with suppress(KeyboardInterrupt):  # uvicorn finishes what is under way and raises the signal again
            server.run(sockets=[listener])


def _reached_by(host: str) -> str:
    """What others call this machine, where it listens on all its addresses: the one by which it sends."""
    if host != EVERYWHERE:
        return host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as outward, suppress(OSError):
        outward.connect((ELSEWHERE, 9))  # which sends nothing
        return str(outward.getsockname()[0])
    return "127.0.0.1"


def _backups(store: Store, folder: Path) -> BackupTimer | None:
    """Backups of a SQLite file, now and then; other databases have means of their own."""
    database = store.file
    if database is None:
        return None
    return BackupTimer(lambda: back_up(database, folder, now=utc_now()), every_s=BACKUP_EVERY_S)


@contextmanager
def running(app: FastAPI, *, host: str = "127.0.0.1", port: int = 0) -> Iterator[str]:
    """Serve an application in a thread for as long as the block lasts; gives its address."""
    server, listener = _server(app), _listener(host, port)
    thread = threading.Thread(target=lambda: server.run(sockets=[listener]))
    thread.start()
    try:
        _when_started(server, lambda: None)
        yield f"http://{host}:{listener.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join()
        listener.close()


def _listener(host: str, port: int) -> socket.socket:
    listener = socket.socket(proto=socket.IPPROTO_TCP)  # else asyncio leaves Nagle's delay on: 40 ms a page
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, port))
    except OSError as err:
        listener.close()
        hint = " Is another study running?" if err.errno == errno.EADDRINUSE else ""
        raise InputError(f"--host {host} --port {port}: {err.strerror}.{hint}") from err
    return listener


def _server(app: FastAPI) -> uvicorn.Server:
    config = uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,  # addresses hold tokens
        server_header=False,
        timeout_graceful_shutdown=GRACE_S,
        timeout_keep_alive=KEEP_ALIVE_S,
    )
    gc.freeze()  # what is loaded by now stays: collections under load need not look through it again
    gc.set_threshold(COLLECT_AFTER)
    server = uvicorn.Server(config)
    app.state.is_stopping = lambda: server.should_exit
    return server


def _when_started(server: uvicorn.Server, then: Callable[[], None]) -> None:
    while not server.started and not server.should_exit:
        time.sleep(0.01)
    if server.started:
        then()
