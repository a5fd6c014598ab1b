"""Power agrees with statsmodels, with counting all outcomes, and grows with what should make it grow."""

from itertools import product
from pathlib import Path

import pytest
from scipy.stats import binom, binomtest
from statsmodels.stats.power import TTestIndPower, TTestPower

from analysis.statistics.adjustment import adjust
from study.power import (
    AIM,
    mcnemar_power,
    participants_needed,
    power,
    preference_power,
    smallest_effect,
    t_power,
)
from study.protocol import load_protocol

PAPER = load_protocol(Path(__file__).parents[2] / "protocols" / "hielscher2025")


@pytest.mark.parametrize(
    ("n", "d", "alpha"), [(10, 0.5, 0.05), (34, 0.5, 0.05), (36, 0.3, 0.05 / 6), (120, 0.2, 0.01)]
)
def test_power_of_t_tests_agrees_with_statsmodels(n, d, alpha):
    one = TTestPower().power(d, n, alpha, alternative="larger")
    assert t_power(n, d, alpha) == pytest.approx(one, abs=1e-9)
    two_sided = TTestPower().power(d, n, alpha, alternative="two-sided")
    assert t_power(n, d, alpha, two_sided=True) == pytest.approx(two_sided, abs=1e-9)
    groups = TTestIndPower().power(d, n, alpha, alternative="larger")
    assert t_power(n, d, alpha, groups=2) == pytest.approx(groups, abs=1e-9)


def test_power_of_t_tests_agrees_with_r():
    # R: power.t.test(n = 34, delta = .5, type = …, alternative = …, strict = TRUE)$power
    assert t_power(34, 0.5, 0.05) == pytest.approx(0.886865311850324, rel=1e-9)
    assert t_power(34, 0.5, 0.05, groups=2) == pytest.approx(0.653760928907101, rel=1e-9)
    assert t_power(34, 0.5, 0.05, groups=2, two_sided=True) == pytest.approx(0.528549627105263, rel=1e-9)


def test_effects_and_numbers_agree_with_r():
    # R: power.t.test(power = .8, delta = .5, type = "one.sample", alternative = "one.sided")$n is 26.14
    assert participants_needed(lambda n: t_power(n, 0.5, 0.05)) == 27
    # R: power.t.test(power = .8, delta = .8, sig.level = .0167, strict = TRUE)$n is 34.1676
    assert participants_needed(lambda n: t_power(n, 0.8, 0.0167, groups=2, two_sided=True)) == 35
    # R: power.t.test(n = 34, power = .8, type = "one.sample", alternative = "one.sided")$delta
    assert smallest_effect(lambda d: t_power(34, d, 0.05)) == pytest.approx(0.435454380370621, abs=1e-3)


@pytest.mark.parametrize(("n", "first", "second"), [(8, 0.8, 0.3), (12, 0.7, 0.4), (15, 1.0, 0.0)])
def test_mcnemar_power_agrees_with_counting_every_outcome(n, first, second):
    gain, loss = first * (1 - second), second * (1 - first)
    total = 0.0
    for b, c in product(range(n + 1), repeat=2):
        if b + c <= n and b + c > 0 and binomtest(b, b + c, 0.5, alternative="greater").pvalue <= 0.05:
            total += binom.pmf(b, n, gain) * binom.pmf(c, n - b, loss / (1 - gain) if gain < 1 else 0)
    assert mcnemar_power(n, first, second, 0.05) == pytest.approx(total, abs=1e-12)


@pytest.mark.parametrize(("share", "needed"), [(0.6, 169), (0.7, 42), (0.8, 18)])
def test_from_the_number_needed_on_an_exact_test_has_the_power(share, needed):
    def at(n):
        critical = next(k for k in range(n + 2) if k > n or binomtest(k, n, 0.5, "greater").pvalue <= 0.05)
        return binom.sf(critical - 1, n, share)

    assert participants_needed(lambda n: preference_power(n, share, 0.05)) == needed
    assert at(needed - 1) < AIM <= min(at(n) for n in range(needed, needed + 12))


def test_the_effect_that_is_printed_is_found():
    for found in power(PAPER):
        assert found.smallest is not None
        printed = float(str(found).split("≥ ")[1].split()[0])
        assert 0 <= printed - found.smallest < 0.01


@pytest.mark.parametrize(
    ("correction", "alpha", "said"),
    [
        ("none", 0.05, "in each of 6 tests, at alpha = 0.05"),
        ("holm", 0.05 / 6, "in the strictest of 6 tests, at alpha = 0.008333"),
        (
            "benjamini-hochberg",
            0.05 / 6,
            "in the strictest of 6 tests, the only one to find something, at alpha = 0.008333",
        ),
    ],
)
def test_the_level_is_the_one_the_correction_leaves_to_a_single_effect(tmp_path, correction, alpha, said):
    text = (PAPER.path).read_text(encoding="utf-8")
    (tmp_path / "protocol.yaml").write_text(text.replace("correction: holm", f"correction: {correction}"))
    found = power(load_protocol(tmp_path))[0]
    assert (found.alpha, found.level) == (pytest.approx(alpha), said)
    p = [alpha - 1e-9, *[0.9] * 5]  # of one effect alone: significant only below that level
    for shift, significant in ((0, True), (2e-9, False)):
        family = {str(at): value for at, value in enumerate([p[0] + shift, *p[1:]])}
        assert (adjust(family, correction)["0"] < 0.05) == significant


def test_without_an_effect_power_is_at_most_alpha():
    assert t_power(36, 0.0, 0.05) == pytest.approx(0.05)
    assert mcnemar_power(36, 0.5, 0.5, 0.05) <= 0.05
    assert mcnemar_power(36, 1.0, 1.0, 0.05) == 0.0


@pytest.mark.parametrize("name", ["hielscher2025", "godspeed", "online", "template"])
def test_a_larger_effect_needs_fewer_participants(name):
    for found in power(load_protocol(Path(__file__).parents[2] / "protocols" / name)):
        numbers = list(found.needed.values())
        assert numbers == sorted(set(numbers), reverse=True), found


def test_each_hypothesis_that_counts_has_a_smallest_effect():
    powers = {found.hypothesis: found for found in power(PAPER)}
    assert set(powers) == {"H1", "H2.1"}  # H2.2 mirrors H2.1
    assert powers["H1"].tests == powers["H2.1"].tests == 6
    assert powers["H1"].smallest is not None
    assert t_power(36, powers["H1"].smallest, powers["H1"].alpha) == pytest.approx(AIM, abs=0.002)
    needed = [n for n in powers["H2.1"].needed.values() if n]
    assert needed == sorted(needed, reverse=True)
