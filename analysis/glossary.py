"""What every number of a report means, in a sentence each."""

from __future__ import annotations

GLOSSARY = {
    "N": "Number of participants with an answer.",
    "M": "Mean rating.",
    "SD": "Standard deviation of the ratings, n − 1 in the denominator.",
    "SE": "Standard error of the mean, SD / √N.",
    "t": "Difference from chance, or between levels, in standard errors.",
    "df": "Degrees of freedom of t.",
    "p": "Probability of a result at least as extreme if there were no effect.",
    "p adjusted": "p adjusted for the number of tests in its family; this one is compared with α. "
    "Where t is undefined, the exact test named beside it takes its place in the family.",
    "d": "Cohen's d: the difference in standard deviations, with the exact interval from the noncentral t.",
    "g": "Hedges' g: d without its bias in small samples (exact factor).",
    "sign flip": "Exact test: share of all 2ⁿ signs of the differences that give as extreme a sum.",
    "Wilcoxon": "Signed-rank test, zeros after Pratt, normal approximation corrected for ties.",
    "rank biserial": "Rank-biserial correlation: share of rank sum above minus below the null value.",
    "binomial": "Exact binomial test that more than half chose the answer that fits the level.",
    "Wilson": "Wilson's score interval of the share that fits the level.",
    "Student": "Student's t-test as if the groups were independent, answers coded 1 and 0.",
    "Welch": "Welch's t-test: as Student's, without assuming equal variances.",
    "paired": "Paired t-test on the same participants' differences.",
    "Fisher": "Fisher's exact test as if the groups were independent.",
    "McNemar": "McNemar's exact test on the same participants' pairs of answers, in the direction expected.",
    "mid-p": "McNemar's mid-p, two-sided: half the weight of the observed outcome, less conservative.",
    "Newcombe": "Difference of the two shares with Newcombe's hybrid score interval.",
}

THREATS = (
    "Each clip is judged right after its reference, so contrast with it is part of every judgement.",
    "The choice is forced: there is no answer “same”, so indifference looks like guessing.",
    "Few gestures were shown. A gesture is one draw from all gestures; statistics alone do not carry the "
    "results over to others.",
    "One question per judgement is a Likert item, not a scale; t-tests treat its points as equally spaced.",
)
