"""Whoever began before an amendment goes on with the study as it was; who comes later sees it as it is."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from uuid import uuid4

import httpx
import pytest
from typer.testing import CliRunner

from stimuli.manifest import Clip as Rendered
from stimuli.manifest import Manifest
from study.cli import app
from study.export import codebook, rows
from study.protocol import ProtocolError, load_protocol
from study.simulation import PAGE
from study.versions import FOLDER, copy_protocol, earlier_versions, keep_version
from study.web.app import create_app
from study.web.overview import overview
from study.web.participant import questions_of, steps_of
from study.web.server import running
from study.web.site import Clip, Site, clips_of


def manifest(clips: dict[str, Clip], version: str) -> Manifest:
    """Clips of no length, told apart by their version."""
    return Manifest(
        stimuli={
            name: Rendered(
                file=clip.path.name, file_sha256=f"{version}-{name}", spec={}, spec_sha256="", frames=0,
                fps=30, duration_s=0, width=2, height=2, size_bytes=clip.size, software={}, gl_renderer="",
            )
            for name, clip in clips.items()
        }
    )  # fmt: skip


@pytest.fixture
def first(site: Site, tmp_path: Path) -> Site:
    """The study before its amendment, kept."""
    clips = manifest(site.clips, "first")
    keep_version(site.protocol, clips, tmp_path / "data")
    return replace(site, clips=clips_of(clips, tmp_path))


@pytest.fixture
def amended(first: Site, tmp_path: Path) -> Site:
    """An item and a question more on each page, the demographics gone, a text changed."""
    file = first.protocol.path
    written = file.read_text(encoding="utf-8")
    for before, more in (
        ("            hurry: {en: Hurry, de: Eile}\n", "            pride: {en: Pride, de: Stolz}\n"),
        ("[gar nicht, sehr stark]}\n", "      - text: {item: remark, text: {en: Remarks, de: Notizen}}\n"),
    ):
        written = written.replace(before, before + more)
    change = (
        f"amendments: [{{date: 2026-11-22, reason: More to rate, replaces: {first.protocol.sha256[:12]}}}]\n"
    )
    written = written.replace("How does the robot move?", "How does it move?")
    texts = "texts: {debrief: It was about speed.}\ndemographics: []\n"
    file.write_text(f"{written}{texts}{change}", encoding="utf-8")
    clips = manifest(first.clips, "amended")
    protocol = load_protocol(file)
    keep_version(protocol, clips, tmp_path / "data")
    site = replace(first, protocol=protocol, clips=clips_of(clips, tmp_path))
    return site.with_earlier(earlier_versions(protocol, tmp_path / "data"), tmp_path)


class Visitor:
    """A browser that answers every page as its version of the study asks it."""

    def __init__(self) -> None:
        self.cookies = httpx.Cookies()

    def visit(self, site: Site, pages: int = 100, *, expected: Site | None = None) -> str:
        """Take up to so many pages; gives the text of the one that is due then."""
        with (
            running(create_app(site)) as address,
            httpx.Client(base_url=address, follow_redirects=True, cookies=self.cookies) as browser,
        ):
            seen = browser.get("/study").text
            for _ in range(pages):
                if 'name="agreed"' in seen:
                    seen = browser.post("/consent", data={"agreed": "yes", "language": "en"}).text
                found = PAGE.search(seen)
                if not found:
                    break
                sent = browser.post(
                    "/study/answers", json=self._answered(json.loads(found[1]), expected or site)
                )
                assert sent.status_code == 200, sent.text
                seen = browser.get("/study").text
            self.cookies = browser.cookies
        return seen

    @staticmethod
    def _answered(page: dict[str, object], site: Site) -> dict[str, object]:
        session = site.store.session(page["participant"])
        step = next(step for step in steps_of(site, session) if step.key == page["step"])
        answers = {}
        for question in questions_of(site, step):
            answers |= question.simulate(random.Random(1))
        return {
            "id": str(uuid4()), "step": page["step"], "on_page_ms": 1,
            "answers": [{"item": item, "value": value} for item, value in answers.items()],
            "views": [
                {"role": clip["role"], "plays": 1, "played_s": 0, "duration_s": 0, "frames": 0, "dropped": 0}
                for clip in page["clips"]
            ],
        }  # fmt: skip


@pytest.fixture
def begun(first: Site) -> Iterator[Visitor]:
    """Somebody in the middle of the first part."""
    visitor = Visitor()
    with (
        running(create_app(first)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as browser,
    ):
        browser.post("/start")
        visitor.cookies = browser.cookies
    assert "What does the robot express" in visitor.visit(first, pages=4)
    yield visitor


def test_the_copy_reads_as_the_study_did(first: Site, amended: Site, tmp_path: Path) -> None:
    (earlier,) = earlier_versions(amended.protocol, tmp_path / "data")
    assert earlier.sha256 == first.protocol.sha256 == earlier.protocol.sha256
    assert {folder.name for folder in (tmp_path / "data" / FOLDER).iterdir()} == {
        first.protocol.sha256,
        amended.protocol.sha256,
    }


def test_a_copy_of_earlier_software_goes_by_its_hash_and_need_not_hold_its_robot(
    first: Site, amended: Site, tmp_path: Path
) -> None:
    kept, older = tmp_path / "data" / FOLDER / first.protocol.sha256, "0" * 64
    file = kept.rename(kept.with_name(older)) / "protocol.yaml"
    robot = tmp_path / "robots" / "arm.yaml"
    robot.parent.mkdir()
    robot.write_text("robot: arm\ntitle: An arm\nmodel: arm.urdf\n", encoding="utf-8")
    written = file.read_text(encoding="utf-8").replace("robot: pepper", f"robot: {robot}")
    file.write_text(written, encoding="utf-8")
    (version,) = earlier_versions(amended.protocol, tmp_path / "data")
    assert version.protocol.robot == str(robot)
    earlier = {version.sha256: version.protocol}
    assert list(codebook(amended.protocol, earlier=earlier)["earlier"]) == [older]
    copy_protocol(version.protocol, tmp_path / "dataset")
    assert load_protocol(tmp_path / "dataset", kept=True).robot == str(robot)
    assert list(tmp_path.rglob("arm.yaml")) == [robot]


def test_whoever_began_before_finishes_the_study_they_began(
    begun: Visitor, first: Site, amended: Site
) -> None:
    for pages in (0, 100):
        seen = begun.visit(amended, pages, expected=first)
        assert "How does the robot move?" in seen and "How does it move?" not in seen
    assert "You have reached the end" in seen and "It was about speed." not in seen
    newcomer = Visitor()
    with (
        running(create_app(amended)) as address,
        httpx.Client(base_url=address, follow_redirects=True) as browser,
    ):
        browser.post("/start")
        newcomer.cookies = browser.cookies
    seen = newcomer.visit(amended)
    assert "You have reached the end" in seen and "It was about speed." in seen

    table = list(rows(amended.store, clips=amended.clip_hashes))
    before, after = (
        [row for row in table if row["protocol_sha256"] == site.protocol.sha256] for site in (first, amended)
    )
    assert {row["item"] for row in after} - {row["item"] for row in before} == {"pride", "remark"}
    assert {row["part"] for row in before} - {row["part"] for row in after} == {"demographics"}
    assert {row["stimulus_sha256"] for row in before if row["stimulus"] == "joy"} == {"first-joy"}
    assert {row["stimulus_sha256"] for row in after if row["stimulus"] == "joy"} == {"amended-joy"}
    assert [row.state for row in overview(amended).rows] == ["completed", "completed"]
    _exported_and_analysed(first, amended)


def _exported_and_analysed(first: Site, amended: Site) -> None:
    """`study export` and `study analyse` take both versions together, and the codebook explains both."""
    folder, out = amended.protocol.folder, amended.protocol.folder / "export"
    (folder / "stimuli").mkdir()
    manifest(amended.clips, "amended").save(folder / "stimuli")
    for command in (
        ["export", folder, "--data", folder.parent / "data", "--out", out],
        ["analyse", out / "responses.csv", "--protocol", folder, "--out", out],
    ):
        done = CliRunner().invoke(app, [str(word) for word in command], catch_exceptions=False)
        assert done.exit_code == 0, done.output
    book = json.loads((out / "responses.codebook.json").read_text(encoding="utf-8"))
    assert [change["reason"] for change in book["amendments"]] == ["More to rate"]
    (earlier,) = book["earlier"].items()
    assert earlier[0] == first.protocol.sha256 and earlier[1]["demographics"] and not book["demographics"]
    asked = [
        {item["item"] for item in version["parts"]["recognition"]["items"]} for version in (earlier[1], book)
    ]
    assert asked[1] - asked[0] == {"pride", "remark"}
    results = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert results["participants"]["n"] == 2 and results["participants"]["excluded"] == []


def test_an_undeclared_change_is_refused_before_anything_is_rendered(
    begun: Visitor, first: Site, tmp_path: Path
) -> None:
    file = first.protocol.path
    file.write_text(file.read_text(encoding="utf-8").replace("seed: 1", "seed: 2"), encoding="utf-8")
    run = ["run", str(file), "--data", str(tmp_path / "data"), "--clips", str(tmp_path / "new clips")]
    refused = CliRunner().invoke(app, run).exception
    assert isinstance(refused, ProtocolError) and "has changed since participants took part" in str(refused)
    assert not (tmp_path / "new clips").exists()


def test_where_no_copy_is_kept_they_are_told_and_nothing_is_lost(begun: Visitor, amended: Site) -> None:
    without = replace(amended, earlier={})
    assert "It was changed after you began" in begun.visit(without)
    assert len(list(rows(without.store))) > 0
    assert overview(without).rows[0].state == "active"
