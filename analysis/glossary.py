"""What every number of a report means, in a sentence or two, and the R call it is checked against."""

from __future__ import annotations

GLOSSARY = {
    "N": "Number of participants with an answer.",
    "M": "Mean rating.",
    "SD": "Standard deviation of the ratings, n − 1 in the denominator.",
    "SE": "Standard error of the mean, SD / √N.",
    "t": "Difference from chance, or between levels, in standard errors. R: t.test",
    "df": "Degrees of freedom of t.",
    "p": "Probability of a result at least as extreme if there were no effect.",
    "p adjusted": "p adjusted for the number of tests in its family; this one is compared with α. "
    "Where t is undefined, the exact test named beside it takes its place in the family. R: p.adjust",
    "d": "Cohen's d: the difference in standard deviations, with the exact interval from the noncentral t, "
    "two-sided whatever the test. R: pt(t, df, ncp) solved for ncp",
    "g": "Hedges' g: d without its bias in small samples (exact factor).",
    "sign flip": "Exact test: share of all 2ⁿ signs of the differences that give as extreme a sum.",
    "Wilcoxon": "Signed-rank test, zeros after Pratt; exact, with ties (approximate above 500 answers). "
    'R: coin::wilcoxsign_test(zero.method = "Pratt", distribution = "exact")',
    "rank biserial": "Rank-biserial correlation: share of rank sum above minus below the null value.",
    "binomial": "Exact binomial test that more than half (two-sided: other than half) chose the answer that "
    "fits the level. R: binom.test",
    "preference": "Exact binomial test that either is chosen equally often. R: binom.test",
    "Clopper-Pearson": "Exact interval of the share. R: binom.test(k, n)$conf.int",
    "Wilson": "Wilson's score interval of the share that fits the level. R: prop.test(correct = FALSE)",
    "Student": "Student's t-test as if the groups were independent, answers coded 1 and 0. "
    "R: t.test(var.equal = TRUE)",
    "Welch": "Welch's t-test: as Student's, without assuming equal variances. R: t.test",
    "paired": "Paired t-test on the same participants' differences. R: t.test(paired = TRUE)",
    "Fisher": "Fisher's exact test as if the groups were independent. R: fisher.test",
    "McNemar": "McNemar's exact test on the same participants' pairs of answers, in the direction declared. "
    "R: binom.test on the discordant pairs",
    "mid-p": "McNemar's mid-p, two-sided: half the weight of the observed outcome, less conservative.",
    "Newcombe": "Difference of the two shares with Newcombe's hybrid score interval.",
    "pace": "Each participant's median time per answer.",
    "own SD": "Standard deviation of a participant's own ratings (intra-individual response variability): "
    "near 0 for somebody who always answers the same.",
    "BCa": "Bootstrap interval of the mean, bias-corrected, 9,999 resamples, fixed seed.",
    "CLMM": "Cumulative-link mixed model: log odds that the intended item is rated higher than the others, "
    "with an effect of the participant. R: ordinal::clmm",
    "LMM": "Linear mixed model of the intended item's rating less the mean of the clip's other items, "
    "participants and clips both drawn from many; degrees of freedom by Satterthwaite. "
    "R: lmerTest::lmer(score ~ 1 + (1 | participant) + (1 | clip))",
    "Friedman": "Friedman's rank test that the items of a clip are rated differently. R: friedman.test",
    "Kendall W": "Kendall's W, the agreement of participants' ranks: 0 none, 1 complete.",
    "label permutation": "Exact test: how often so high a sum of ratings falls on the intended item when "
    "each participant's ratings of a clip are shuffled among the items.",
    "BF": "JZS Bayes factor of the one-sample or paired t-test, as one- or two-sided as the test, "
    "Cauchy prior of width 0.707: how much likelier the data are under an effect. R: BayesFactor::ttestBF",
    "TOST": "Two one-sided tests that the mean lies within half a point of chance, on a slider within "
    "5% of its length: a small p says it is practically at chance. R: t.test against each bound",
    "Krippendorff": "Agreement of participants' ratings beyond chance: 0 none, 1 complete.",
    "ICC": "Intraclass correlation, participants as raters drawn from many: of one rater (ICC2) and of the "
    "mean of all (ICC2k). R: psych::ICC(lmer = FALSE)",
    "hit rate": "Share of participants who rated the intended item highest; ties are shared.",
    "Hu": "Wagner's unbiased hit rate: hits² / (clips shown × times the item was chosen), and its chance.",
    "GEE": "Logistic regression of the answer on the level, errors clustered by participant and bias-reduced "
    'below 40 participants. R: geepack::geeglm(corstr = "exchangeable")',
    "GLMM": "Logistic mixed model with a random intercept per participant. R: lme4::glmer(nAGQ = 25)",
    "position": "Change of the tested score per place later in the part, beside participant and clip. "
    "R: lm(score ~ participant + clip + place)",
    "carry-over": "F-test that the score depends on the clip before, beyond participant, clip and place. "
    "R: anova of both lm",
    "Cronbach": "Cronbach's α of the items of a scale, over all clips judged, with Feldt's interval. "
    "R: psych::alpha",
}
