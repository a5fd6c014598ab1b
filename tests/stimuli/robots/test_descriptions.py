"""Robots by name from `robot_descriptions`: here a stand-in of its layout around a real git repository."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from stimuli.errors import InputError
from stimuli.robots import load_robot

MODEL = """\
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="torso" pos="0 0 3"><freejoint/>
      <geom type="cylinder" size=".1 .2" contype="0" conaffinity="0"/>
      <body name="arm" pos="0 0 .2"><joint name="lift" axis="0 1 0" range="-60 60" limited="true"/>
        <geom type="capsule" size=".05 .2" pos="0 0 .2" contype="0" conaffinity="0"/></body>
    </body>
  </worldbody>
  <keyframe><key qpos="0 0 3 1 0 0 0 0"/></keyframe>
</mujoco>
"""
FOUND = """\
REPOSITORY_PATH = {repository!r}
PACKAGE_PATH = REPOSITORY_PATH + "/two"
MJCF_PATH = PACKAGE_PATH + "/two.xml"
"""


@pytest.fixture
def commit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The package with two descriptions: one whose repository is here, one that cannot be fetched."""
    repository = tmp_path / "repository"
    (repository / "two").mkdir(parents=True)
    (repository / "two" / "two.xml").write_text(MODEL)
    who = ["-c", "user.name=Ada", "-c", "user.email=ada@example.org"]
    for command in (["init", "-q"], ["add", "."], [*who, "commit", "-qm", "A model"]):
        subprocess.run(["git", "-C", str(repository), *command], check=True)
    package = tmp_path / "site" / "robot_descriptions"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("DESCRIPTIONS = {'two_mj_description': 1, 'far_description': 2}\n")
    (package / "two_mj_description.py").write_text(FOUND.format(repository=str(repository)))
    (package / "far_description.py").write_text("raise OSError('Could not resolve host')\n")
    for name in [name for name in sys.modules if name.partition(".")[0] == "robot_descriptions"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.syspath_prepend(package.parent)
    head = ["git", "-C", str(repository), "rev-parse", "HEAD"]
    return subprocess.run(head, check=True, capture_output=True, text=True).stdout.strip()


def test_a_description_is_found_by_name_and_its_commit_recorded(commit: str, tmp_path: Path) -> None:
    robot = load_robot("robot_descriptions/two_mj_description", tmp_path)
    assert robot.sources == (f"robot_descriptions/two_mj_description @{commit}",)
    assert robot.joint_names == ("lift",)  # the free joint is gone: nothing is simulated
    model = robot.build().compile()
    assert model.body("torso").pos[2] == pytest.approx(0.2)  # on the floor, and the model's own floor is gone
    assert model.ngeom == 2


def test_a_description_is_put_into_a_file_of_ones_own(commit: str, tmp_path: Path) -> None:
    (tmp_path / "two.yaml").write_text(
        "robot: two\ntitle: Two\nmodel: robot_descriptions/two_mj_description\n"
        "home: {lift: 0.5}\nhands: [arm]\n"
    )
    robot = load_robot("two.yaml", tmp_path)
    assert (robot.home, robot.hands) == ({"lift": 0.5}, ("arm",))
    assert robot.sources[0].endswith(commit)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("two_mj_descriptions", "is not among the robot descriptions; did you mean two_mj_description"),
        ("os", "is not among the robot descriptions"),
        ("far_description", "OSError: Could not resolve host.*ROBOT_DESCRIPTIONS_CACHE"),
    ],
)
def test_a_description_that_cannot_be_had_is_explained(
    commit: str, name: str, said: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=said):
        load_robot(f"robot_descriptions/{name}", tmp_path)


def test_without_git_or_the_package_the_message_says_what_to_install(
    commit: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as changed:
        changed.setenv("PATH", str(tmp_path))
        with pytest.raises(InputError, match="apt-get install git"):
            load_robot("robot_descriptions/two_mj_description", tmp_path)
    monkeypatch.setitem(sys.modules, "robot_descriptions", None)
    with pytest.raises(InputError, match="pip install robot_descriptions"):
        load_robot("robot_descriptions/two_mj_description", tmp_path)
