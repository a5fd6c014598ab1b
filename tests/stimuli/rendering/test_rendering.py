"""Pictures: what is drawn again equals what would be drawn in full, and nothing moves out of sight."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
import pytest

from stimuli.errors import InputError
from stimuli.framing import closest_camera
from stimuli.rendering import Renderer
from stimuli.robots import ROBOTS, load_robot
from stimuli.robots.model import Robot
from stimuli.scene import PRESETS, SHADOW, find_foot, studio
from stimuli.trajectory import Trajectory

RAISED = {"RShoulderPitch": -1.2, "RShoulderRoll": -0.3, "RElbowRoll": 0.4, "RHand": 0.98}
WIDTH, HEIGHT = 160, 90


@pytest.fixture(scope="module")
def pepper() -> Robot:
    return load_robot("pepper", Path())


@pytest.fixture(scope="module")
def renderer(pepper: Robot) -> Iterator[Renderer]:
    with Renderer(pepper, width=WIDTH, height=HEIGHT, camera="upper_body") as open_one:
        yield open_one


def path_to(robot: Robot, goal: dict[str, float], steps: int = 6) -> list[dict[str, float]]:
    return [
        {
            **robot.home,
            **{name: robot.home[name] + (value - robot.home[name]) * s for name, value in goal.items()},
        }
        for s in np.linspace(0, 1, steps).tolist()
    ]


def test_a_frame_drawn_in_part_equals_one_drawn_in_full_but_for_single_edge_samples(pepper: Robot) -> None:
    poses = path_to(pepper, RAISED)
    size = {"width": 320, "height": 180, "camera": "full_body"}
    with Renderer(pepper, **size, crop=False) as one, Renderer(pepper, **size) as other:
        for positions in poses:
            difference = np.abs(one.frame(positions).astype(int) - other.frame(positions)).max(axis=2)
            assert (difference > 0).mean() < 1e-3
            assert (difference > 8).mean() < 1e-4


def test_a_held_pose_is_not_drawn_again(renderer: Renderer, pepper: Robot) -> None:
    renderer.look_through("upper_body")
    first = renderer.frame(pepper.home)
    assert renderer.frame(dict(pepper.home)) is first


def test_pictures_do_not_depend_on_what_was_drawn_before(renderer: Renderer, pepper: Robot) -> None:
    raised = path_to(pepper, RAISED)
    pictures = []
    for _ in range(2):
        renderer.look_through("upper_body")
        pictures.append([renderer.frame(positions) for positions in raised])
    assert all(np.array_equal(one, other) for one, other in zip(*pictures, strict=True))


def test_moving_an_arm_changes_its_side_of_the_picture_only(renderer: Renderer, pepper: Robot) -> None:
    renderer.look_through("upper_body")
    home = renderer.frame(pepper.home).astype(int)
    raised = renderer.frame({**pepper.home, **RAISED})
    changed = np.abs(home - raised).max(axis=(0, 2)) > 20
    assert changed[: WIDTH // 2].any()
    assert not changed[WIDTH // 2 + 10 :].any()


def test_the_backdrop_is_grey_and_without_steps(renderer: Renderer, pepper: Robot) -> None:
    renderer.look_through("full_body")
    picture = renderer.frame(pepper.home).astype(int)
    edge = picture[:, :20]
    assert np.ptp(edge, axis=2).max() <= 2
    assert np.abs(np.diff(edge, axis=0)).max() <= 4
    assert edge.min() > 120
    assert edge.max() < 235


@pytest.mark.parametrize("name", ROBOTS)
def test_at_home_every_robot_is_whole_in_the_full_body_picture(name: str) -> None:
    robot = load_robot(name, Path())
    size = {"width": WIDTH, "height": HEIGHT}
    with Renderer(robot, **size, camera="full_body") as close, Renderer(robot, **size, camera="wide") as far:
        for renderer in (close, far):
            picture = renderer.frame(robot.home).astype(int)
            # anything that is no backdrop stays away from the top and the sides
            assert np.abs(np.diff(picture[:3], axis=1)).max() < 12
            assert np.abs(np.diff(picture[:, :8], axis=0)).max() < 12
            assert picture.std() > 5


def motion(robot: Robot, goal: dict[str, float]) -> Trajectory:
    rows = [list(positions.values()) for positions in path_to(robot, goal, 20)]
    return Trajectory(np.linspace(0, 2, 20), np.array(rows), tuple(path_to(robot, goal, 1)[0]))


def test_the_closest_camera_is_the_one_nothing_leaves(pepper: Robot) -> None:
    nod, wave = motion(pepper, {"HeadPitch": 0.3}), motion(pepper, RAISED)
    bow = motion(pepper, {"KneePitch": 0.4, "HipPitch": -0.5})
    size = {"width": WIDTH, "height": HEIGHT}
    assert closest_camera(pepper, [nod], **size) == "head"
    assert closest_camera(pepper, [nod, wave], **size) == "upper_body"
    assert closest_camera(pepper, [wave, bow], **size) == "full_body"


def test_a_robot_that_lies_down_is_framed_by_its_length_and_one_that_leaves_every_picture_is_refused() -> (
    None
):
    rod = "<body name='rod' pos='0 0 .05'>{}<geom type='box' size='.6 .05 .05'/></body>"
    joints = "<joint name='turn' axis='0 0 1'/><joint name='run' type='slide' axis='0 1 0'/>"
    spec = mujoco.MjSpec.from_string(f"<mujoco><worldbody>{rod.format(joints)}</worldbody></mujoco>")
    lying = Robot(name="rod", title="A rod", joints=(), home={"turn": 0.0, "run": 0.0}, build=spec.copy)
    size = {"width": WIDTH, "height": HEIGHT}
    assert closest_camera(lying, [motion(lying, {"turn": 3.0})], **size) == "full_body"
    with pytest.raises(InputError, match="camera: auto: A rod moves out of every picture"):
        closest_camera(lying, [motion(lying, {"run": 9.0})], **size)


def test_presets_go_from_close_to_far() -> None:
    heights = [top - bottom for bottom, top in PRESETS.values()]
    assert heights == sorted(heights)


def test_a_robot_on_two_feet_stands_in_one_shadow_that_stays_when_it_moves() -> None:
    legs = "".join(
        f"<body pos='0 {y} 0'><joint name='{leg}' axis='0 1 0'/><geom type='box' size='.1 .04 .5'/></body>"
        for leg, y in (("left", 0.2), ("right", -0.2))
    )
    spec = mujoco.MjSpec.from_string(
        f"<mujoco><worldbody><body pos='0 0 .5'>{legs}</body></worldbody></mujoco>"
    )
    home = {"left": 0.0, "right": 0.0}
    biped = Robot(name="biped", title="", joints=(), home=home, build=spec.copy)
    foot = find_foot(spec.compile(), biped)
    assert (foot.link, foot.radius) == ("world", pytest.approx(0.24))
    np.testing.assert_allclose(foot.middle, 0, atol=1e-6)
    assert studio(biped, width=WIDTH, height=HEIGHT).geom(SHADOW).bodyid == 0
