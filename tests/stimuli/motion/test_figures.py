"""What the paper says of its figures, on the figures' own motions."""

from __future__ import annotations

import numpy as np

from stimuli.figures import draw_paper_figures, modulated, one_dimension, overview, reach, sphere
from stimuli.principles import PRINCIPLES

SHOWN = one_dimension()
N = len(SHOWN.times)
SOURCE = SHOWN.joint("source")


def moved(**parameters):
    """The source and the target under a modulation, (n,) each."""
    return modulated(SHOWN, parameters)[1].T


def roughness(y):
    return np.sum(np.diff(y, 2) ** 2)


def test_the_figures_are_drawn(tmp_path):
    drawn = draw_paper_figures(tmp_path / "figures", dpi=20)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in drawn)


def test_the_overview_shows_every_principle_away_from_what_was_demonstrated():
    panels = overview().axes
    titles = [axes.get_title("left").split(",")[0] for axes in panels]
    assert titles == [kind.title for kind in PRINCIPLES.values()]
    for axes in panels:
        shown, made = (line.get_xydata() for line in axes.lines)
        assert np.abs(np.interp(shown[:, 0], *made.T) - shown[:, 1]).max() > 0.02


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
    """By phase alone the start is less slow and the shape is lost; retimed it is as the paper says."""
    begin = slice(0, N // 10)
    bent, retimed = (moved(slow={"intensity": 1, "form": form})[0] for form in ("phase", "retime"))
    speeds = [np.abs(np.diff(y[begin])).mean() for y in (SOURCE, bent, retimed)]
    assert speeds[2] < 0.2 * speeds[0]
    assert speeds[2] < 0.5 * speeds[1]
    assert np.ptp(retimed) > 0.99 * np.ptp(SOURCE) > 1.2 * np.ptp(bent)


def test_exaggeration_amplifies_attenuates_and_at_zero_leaves_a_featureless_way_to_the_goal():
    spans = [np.ptp(moved(exa=p)[0]) for p in (0, 0.5, 1, 1.5)]
    assert spans == sorted(spans)
    assert spans[3] > 1.3 * spans[2]
    assert spans[1] < 0.7 * spans[2]
    assert np.all(np.diff(moved(exa=0)[0]) >= -1e-12)


def test_exaggerating_around_the_straight_way_keeps_a_reach_a_reach():
    """Around the goal, p = 1.5 sets out backwards; around the straight way it does not."""
    literal, straight = (
        modulated(reach(), {"exa": {"intensity": 1.5, "around": around}})[1][:, 0]
        for around in ("goal", "straight")
    )
    assert literal.min() < -0.1
    assert np.abs(straight[:N] - reach().joint("source")).max() < 2e-3


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
