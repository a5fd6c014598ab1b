"""Gestures from files, well and badly written."""

from __future__ import annotations

import time

import numpy as np
import pytest

from stimuli.errors import InputError
from stimuli.gestures import READERS, read_gesture

KEYFRAMES = """
gesture: lift
robot: toy
title: {en: Lift}
unit: deg
duration: 2.0 s
joints:
  Shoulder: {0.2: home, 1.0: 60, 1.4: 60, 2.0: home}
  Hand: {0.0: home, 1.0: 0.9}
"""

QIANIM = """<?xml version="1.0" encoding="utf-8"?>
<Animation typeVersion="2.0" xmlns:editor="{namespace}">
  <ActuatorCurve actuator="Elbow" mute="0" unit="degree" fps="25">
    <Key frame="25" value="0">
      <Tangent side="right" abscissaParam="10" ordinateParam="0" editor:interpType="bezier"/></Key>
    <Key frame="50" value="90">
      <Tangent side="left" abscissaParam="-10" ordinateParam="0" editor:interpType="bezier"/></Key>
  </ActuatorCurve>
  <ActuatorCurve actuator="Hand" mute="false" unit="dimensionless" fps="25.0">
    <Key frame="30" value="0.2"/><Key frame="50" value="0.8"/>
  </ActuatorCurve>
  <ActuatorCurve actuator="Hip" mute="1" unit="degree" fps="25"><Key frame="0" value="5"/></ActuatorCurve>
</Animation>
"""


def written(folder, name, text):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_keyframes_pass_through_their_keys_and_rest_at_both_ends(tmp_path, robot):
    shown = read_gesture(written(tmp_path, "lift.yaml", KEYFRAMES), robot)
    assert shown.joints == robot.joint_names
    assert shown.duration_s == pytest.approx(2.0)
    at = shown.at(np.array([0.0, 0.2, 1.0, 1.2, 1.4, 2.0]))[:, 2]
    assert at == pytest.approx([0.1, 0.1, *[np.pi / 3] * 3, 0.1], abs=1e-6)
    assert np.all(shown.joint("Elbow") == 0.1)
    acceleration = np.diff(shown.positions, 2, axis=0) / 0.01**2
    assert np.abs(np.diff(acceleration, axis=0)).max() < 0.05 * np.abs(acceleration).max() * 4
    assert np.abs(shown.positions[1] - shown.positions[0]).max() < 1e-4
    assert shown.joint("Hand").max() <= 0.9 + 1e-12


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("Shoulder", "Sholder", r":8: toy has no joint 'Sholder'; did you mean Shoulder\?"),
        (
            "1.0: 60",
            "1.0: 300",
            r":8: joints.Shoulder: 300 at 1 s is outside the joint's range, -171.9 to 171.9 deg",
        ),
        (
            "2.0: home}",
            "2.5: home}",
            r":8: joints.Shoulder: a key at 2.5 s; keys lie from 0 to the duration, 2 s",
        ),
        ("duration: 2.0 s", "duration: -2 s", r":6: duration: .*greater than 0"),
        ("unit: deg", "unti: deg", r":5: unti: is no field here; did you mean unit\?"),
        ("unit: deg", "unit: degrees", r":5: unit: 'degrees' must be deg or rad"),
        ("1.4: 60", "1.4: 60 deg", r":8: joints.Shoulder.1.4: '60 deg' must be a number without a unit"),
        ("1.4: 60", "1.4: .nan", r":8: joints.Shoulder.1.4: nan must be a number"),
        ("gesture: ", "gestur: ", r": gesture: is missing\n.*:2: gestur: is no field"),
        ("duration: 2.0 s", "duration: {", r"not readable as YAML"),
        ("duration: 2.0 s", "duration: " + "[" * 5000, r"not readable as YAML"),
        ("duration: 2.0 s", "duration: 1e15", r":6: duration: the gesture lasts 1e\+15 s"),
        ("robot: toy", "robot: iiwa14", r":3: robot: the gesture is for iiwa14, not toy"),
        ("Hand:", "Shoulder:", r":9: Shoulder stands there twice, first in line 8; keep one"),
        ("unit: deg", "robot: toy", r":5: robot stands there twice, first in line 3"),
        ("1.4: 60", "1: 50", r":8: joints.Shoulder: two keys lie at one time"),
        ("1.4: 60", "1 s: 50", r":8: joints.Shoulder: two keys lie at one time"),
    ],
)
def test_a_bad_keyframe_file_is_refused_at_its_line(old, new, message, tmp_path, robot):
    path = written(tmp_path, "lift.yaml", KEYFRAMES.replace(old, new))
    with pytest.raises(InputError, match=message) as error:
        read_gesture(path, robot)
    assert str(path) in str(error.value)


