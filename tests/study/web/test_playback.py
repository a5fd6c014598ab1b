"""How clips are played, and what is written down of it, in a real browser."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace

import pytest
from playwright.sync_api import Page, Route, expect
from starlette.middleware.base import RequestResponseEndpoint
from starlette.requests import Request
from starlette.responses import Response

from study.export import responses_json
from study.protocol import load_protocol
from study.responses import View
from study.web.app import FOR_EVER, create_app
from study.web.server import running
from study.web.site import Site

pytestmark = pytest.mark.xdist_group("browser")
VIDEO = "{replays: 1, description: {en: A robot moves its arm., de: Ein Roboter bewegt den Arm.}}"


@pytest.fixture
def address(site: Site) -> Iterator[str]:
    """The study, with one replay of each clip."""
    file = site.protocol.path
    written = file.read_text("utf-8").replace("seed: 1", f"seed: 1\nvideo: {VIDEO}")
    file.write_text(written, encoding="utf-8")
    with running(create_app(replace(site, protocol=load_protocol(file)))) as url:
        yield url


@pytest.fixture
def hasty(page: Page) -> None:
    """Waits between tries are a tenth as long; nothing else on our pages waits."""
    page.context.add_init_script(
        "const wait = setTimeout; window.setTimeout = (then, ms) => wait(then, ms / 10);"
    )


def come_to_the_practice(visit) -> None:
    visit.skip_to(3)


def view_sent(visit, site: Site) -> View:
    """What was stored of the clip of the page, once it is answered."""
    visit.rate(3)
    visit.proceed()
    [(_, responses)] = site.store.responses("participant")
    [view] = responses[-1].submission.views
    return view


def test_every_play_is_on_record_and_replays_end_where_the_protocol_says(
    visit, page: Page, site: Site
) -> None:
    come_to_the_practice(visit)
    expect(page.get_by_label("A robot moves its arm.")).to_be_visible()
    visit.watch()
    page.get_by_role("button", name="Watch again").click()
    expect(page.locator("figure [role=status]")).to_have_text("Watched as often as is possible here")
    expect(page.locator("figure button")).to_be_hidden()
    view = view_sent(visit, site)
    assert (view.plays, view.starts, view.streamed) == (2, 2, False)
    assert view.played_s == pytest.approx(0.6, abs=0.02)
    assert view.duration_s == pytest.approx(0.6, abs=0.01)
    assert 0 < view.frames <= 18 + 1, "frames shown, by requestVideoFrameCallback; fewer on a busy machine"
    names = [happening.name for happening in view.happenings]
    assert names.count("playing") == names.count("ended") == 2
    assert names.count("first frame") == 1
    [session] = json.loads(responses_json(site.store))["sessions"]
    assert session["pages"][-1]["views"] == [view.model_dump(mode="json")], "all of it is exported"
    times = [happening.at_ms for happening in view.happenings]
    assert times == sorted(times), "by a clock that only goes forward"


def test_a_pause_a_jump_and_another_speed_are_on_record_and_gain_nothing(
    visit, page: Page, site: Site
) -> None:
    come_to_the_practice(visit)
    page.get_by_role("button", name="Play").click()
    page.evaluate("document.querySelector('video').pause()")
    page.evaluate("document.querySelector('video').currentTime = 0.59")
    page.evaluate("document.querySelector('video').playbackRate = 8")
    expect(page.get_by_role("radio").first).to_be_disabled()
    menu = "document.querySelector('video').dispatchEvent(new Event('contextmenu', { cancelable: true }))"
    assert page.evaluate(menu) is False, "the browser's own controls are in there"
    page.get_by_role("button", name="Continue the video").click()
    expect(page.locator("figure [role=status]")).to_have_text("Watched")
    view = view_sent(visit, site)
    assert view.played_s == pytest.approx(0.6, abs=0.02)
    assert (view.plays, view.starts) == (1, 1)
    names = {happening.name for happening in view.happenings}
    assert {"pause", "seek refused", "rate 8", "rate 1", "ended"} <= names


def test_neither_keys_nor_scripts_skip_the_clip(visit, page: Page) -> None:
    come_to_the_practice(visit)
    page.get_by_role("button", name="Play").click()
    page.evaluate("document.querySelector('video').currentTime = 0.59")
    page.keyboard.press("End")
    expect(page.locator("figure [role=status]")).not_to_have_text("")
    if page.locator("figure [role=status]").inner_text() == "Watched":
        assert page.evaluate("document.querySelector('video').played.end(0)") == pytest.approx(0.6, abs=0.02)
    else:
        expect(page.get_by_role("radio").first).to_be_disabled()


def test_a_clip_out_of_sight_waits(visit, page: Page, site: Site) -> None:
    come_to_the_practice(visit)
    page.get_by_role("button", name="Play").click()
    page.evaluate(
        """() => {  // headless browsers show every tab; this is what leaving one looks like from within
            Object.defineProperty(document, "hidden", { value: true, configurable: true });
            Object.defineProperty(document, "visibilityState", { value: "hidden", configurable: true });
            document.dispatchEvent(new Event("visibilitychange"));
            delete document.hidden;
            delete document.visibilityState;
        }"""
    )
    page.get_by_role("button", name="Continue the video").click()
    expect(page.locator("figure [role=status]")).to_have_text("Watched")
    view = view_sent(visit, site)
    assert {"hidden", "pause"} <= {happening.name for happening in view.happenings}


def test_what_comes_next_is_loaded_ahead(visit, page: Page) -> None:
    with page.expect_request_finished(lambda request: "/clips/" in request.url):
        visit.skip_to(2)
    visit.proceed()
    expect(page.get_by_role("button", name="Play")).to_be_enabled()
    sizes = """performance.getEntriesByType("resource").filter(({ name }) => name.includes("/clips/"))
               .map(({ transferSize }) => transferSize)"""
    assert page.evaluate(sizes) == [0], "it came from the browser's cache"


@pytest.mark.usefixtures("hasty")
def test_a_clip_that_can_not_be_loaded_whole_is_streamed(visit, page: Page, site: Site) -> None:
    def only_streams(route: Route) -> None:
        if route.request.resource_type == "media":
            route.continue_()
        else:
            route.fulfill(status=503)

    page.context.route("**/clips/*", only_streams)
    come_to_the_practice(visit)
    expect(page.get_by_role("button", name="Play")).to_be_enabled()
    visit.watch()
    assert view_sent(visit, site).streamed
    assert sum(site.store.event_counts("video_retried").values()) == 4
    assert site.store.event_counts("video_failed") == {}


@pytest.mark.usefixtures("hasty")
def test_a_clip_that_was_altered_on_its_way_is_not_shown(visit, page: Page, site: Site) -> None:
    sizes = {clip.name: clip.size for clip in site.clips.values()}
    page.context.route(
        "**/clips/*", lambda route: route.fulfill(body=bytes(sizes[route.request.url.rpartition("/")[2]]))
    )
    come_to_the_practice(visit)
    again = page.get_by_role("button", name="Try again")
    expect(again).to_be_enabled()
    assert sum(site.store.event_counts("video_failed").values()) == 1
    page.context.unroute_all()
    again.click()
    visit.watch()
    assert not view_sent(visit, site).streamed


@pytest.mark.usefixtures("hasty")
def test_a_copy_that_went_bad_in_the_browser_is_fetched_anew(visit, site: Site) -> None:
    app, spoilt, sizes = create_app(site), set(), {clip.name: clip.size for clip in site.clips.values()}

    @app.middleware("http")
    async def spoil_once(request: Request, call_next: RequestResponseEndpoint) -> Response:
        name = request.url.path.rpartition("/")[2]
        if name not in sizes or name in spoilt:
            return await call_next(request)
        spoilt.add(name)
        return Response(bytes(sizes[name]), headers=FOR_EVER)

    with running(app) as visit.address:
        come_to_the_practice(visit)
        visit.watch()
        assert not view_sent(visit, site).streamed
    assert sum(site.store.event_counts("video_retried").values()) == 1


@pytest.mark.usefixtures("hasty")
def test_a_clip_that_stalls_is_said_and_on_record(visit, page: Page, site: Site) -> None:
    held_back: list[Route] = []

    def half(route: Route) -> None:
        """The first half of a clip at once, the other half when it is let go."""
        content = next(
            clip for clip in site.clips.values() if clip.name in route.request.url
        ).path.read_bytes()
        begin = int(route.request.headers.get("range", "bytes=0-")[6:].partition("-")[0])
        if route.request.resource_type != "media":
            route.fulfill(status=503)
        elif begin and len(held_back) == 0:
            held_back.append(route)
        else:
            part = content[begin:] if begin else content[: len(content) // 2]
            headers = {
                "Content-Range": f"bytes {begin}-{begin + len(part) - 1}/{len(content)}",
                "Accept-Ranges": "bytes",
                "Content-Type": "video/mp4",
            }
            route.fulfill(status=206, body=part, headers=headers)

    page.context.route("**/clips/*", half)
    come_to_the_practice(visit)
    page.get_by_role("button", name="Play").click()
    expect(page.locator("figure [role=status]")).to_have_text("One moment, the video is loading …")
    expect(page.get_by_role("radio").first).to_be_disabled()
    half(held_back[0])
    expect(page.locator("figure [role=status]")).to_have_text("Watched")
    assert "waiting" in {happening.name for happening in view_sent(visit, site).happenings}


@pytest.mark.usefixtures("hasty")
def test_a_video_that_fails_is_said_noted_and_can_be_tried_again(visit, page: Page, site: Site) -> None:
    page.context.route("**/clips/*", lambda route: route.fulfill(status=503))
    come_to_the_practice(visit)
    expect(page.locator("figure [role=status]")).to_contain_text("could not be played")
    page.context.unroute("**/clips/*")
    page.get_by_role("button", name="Try again").click()
    visit.watch()
    assert "error" in {happening.name for happening in view_sent(visit, site).happenings}
    assert sum(site.store.event_counts("video_failed").values()) >= 1
