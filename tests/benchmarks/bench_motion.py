"""Our primitives against movement_primitives 0.9.1: rollouts, many variants, one step, reproduction error."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from movement_primitives.dmp import DMP

from stimuli.dmp import Learning, Primitive
from stimuli.online import Runner
from stimuli.principles import PRINCIPLES, Modulation
from stimuli.robots.model import Joint, Relation, Robot
from stimuli.rollout import integrate
from stimuli.trajectory import Trajectory
from stimuli.variants import integrate_all
from tests.benchmarks.compare import Row, times_faster

PEER = "movement_primitives 0.9.1"
D, DURATION_S, DT_S = 17, 5.0, 0.01
N = round(DURATION_S / DT_S)
VARIANTS = 1000


def rows() -> Iterator[Row]:
    """Every comparison."""
    robot, shown = _robot(), _demonstration()
    primitive = Primitive.learn(shown, Learning())
    peer = DMP(D, execution_time=DURATION_S, dt=DT_S, n_weights_per_dim=50)
    peer.imitate(shown.times, shown.positions)

    def open_loop() -> object:
        return peer.open_loop()

    plain = primitive.course(Modulation(), robot)
    nine = primitive.course(
        Modulation(principles=tuple(k.example(robot) for k in PRINCIPLES.values())), robot
    )
    what = f"one rollout, {D} joints, {DURATION_S:g} s at 100 Hz"
    for name, course, reach, detail in (
        ("no modulation", plain, 60, "answers to the weights kept"),
        ("all nine", nine, 15, ""),
    ):
        faster = times_faster(lambda c=course: integrate(c, DT_S, N), open_loop, repeats=20)
        yield Row(f"{what}, {name}", f"{PEER} rk4-cython", faster, reach, detail=detail)

    rng = np.random.default_rng(0)
    variants = [
        primitive.course(Modulation.model_validate({"exa": float(exa), "goal": {"J0": float(goal)}}), robot)
        for exa, goal in zip(rng.uniform(0.5, 1.5, VARIANTS), rng.uniform(-1, 1, VARIANTS), strict=True)
    ]
    faster = VARIANTS * times_faster(lambda: integrate_all(variants, DT_S, N), open_loop, rounds=5)
    yield Row(
        f"{VARIANTS} variants of it", f"{PEER}, one by one", faster, 300, detail="Exaggeration and Goal"
    )
    room = np.empty((VARIANTS, N + 1, D))
    writes = 1 / times_faster(lambda: integrate_all(variants, DT_S, N), lambda: room.fill(1.0), rounds=5)
    yield Row(f"{VARIANTS} variants of it", "writing the result to memory", writes, 12, at_most=True)

    runner = Runner(plain)
    still = np.zeros(D)
    faster = times_faster(
        lambda: runner.step(1e-5), lambda: peer.step(still, still), repeats=500, peer_repeats=500
    )
    yield Row(f"one online step, {D} joints", f"{PEER} step", faster, 2)

    spans = np.ptp(shown.positions, axis=0)
    errors = [
        np.mean(np.sqrt(np.mean((again - shown.positions) ** 2, axis=0)) / spans)
        for again in (peer.open_loop()[1][: N + 1], integrate(plain, DT_S, N)[0])
    ]
    detail = f"NRMSE {errors[1]:.1e} against {errors[0]:.1e}"
    yield Row("reproduction error, 50 weights", PEER, float(errors[0] / errors[1]), 10, detail=detail)


def _demonstration() -> Trajectory:
    s = np.linspace(0, 1, N + 1)[:, None]
    rng = np.random.default_rng(1)
    reach = (10 * s**3 - 15 * s**4 + 6 * s**5) * rng.uniform(-1, 1, D)
    bumps = np.sin(np.pi * s) ** 4 * np.sin(2 * np.pi * s * rng.uniform(0.5, 3, D) + rng.uniform(0, 6, D))
    return Trajectory(s[:, 0] * DURATION_S, reach + bumps, tuple(f"J{i}" for i in range(D)))


def _robot() -> Robot:
    def build() -> object:
        raise NotImplementedError("kinematics only")

    joints = tuple(
        Joint(f"J{i}", "world", f"L{i}", "revolute", (0, 0, 0), (0, 0, 0), (0, 0, 1), -9, 9, None)
        for i in range(D)
    )
    relations = tuple(
        Relation(f"J{i}", f"J{j}", 1) for i, j in ((0, 1), (1, 2), (0, 5), (1, 6), (0, 9), (1, 10))
    )
    return Robot("seventeen", "17 joints", joints, {j.name: 0.0 for j in joints}, build, relations=relations)
