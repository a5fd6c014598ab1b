"""Who takes part and what will be tested: declared before the first answer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import BeforeValidator, ConfigDict, Field, field_validator, model_validator

from stimuli.errors import nearest
from study.protocol.recorded import Recorded
from study.protocol.recruitment import Recruitment
from study.written import A_HYPOTHESIS, Seconds, Written, wrong

Probability = Annotated[float, Field(gt=0, lt=1)]
Test = Literal["one-sample t", "independent t", "paired t", "wilcoxon", "mcnemar", "binomial"]
TEST_NAMES: Mapping[str, str] = {
    "one-sample t": "one-sample t-test",
    "independent t": "Student's t-test of independent samples",
    "paired t": "paired t-test",
    "wilcoxon": "Wilcoxon's signed-rank test",
    "mcnemar": "McNemar's exact test",
    "binomial": "exact binomial test",
}
ChanceName = Literal[
    "midpoint",
    "grand mean",
    "other stimuli",
    "other items",
    "equal share",
    "equal share above lowest",
    "best item",
    "double difference",
]


def _chance(value: Any) -> Any:
    names = get_args(ChanceName)
    if isinstance(value, bool) or (not isinstance(value, (int, float)) and value not in names):
        raise wrong(f"must be a number or say how chance is found; {nearest(value, names)}")
    return value


Chance = Annotated[float | ChanceName, BeforeValidator(_chance)]


class Exclusions(Written):
    """Rules by which a participant is left out of the tests."""

    faster_than: Seconds | None = None  # median time per answer; a minute at most
    failed_attention: int | None = Field(None, ge=1)  # so many failed attention checks, or more
    incomplete: bool = True
    straight_lining: bool = False  # the same answer to every item of a part

    @field_validator("faster_than")
    @classmethod
    def _leaves_somebody(cls, seconds: float | None) -> float | None:
        if seconds is not None and not 0 < seconds <= 60:
            raise wrong("must be more than 0 s and at most 60 s: who answers faster is left out")
        return seconds


def _not_empty(value: Any) -> Any:
    if not value:
        raise wrong("is empty; write service: prolific, sona or mturk, or leave it out")
    return value


class Participants(Written):
    """How many, and who is left out."""

    planned: int = Field(ge=1, le=100_000)
    stop: Literal["when complete", "by hand"] = "when complete"
    """When nobody else may begin: as many as planned have completed, or the experimenter closes the study."""
    abandoned_after: Seconds = 3600.0  # without an answer; the place in the design is then given to the next
    links_last: Seconds = 90 * 86_400.0  # a link or code with which nobody has begun by then opens nothing
    exclude: Exclusions = Exclusions()
    recruitment: Annotated[Recruitment, BeforeValidator(_not_empty)] = Recruitment()
    peeking: bool = False  # whether the report may be seen before as many as planned have completed


class Hypothesis(Written):
    """One hypothesis and the test that decides on it."""

    text: str | None = None
    part: str
    item: str | None = None  # the question's only item, unless told
    test: Test
    of: Literal["target"] | None = None  # each stimulus on the item that bears its name
    against: Chance | None = None
    compare: tuple[str, str] | None = None  # levels
    outcome: str | None = None  # the answer that counts as 1, where answers are choices
    alternative: Literal["greater", "less", "two-sided"]
    correction: Literal["holm", "bonferroni", "benjamini-hochberg", "none"] = "none"
    mirrors: str | None = None  # the same test seen from the other side; printed, not counted

    @model_validator(mode="after")
    def _either(self) -> Self:
        if (self.compare is None) == (self.of is None):
            raise wrong("needs either `of: target, against: …` or `compare: [one level, another]`")
        return self


HypothesisName = Annotated[str, Field(pattern=A_HYPOTHESIS, max_length=60)]  # names files


class Analysis(Written):
    """The plan of analysis: hypotheses by name, and what they share."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[HypothesisName, Hypothesis] = Field(init=False)

    alpha: Probability = 0.05
    responses: Recorded = Recorded()

    @property
    def hypotheses(self) -> dict[str, Hypothesis]:
        """The hypotheses in the order written."""
        return dict(self.__pydantic_extra__)
