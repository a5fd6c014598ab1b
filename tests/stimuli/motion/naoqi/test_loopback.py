"""Motions reach an ALMotion over a real qi session on this machine."""

from collections.abc import Iterator

import numpy as np
import pytest
import qi

from stimuli.export.naoqi import APPROACH_S, send


class Motion:
    """What ALMotion does here: it keeps what it is sent."""

    def __init__(self) -> None:
        self.moves: list[tuple] = []

    def angleInterpolation(self, names, angles, times, absolute):  # noqa: N802
        self.moves.append((names, angles, times, absolute))


@pytest.fixture
def robot_motion() -> Iterator[tuple[Motion, str]]:
    motion, server = Motion(), qi.Session()
    server.listenStandalone("tcp://127.0.0.1:0")
    server.registerService("ALMotion", motion)
    yield motion, server.endpoints()[0]
    server.close()


def test_a_motion_arrives_over_the_wire(robot_motion, demonstrate) -> None:
    motion, address = robot_motion
    session = qi.Session()
    session.connect(address)
    shown = demonstrate(2)
    send(shown, session.service("ALMotion"))
    session.close()
    ((names, angles, times, absolute),) = motion.moves
    assert list(names) == list(shown.joints)
    assert absolute is True
    assert pytest.approx(shown.at(np.array(times[0]) - APPROACH_S)) == np.array(angles).T