@pytest.mark.parametrize(
    "host",
    ["http://www.aldebaran.com/animation/editor", "http://www.ald.softbankrobotics.com/animation/editor"],
)
def test_an_animation_comes_from_home_to_its_first_keys_and_follows_its_curves(host, tmp_path, robot):
    shown = read_gesture(written(tmp_path, "a.qianim", QIANIM.format(namespace=host)), robot)
    assert shown.duration_s == pytest.approx(2.0)  # from frame 0 to the last key
    elbow, hand = shown.joint("Elbow"), shown.joint("Hand")
    assert elbow[[0, 100, 200]] == pytest.approx([robot.home["Elbow"], 0, np.pi / 2])
    assert abs(elbow[1] - elbow[0]) < 1e-3  # at rest at home
    assert elbow[150] == pytest.approx(np.pi / 4)  # symmetric
    assert np.all(np.diff(elbow[100:]) > 0)
    assert elbow[101] < 1e-3  # flat tangents
    assert hand[0] == pytest.approx(robot.home["Hand"])
    assert hand[[120, 160]] == pytest.approx([0.2, 0.5])  # without tangents: straight
    assert np.all(shown.joint("Hip") == 0.1)  # muted


def test_a_bezier_piece_is_the_curve_it_says(tmp_path, robot):
    """Handles of a third of the way, in time and value, make a straight line; cubic ones make the cubic."""
    text = QIANIM.format(namespace="x").replace('abscissaParam="10"', 'abscissaParam="8.3333333333"')
    text = text.replace('abscissaParam="-10"', 'abscissaParam="-8.3333333333"')
    elbow = read_gesture(written(tmp_path, "a.qianim", text), robot).joint("Elbow")[100:]
    s = np.linspace(0, 1, 101)
    assert elbow == pytest.approx(np.pi / 2 * (3 * s**2 - 2 * s**3), abs=1e-8)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<Animation>", ":1: not readable as XML"),
        ("<Animation/>", "no ActuatorCurve with keys"),
        ("<!DOCTYPE a><Animation/>", "document type"),
        (QIANIM.replace('"Elbow"', '"Elbw"'), "no joint 'Elbw'; did you mean Elbow"),
        (QIANIM.replace('frame="25"', 'frame="x"'), "frame='x'; a number is needed"),
        (QIANIM.replace('frame="25"', 'frame="nan"'), "frame='nan'; a number is needed"),
        (QIANIM.replace('frame="25"', 'frame="inf"'), "frame='inf'; a number is needed"),
        (QIANIM.replace('frame="50"', 'frame="1e12"'), r"lasts 4e\+10 s; .* at most 600 s"),
        (QIANIM.replace('value="90"', 'value="nan"'), "value='nan'; a number is needed"),
        (QIANIM.replace('"Hand"', '"Elbow"'), r"Elbow stands there twice; keep one of them"),
        (QIANIM.replace('unit="degree" fps', 'unit="gon" fps'), "unit 'gon'"),
    ],
)
def test_a_bad_animation_is_refused(text, message, tmp_path, robot):
    with pytest.raises(InputError, match=message):
        read_gesture(written(tmp_path, "a.qianim", text.replace("{namespace}", "x")), robot)


def test_uneven_unsorted_and_repeated_samples_give_the_motion_they_come_from(tmp_path, robot):
    rng = np.random.default_rng(1)
    t = np.concatenate([[0.0, 2.0], rng.uniform(0, 2, 180)])
    t = np.concatenate([t, t[5:25]])
    rows = [f"{a},{np.degrees(np.sin(a) ** 2)},{0.5 + 0.1 * np.sin(a)}" for a in t]
    text = "time,Waist [deg],Hand\n" + "\n".join(rows)
    shown = read_gesture(written(tmp_path, "s.csv", text), robot)
    assert shown.joint("Waist") == pytest.approx(np.sin(shown.times) ** 2, abs=2e-3)
    assert shown.joint("Hand") == pytest.approx(0.5 + 0.1 * np.sin(shown.times), abs=2e-4)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (",", ":1: the first column is 'time'"),
        ("time,Wiast\n0,1\n1,2", ":1: toy has no joint 'Wiast'; did you mean Waist"),
        ("time,Waist\n0,1\n1,x", ":3: .*every cell is a number"),
        ("time,Waist\n0,1\n1", ":3: 1 cells; the header has 2"),
        ("time,Waist\n0,1\n0,2", "at least two at different times"),
        ("time,Waist\n0,1\n1,nan", "not finite"),
        ("time,Waist,Waist [deg]\n0,1,1\n1,2,2", ":1: Waist stands there twice"),
        ("time,Waist [mm]\n0,1\n1,2", ":1: Waist has no unit 'mm'. Known: rad, deg"),
        ("time,Hand [deg]\n0,1\n1,2", ":1: Hand has no unit 'deg'. Known: 1"),
        ("time [h],Waist\n0,1\n1,2", r":1: the first column is 'time' in s, or 'time \[ms\]'"),
        ("time,Waist\n0,1\n3000,2", r"span 3000 s, .* If these are ms, head the column 'time \[ms\]'"),
        ("time [ms],Waist\n0,1\n3000000,2", "lasts 3000 s"),
    ],
)
def test_bad_samples_are_refused_at_their_line(text, message, tmp_path, robot):
    with pytest.raises(InputError, match=message):
        read_gesture(written(tmp_path, "s.csv", text), robot)


