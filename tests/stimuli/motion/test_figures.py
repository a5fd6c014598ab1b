"""What the paper says of its figures, on the figures' own motions."""

from __future__ import annotations

import numpy as np

from stimuli.figures import draw_paper_figures, modulated, one_dimension, overview, sphere
from stimuli.trajectory import Trajectory

SHOWN = one_dimension()
N = len(SHOWN.times)
SOURCE = SHOWN.joint("source")


def moved(**parameters):
    """The source and the target under a modulation, (n,) each."""
    return modulated(SHOWN, parameters)[1].T


def roughness(y):
    return np.sum(np.diff(y, 2) ** 2)


def test_the_figures_are_drawn(tmp_path, robot, demonstrate):
    for path in draw_paper_figures(tmp_path / "figures", dpi=20):
        assert path.read_bytes().startswith(b"\x89PNG")
    assert len(overview(demonstrate(), robot, "Hip").axes) == 9


def test_arc_broadens_and_sharpens():
    plain, broad, sharp = (moved(arc=p)[0] for p in (0, 5, -5))
    assert np.ptp(broad) < 0.8 * np.ptp(plain) < 0.8 * np.ptp(sharp) / 1.2
    assert roughness(broad) < roughness(plain) < roughness(sharp)


def test_anticipation_sets_out_the_opposite_way_in_both_forms_and_catches_up():
    for form in ("literal", "mirror"):
        y = moved(ant={"intensity": 0.4, "form": form})[0]
        assert y[:150].min() < -0.05
        assert np.abs(y[500:N] - SOURCE[500:]).max() < 0.02


def test_timing_is_faster_or_slower_and_loses_no_feature():
    for p in (0.75, 1.25):
        y = moved(time=p)[0]
        again = np.interp(SHOWN.times * p, np.arange(len(y)) * 0.01, y)
        assert np.abs(again - SOURCE).max() < 5e-3


def test_progression_reaches_the_peak_later_when_slow_comes_first():
    slow_first, fast_first = (
        moved(time={"progression": order})[0] for order in (["slow", "fast"], ["fast", "slow"])
    )
    assert np.argmax(fast_first) < np.argmax(SOURCE) < np.argmax(slow_first)


def test_slow_in_needs_retiming_to_start_slowly():
    """By phase alone the start hardly slows down; retimed it does, as the text of the paper wants it."""
    begin = slice(0, N // 10)
    speed = [np.abs(np.diff(y[begin])).mean() for y in (SOURCE, moved(slow=1)[0])]
    retimed = np.abs(np.diff(moved(slow={"intensity": 1, "form": "retime"})[0][begin])).mean()
    assert retimed < 0.2 * speed[0]
    assert retimed < 0.5 * speed[1]


def test_exaggeration_amplifies_attenuates_and_at_zero_leaves_a_featureless_way_to_the_goal():
    spans = [np.ptp(moved(exa=p)[0]) for p in (0, 0.5, 1, 1.5)]
    assert spans == sorted(spans)
    assert spans[3] > 1.3 * spans[2]
    assert spans[1] < 0.7 * spans[2]
    assert np.all(np.diff(moved(exa=0)[0]) >= -1e-12)


def test_exaggerating_around_the_straight_way_keeps_a_reach_a_reach():
    """Around the goal, p = 1.5 sets out backwards; around the straight way it does not."""
    s = SHOWN.times / 10
    reach = 10 * s**3 - 15 * s**4 + 6 * s**5
    shown = Trajectory(SHOWN.times, reach[:, None], ("x",))
    literal = modulated(shown, {"exa": 1.5})[1][:, 0]
    straight = modulated(shown, {"exa": {"intensity": 1.5, "around": "straight"}})[1][:, 0]
    assert literal.min() < -0.1
    assert np.abs(straight[:N] - reach).max() < 2e-3


def test_secondary_action_is_nearly_invisible_as_printed_and_plain_on_the_state():
    printed, state = (moved(sec={"intensity": 0.05, "form": form})[1] for form in ("output", "state"))
    assert np.abs(printed[:N] - SOURCE).max() < 0.1
    assert np.abs(state[:N] - SOURCE).max() > 0.5
    assert abs(printed[-1] - SOURCE[-1]) < 1e-6  # and leaves nothing displaced
    assert abs(moved(sec={"intensity": 0.05, "form": "state"})[1][-1] - SOURCE[-1]) < 1e-2


def test_follow_through_starts_the_other_way_lags_and_swings_over_the_turning_point():
    target = moved(follow=3)[1]
    lags = np.arange(0, 100)
    best = max(lags, key=lambda lag: np.dot(np.diff(target)[lag : N - 1], np.diff(SOURCE)[: N - 1 - lag]))
    assert target[:100].min() < -0.02
    assert 10 <= best < 80
    assert np.ptp(target) > 1.1 * np.ptp(SOURCE)


def test_randomization_differs_by_seed_and_stays_around_the_motion():
    drawn = np.stack([moved(rand={"intensity": 0.5, "seed": seed})[0][:N] for seed in range(6)])
    assert drawn.std(axis=0).max() > 0.02
    assert np.abs(drawn.mean(axis=0) - SOURCE).max() < 0.2


def test_arc_rounds_a_rough_path_over_a_sphere():
    rough = sphere(16)
    plain, round_ = (modulated(rough, {"arc": p})[1] for p in (0, 2))
    assert roughness(round_) < roughness(plain)
    assert np.linalg.norm(round_, axis=1)[200:800].max() < 1
