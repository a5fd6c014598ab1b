"""When as many as planned have completed, the study closes itself, politely and once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from study.protocol import ProtocolError, load_protocol
from study.simulation import take_part
from study.web.app import create_app
from study.web.server import running
from study.web.site import Clip, Site

ATTENTIVE = {"attentive": 1.0}


def planned(site: Site, rules: str) -> Site:
    """The study for so many, with clips that take no time."""
    file = site.protocol.path
    written = file.read_text(encoding="utf-8").replace("planned: 4", rules)
    file.write_text(written, encoding="utf-8")
    clips = {name: Clip(Path("/nowhere"), name * 8, size=0, duration_s=0.0) for name in site.protocol.stimuli}
    return replace(site, protocol=load_protocol(file), clips=clips)


def test_the_study_closes_when_the_last_planned_has_completed(site: Site) -> None:
    site = planned(site, "planned: 2")
    with running(create_app(site)) as address, httpx.Client(base_url=address, follow_redirects=True) as late:
        take_part(site, address, 1, ATTENTIVE)
        assert site.store.phase == "open"
        assert "agree" in late.post("/start").text, "somebody is reading the consent"
        take_part(site, address, 2, ATTENTIVE)
        assert site.store.phase == "closed"
        refused = late.post("/consent", data={"agreed": "yes", "language": "en"})
        assert refused.status_code == 200
        assert "Nobody can begin any more. Thank you for your interest." in refused.text
        assert "nobody can begin any more" in httpx.get(address).text
        assert sum(person.session is not None for person in site.store.progress()) == 2

        site.store.enter_phase("open", now=site.clock())
        take_part(site, address, 3, ATTENTIVE)
        assert site.store.phase == "open", "opened again by hand, it is closed by hand"


def test_closed_is_kept_when_the_server_starts_again(site: Site) -> None:
    from study.storage import open_store

    site = planned(site, "planned: 1")
    with running(create_app(site)) as address:
        take_part(site, address, 1, ATTENTIVE)
    again = open_store(f"sqlite:///{site.store.file}")
    assert again.phase == "closed"
    again.close()


@pytest.mark.parametrize(
    ("rules", "kind"), [("planned: 1, stop: by hand", "participant"), ("planned: 1", "test")]
)
def test_by_hand_and_in_tests_it_stays_open(site: Site, rules: str, kind: str) -> None:
    site = replace(planned(site, rules), kind=kind)
    with running(create_app(site)) as address:
        take_part(site, address, 1, ATTENTIVE)
    assert site.store.phase == "open"


def test_other_rules_are_refused(site: Site) -> None:
    with pytest.raises(
        ProtocolError, match=r"participants.stop: 'when complet' will not do; did you mean when complete"
    ):
        planned(site, "planned: 1, stop: when complet")
