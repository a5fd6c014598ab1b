"""Power by simulation: by chance tests hold their level, and an effect is found the more often the larger."""

from pathlib import Path

from analysis.simulated_power import SimulatedPower, simulated_power
from study.protocol import load_protocol

GODSPEED = load_protocol(Path(__file__).parents[2] / "protocols" / "godspeed")


def test_without_an_effect_little_is_found_and_with_one_nearly_all():
    chance = simulated_power(GODSPEED, runs=6, effect=0.0, n=24)
    plain = simulated_power(GODSPEED, runs=6, effect=3.0, n=24)
    assert [(one.hypothesis, one.test) for one in chance] == [
        ("H1", "anthropomorphism"), ("H2", "animacy"), ("H3", "likeability"),
    ]  # fmt: skip
    assert sum(one.found for one in chance) <= 3  # of 18 tests at alpha 0.0167
    assert all(one.power >= 0.8 for one in plain)


def test_simulated_power_repeats_with_the_studys_seed():
    once, again = (simulated_power(GODSPEED, runs=2, n=16) for _ in range(2))
    assert once == again


def test_a_few_runs_that_all_succeed_prove_little():
    assert str(SimulatedPower("H1", "joy", found=4, runs=4)) == "H1 joy: 100% of 4 runs (95% CI 51% to 100%)"