@pytest.mark.parametrize("unit", ["deg", "Deg", "degrees", "degree", "°"])
def test_columns_may_say_their_unit(unit, tmp_path, robot):
    text = f"time [ms],Waist [{unit}],Hip [rad],Elbow\n0,0,0,0.1\n500,45,0.5,0.1\n1000,90,1,0.1\n"
    shown = read_gesture(written(tmp_path, "s.csv", text), robot)
    assert shown.duration_s == pytest.approx(1.0)
    assert shown.joint("Waist")[-1] == pytest.approx(np.pi / 2)
    assert shown.joint("Hip")[-1] == pytest.approx(1.0)
    assert np.all(shown.joint("Elbow") == 0.1)


def test_what_is_no_gesture_is_refused(tmp_path, robot):
    with pytest.raises(InputError, match=r"'\.txt' is no gesture format\. Known: .*\.qianim"):
        read_gesture(tmp_path / "a.txt", robot)
    with pytest.raises(InputError, match="no such file"):
        read_gesture(tmp_path / "a.yaml", robot)
    assert {".yaml", ".csv", ".qianim"} <= set(READERS)


@pytest.mark.parametrize("suffix", sorted(READERS))
@pytest.mark.parametrize(("content", "message"), [("", "is empty"), ("x" * 10**7, "is larger than")])
def test_an_empty_and_a_huge_file_are_refused_at_once(suffix, content, message, tmp_path, robot):
    started = time.process_time()
    with pytest.raises(InputError, match=rf"a\{suffix}: {message}"):
        read_gesture(written(tmp_path, f"a{suffix}", content), robot)
    assert time.process_time() - started < 1


CHOREGRAPHE = """# Choregraphe bezier export in Python.
from naoqi import ALProxy
names = list()
times = list()
keys = list()

names.append("Elbow")
times.append([1.0, 2.0])
keys.append([[0, [3, -0.3, 0], [3, 0.3333333333333333, 0]], [1.5, [3, -0.3333333333333333, 0], [3, 0, 0]]])

names.append("Hand")
times.append([1.0, 2.0])
keys.append([0.2, 0.8])

try:
  motion = ALProxy("ALMotion")
  motion.angleInterpolationBezier(names, times, keys)
except BaseException, err:
  print err
"""


def test_a_choregraphe_export_is_read_and_never_executed(tmp_path, robot):
    shown = read_gesture(written(tmp_path, "export.py", CHOREGRAPHE), robot)
    s = np.linspace(0, 1, 101)
    elbow, hand = shown.joint("Elbow"), shown.joint("Hand")
    assert elbow[100:] == pytest.approx(1.5 * (3 * s**2 - 2 * s**3), abs=1e-8)
    assert hand[100:] == pytest.approx(0.2 + 0.6 * s)
    assert [elbow[0], hand[0]] == [robot.home["Elbow"], robot.home["Hand"]]  # as the robot gets there
    assert abs(hand[1] - hand[0]) < 1e-3


def test_animations_and_exports_of_the_same_keys_are_the_same_gesture(tmp_path, robot):
    animation = (
        '<Animation><ActuatorCurve actuator="Hand" unit="dimensionless" fps="25">'
        '<Key frame="10" value="0.2"/><Key frame="50" value="0.8"/></ActuatorCurve></Animation>'
    )
    export = 'names = ["Hand"]\ntimes = [[0.4, 2.0]]\nkeys = [[0.2, 0.8]]\n'
    one, other = (
        read_gesture(written(tmp_path, name, text), robot).joint("Hand")
        for name, text in (("a.qianim", animation), ("a.py", export))
    )
    assert one == pytest.approx(other, abs=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[0.2, 0.8]", "[open('x'), 0.8]", r":13: \[open\('x'\), 0.8\] is no literal; nothing is executed"),
        ('names.append("Hand")', "", "1 names, 2 times, 2 keys"),
        ("[0.2, 0.8]", "[0.2]", "not lists of one length"),
        ("[0.2, 0.8]", "[0.2, 'x']", "key 'x' at 2.0 is no angle"),
        ("names = list()", "names = (", "not readable as Python"),
        ('"Elbow"', '"Elbw"', "did you mean Elbow"),
        ('"Hand"', '"Elbow"', r"export\.py: Elbow stands there twice"),
        ("[1.0, 2.0]", "[1.0, 1e999]", "key .* at inf is no angle"),
        ("[1.0, 2.0]", "[1.0, 1" + "0" * 400 + "]", "is no angle"),
        ("[1.0, 2.0]", "[1.0, 1e12]", r"lasts 1e\+12 s; .* at most 600 s"),
        ("[0.2, 0.8]", "-" * 100_000 + "1", "not readable as Python"),
        ("[0.2, 0.8]", "-" * 900 + "1", r":\d+: too deeply nested"),
    ],
)
def test_a_bad_export_is_refused(old, new, message, tmp_path, robot):
    with pytest.raises(InputError, match=message):
        read_gesture(written(tmp_path, "export.py", CHOREGRAPHE.replace(old, new)), robot)
