"""From responses to statistics, tables, figures and the report.

A study is analysed by `analysis.report.analyse`. The same tests on a pandas DataFrame, one line each:

>>> import analysis, pandas
>>> ratings = pandas.DataFrame({"joy": [4, 5, 3, 4, 5, 2], "fear": [2, 3, 3, 1, 2, None]})
>>> found = analysis.one_sample_t(ratings.joy, 3, "greater")
>>> round(found.t, 2), found.df, round(found.p, 3), round(found.d, 2)
(1.75, 5, 0.071, 0.71)
>>> analysis.paired_t(ratings.joy, ratings.fear).n  # complete pairs only
(5,)
>>> print(analysis.t_sentence(found))
t(5) = 1.75, p = .071, one-sided, d = 0.71, 95% CI [−0.22, 1.59], N = 6

Every test takes array-likes, leaves missing values (NaN, NA) out, and gives a frozen dataclass; what is
undefined is None beside a `reason`. Each docstring says what is computed, where from, and the R call it
agrees with.
"""

from __future__ import annotations

from analysis.apa import t_sentence
from analysis.statistics.adjustment import adjust
from analysis.statistics.bayes_factor import jzs_bayes_factor
from analysis.statistics.binomial import binomial
from analysis.statistics.bootstrap import bootstrap_mean
from analysis.statistics.clopper_pearson import clopper_pearson
from analysis.statistics.cronbach_alpha import cronbach_alpha
from analysis.statistics.cumulative_link_mixed import cumulative_link_mixed
from analysis.statistics.equivalence import equivalence
from analysis.statistics.fisher import fisher
from analysis.statistics.friedman import friedman
from analysis.statistics.gee_logistic import gee_logistic
from analysis.statistics.icc import icc
from analysis.statistics.krippendorff import krippendorff_alpha
from analysis.statistics.label_permutation import label_permutation
from analysis.statistics.linear_mixed import linear_mixed
from analysis.statistics.logistic_mixed import logistic_mixed
from analysis.statistics.mcnemar import mcnemar
from analysis.statistics.newcombe import newcombe
from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.order_effects import carry_over, position_effect
from analysis.statistics.paired_t import paired_t
from analysis.statistics.sign_flip import sign_flip
from analysis.statistics.student_t import student_t
from analysis.statistics.welch_t import welch_t
from analysis.statistics.wilcoxon import wilcoxon
from analysis.statistics.wilson import wilson

__all__ = [
    "adjust", "binomial", "bootstrap_mean", "carry_over", "clopper_pearson", "cronbach_alpha",
    "cumulative_link_mixed", "equivalence", "fisher", "friedman", "gee_logistic", "icc", "jzs_bayes_factor",
    "krippendorff_alpha", "label_permutation", "linear_mixed", "logistic_mixed", "mcnemar", "newcombe",
    "one_sample_t", "paired_t", "position_effect", "sign_flip", "student_t", "t_sentence", "welch_t",
    "wilcoxon", "wilson",
]  # fmt: skip
