"""Whether answers depend on the order clips were shown in, and whether that order was balanced."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analysis.answers import FloatArray
from analysis.plan import Outcome, Preferences, Targets
from analysis.statistics.order_effects import CarryOver, Position, carry_over, position_effect


@dataclass(frozen=True)
class Order:
    """Effects of order on the scores of a part, and how evenly clips were spread over it."""

    position: Position
    carry_over: CarryOver
    positions: tuple[int, int]  # least and most often that a clip stood in a place
    follows: tuple[int, int]  # least and most often that a clip came straight after a certain other


def order_of(outcome: Outcome, shown: FloatArray) -> Order | None:
    """Order effects of an outcome, given the place of each clip, (participants, stimuli).

    None where places are unknown, or nobody saw a second clip.
    """
    if np.max(np.sum(~np.isnan(shown), axis=1), initial=0) < 2:
        return None
    scores = scores_of(outcome)
    places, follows = _counts(shown)
    return Order(
        position=position_effect(scores, shown),
        carry_over=carry_over(scores, shown),
        positions=(int(places.min()), int(places.max())),
        follows=(int(follows.min()), int(follows.max())) if follows.size else (0, 0),
    )


def scores_of(outcome: Outcome) -> FloatArray:
    """What is tested, per participant and stimulus: the rating on the target, or the answer that fits (1).

    (participants, stimuli), NaN where there is none.
    """
    answers = outcome.answers
    scores = np.full(answers.codes.shape[:2], np.nan)
    if isinstance(outcome, Targets):
        for stimulus, one in outcome.results.items():
            s = answers.stimuli.index(stimulus)
            scores[:, s] = answers.ratings[:, s, answers.items.index(one.item)]
        return scores
    if isinstance(outcome, Preferences):
        for preferred in outcome.results.values():
            s, i = answers.stimuli.index(preferred.compared.pair), answers.items.index(outcome.item)
            scores[:, s] = answers.chose(preferred.compared.first)[:, s, i]
        return scores
    comparison = outcome.comparison
    values = answers.on(comparison.item, comparison.outcome)
    for stimuli in comparison.pairs.values():
        for level, stimulus in enumerate(stimuli):
            s = answers.stimuli.index(stimulus)
            fits = values[:, s]
            scores[:, s] = 1 - fits if level == 1 and comparison.outcome is not None else fits
    return scores


def _counts(shown: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How often each stimulus stood in each place, and came straight after each other one (flat)."""
    stimuli = shown.shape[1]
    places = np.array([[np.sum(shown[:, s] == place) for place in np.unique(shown[~np.isnan(shown)])]
                       for s in range(stimuli)])  # fmt: skip
    follows = np.array([np.sum(shown[:, b] - shown[:, a] == 1)
                        for a in range(stimuli) for b in range(stimuli) if a != b])  # fmt: skip
    return places, follows
