"""What "above chance" can mean for a rating of several items, and what each meaning compares.

The published analysis does not define its chance level. Each definition turns the ratings of one stimulus
into one number per participant and says what that number would be on average if the target were not
recognised.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from analysis.answers import Answers, FloatArray


@dataclass(frozen=True)
class Target:
    """The answers of a part, which are numbers, and which stimulus is judged on which item."""

    answers: Answers
    stimulus: int
    item: int

    @property
    def ratings(self) -> FloatArray:
        """All ratings, (participants, stimuli, items), NaN where missing."""
        return self.answers.ratings

    @property
    def scale(self) -> tuple[float, float]:
        """Lowest and highest point."""
        scale = self.answers.scale
        assert scale is not None
        return scale

    @property
    def on_target(self) -> FloatArray:
        """The target's ratings, (participants,)."""
        return self.ratings[:, self.stimulus, self.item]

    @property
    def of_stimulus(self) -> FloatArray:
        """All ratings of the stimulus, (participants, items)."""
        return self.ratings[:, self.stimulus, :]


@dataclass(frozen=True)
class Scores:
    """One number per participant, and its mean if there were no recognition."""

    values: FloatArray
    null: float
    estimated: bool = False  # the null comes from the same data
    hits: bool = False  # values are 0 and 1: a binomial test, not a t-test


@dataclass(frozen=True)
class Definition:
    """One meaning of chance."""

    id: str
    says: str
    fooled_by: str  # what passes for recognition under this definition
    scores: Callable[[Target], Scores]
    on_scale: bool = False  # the scores are the ratings themselves, and chance is a point of their scale


def midpoint(target: Target) -> Scores:
    """The rating against the middle of the scale."""
    return Scores(target.on_target, null=sum(target.scale) / 2)


def grand_mean(target: Target) -> Scores:
    """The rating against the mean of all ratings, taken as if it were known."""
    mean = target.answers.mean
    return Scores(target.on_target, null=sum(target.scale) / 2 if mean is None else mean, estimated=True)


def other_stimuli(target: Target) -> Scores:
    """The rating minus the mean rating of the same item for the other stimuli."""
    others = np.delete(target.ratings[:, :, target.item], target.stimulus, axis=1)
    return Scores(target.on_target - others.mean(axis=1), null=0.0)


def other_items(target: Target) -> Scores:
    """The rating minus the mean rating of the other items for the same stimulus."""
    others = np.delete(target.of_stimulus, target.item, axis=1)
    return Scores(target.on_target - others.mean(axis=1), null=0.0)


def equal_share(target: Target) -> Scores:
    """The target's share of all points given to the stimulus, against 1 / items."""
    return _share_of_points(target, above=0)


def equal_share_above_lowest(target: Target) -> Scores:
    """The same share counted from the lowest point as zero."""
    return _share_of_points(target, above=target.scale[0])


def _share_of_points(target: Target, above: float) -> Scores:
    """The target's share of the points above some; no points at all count as an equal share."""
    points = target.of_stimulus - above
    totals, equal = points.sum(axis=1), 1 / points.shape[1]
    shares = np.where(totals == 0, equal, points[:, target.item] / np.where(totals == 0, 1, totals))
    return Scores(shares, null=equal)


def best_item(target: Target) -> Scores:
    """Whether the target alone was rated highest, against 1 / items; a tie for the highest is a miss."""
    others = np.delete(target.of_stimulus, target.item, axis=1)
    hit = (target.on_target > others.max(axis=1)).astype(float)
    hit[np.isnan(target.of_stimulus).any(axis=1)] = np.nan
    return Scores(hit, null=1 / target.ratings.shape[2], hits=True)


def double_difference(target: Target) -> Scores:
    """The rating minus what favourite items and intense stimuli explain: target − row − column + rest."""
    here, everywhere = target.on_target, target.ratings.sum(axis=(1, 2))
    same_stimulus = target.of_stimulus.sum(axis=1) - here
    same_item = target.ratings[:, :, target.item].sum(axis=1) - here
    rest = everywhere - same_stimulus - same_item - here
    s, i = (n - 1 for n in target.ratings.shape[1:])  # other stimuli, other items
    return Scores(here - same_stimulus / i - same_item / s + rest / (s * i), null=0.0)


def fixed(level: float) -> Definition:
    """A number given in the protocol."""
    return Definition(
        "fixed",
        f"the rating against {level:g}",
        "agreeing with everything",
        lambda t: Scores(t.on_target, level),
        on_scale=True,
    )


def applicable(stimuli: int, items: int) -> dict[str, Definition]:
    """The definitions by name; with one stimulus or one item only those that need no others."""
    alone = ("midpoint", "grand mean")
    return {name: one for name, one in DEFINITIONS.items() if name in alone or min(stimuli, items) > 1}


DEFINITIONS: Mapping[str, Definition] = {
    "midpoint": Definition(
        "A", "rating against the middle of the scale", "agreeing with everything", midpoint, on_scale=True
    ),
    "grand mean": Definition(
        "B",
        "rating against the mean of all ratings (estimated)",
        "a favourite item",
        grand_mean,
        on_scale=True,
    ),
    "other stimuli": Definition(
        "C", "rating minus the same item's mean for the other clips", "an intense clip", other_stimuli
    ),
    "other items": Definition(
        "D", "rating minus the other items' mean for the same clip", "a favourite item", other_items
    ),
    "equal share": Definition(
        "E1", "share of the clip's points against an equal share", "a favourite item", equal_share
    ),
    "equal share above lowest": Definition(
        "E2", "the same share with the lowest point as zero", "a favourite item", equal_share_above_lowest
    ),
    "best item": Definition(
        "F", "rated highest, alone, against 1 / items (exact binomial)", "a favourite item", best_item
    ),
    "double difference": Definition(
        "G", "rating beyond what clip and item explain", "nothing additive", double_difference
    ),
}
