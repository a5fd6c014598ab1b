"""Where nothing can be stored nothing is acknowledged, it is said, and it goes on once there is room."""

from __future__ import annotations

import os
import resource
from dataclasses import replace
from uuid import uuid4

import httpx
import pytest

from stimuli.errors import InputError
from study.storage import open_store
from study.web.app import create_app
from study.web.security import HEADERS
from study.web.server import running
from study.web.site import Site


def sent(step: str) -> dict[str, object]:
    return {"id": str(uuid4()), "step": step, "on_page_ms": 1.0}


def begin(client: httpx.Client) -> None:
    client.post("/start")
    assert client.post("/consent", data={"agreed": "yes", "language": "en"}).status_code == 200


def see_it_refused(client: httpx.Client, submission: dict[str, object]) -> None:
    """Neither answers nor newcomers are taken; both are told."""
    for _ in range(2):
        refused = client.post("/study/answers", json=submission)
        assert (refused.status_code, refused.json()) == (503, {"reason": "cannot be stored now"})
        assert int(refused.headers["retry-after"]) > 0
    newcomer = httpx.post(f"{client.base_url}/start")
    assert newcomer.status_code == 503
    assert "Nothing can be stored at the moment" in newcomer.text


def see_it_taken(client: httpx.Client, submission: dict[str, object]) -> None:
    """The same answer is taken now, and so are others."""
    assert client.post("/study/answers", json=submission).status_code == 200
    assert "Before we start" in client.get("/study").text
    assert client.post("/study/answers", json=sent("instructions:practice")).status_code == 200


def stored(site: Site) -> list[str]:
    return [
        str(response.submission.id)
        for _, responses in site.store.responses("participant")
        for response in responses
    ]


def test_on_a_full_disk_no_answer_is_acknowledged_and_none_is_lost(site: Site) -> None:
    submission = sent("demographics")
    with (
        running(create_app(site)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        begin(client)
        most = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, most[1]))  # no file may grow: as if the disk were full
        try:
            see_it_refused(client, submission)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, most)
        see_it_taken(client, submission)
    assert stored(site).count(str(submission["id"])) == 1
    assert len(stored(site)) == 2


def test_a_postgresql_that_is_away_for_a_while_is_found_and_held_again(
    postgresql, site: Site, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    submission = sent("demographics")
    url = postgresql.new_database()
    store, other = open_store(url), open_store(url)
    away = replace(site, store=store)
    with (
        store.held(),
        running(create_app(away)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        begin(client)
        postgresql.stop()
        try:
            see_it_refused(client, submission)
        finally:
            postgresql.start()
        with other.held():  # another server was quicker
            see_it_refused(client, submission)
        see_it_taken(client, submission)
        with pytest.raises(InputError, match=f"served by study: process {os.getpid()}"), other.held():
            pass
    assert len(stored(away)) == 2
    store.close()
    other.close()
    assert "Nothing can be stored: " in caplog.text
    assert str(submission["id"]) not in caplog.text + capfd.readouterr().err
    assert "Traceback" not in caplog.text


def test_a_fault_of_ours_is_not_called_one_of_the_disk(site: Site) -> None:
    app = create_app(site)

    @app.get("/fault")
    def fault() -> None:
        raise InputError("joint 'Elbow' is not known")

    with running(app) as address:
        told = httpx.get(f"{address}/fault")
    assert told.status_code == 500
    assert "What you sent before is safe" in told.text and "Elbow" not in told.text
    assert {name: told.headers[name] for name in HEADERS} == HEADERS


def test_what_postgresql_cannot_keep_is_refused(postgresql, site: Site) -> None:
    store = open_store(postgresql.new_database())
    with (
        running(create_app(replace(site, store=store))) as address,
        httpx.Client(base_url=address, follow_redirects=True) as client,
    ):
        begin(client)
        event = {"name": "video_failed", "detail": "a\0b"}
        assert client.post("/study/events", json=event).status_code == 400
        assert client.post("/code", data={"code": "a\0b"}).status_code == 404
        assert httpx.post(f"{address}/withdraw", data={"sure": "yes", "code": "a\0b"}).status_code == 400
        assert client.post("/study/answers", json=sent("demographics")).status_code == 200
    store.close()
