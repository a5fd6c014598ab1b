"""Every statistic beside the R call that gives the same numbers.

Each call is worked out by R 4.2.2 on three data sets: `complete` (34 participants), `holes` (26, with missing
answers, many ties and constant columns) and `excluded` (44, of whom those with kept = 0 are left out). A call
that R refuses there is null. `python -m tests.analysis.statistics.reference` works all of them out anew into
data/r.json; it needs the packages below.
"""

from __future__ import annotations

import csv
import json
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import NamedTemporaryFile
from typing import Any

import numpy as np

from analysis.statistics.adjustment import Correction, adjust
from analysis.statistics.bayes_factor import jzs_bayes_factor
from analysis.statistics.binomial import binomial
from analysis.statistics.bootstrap import acceleration_of_mean, bca
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
from analysis.statistics.linear_mixed import LinearMixed, linear_mixed
from analysis.statistics.logistic_mixed import logistic_mixed
from analysis.statistics.mcnemar import McNemar, mcnemar
from analysis.statistics.newcombe import newcombe
from analysis.statistics.one_sample_t import one_sample_t
from analysis.statistics.order_effects import carry_over, position_effect
from analysis.statistics.paired_t import d_av, paired_t
from analysis.statistics.recognition_rate import confusion, unbiased_hit_rates
from analysis.statistics.samples import observed
from analysis.statistics.sign_flip import sign_flip
from analysis.statistics.student_t import student_t
from analysis.statistics.t_test import Alternative, TTest
from analysis.statistics.welch_t import welch_t
from analysis.statistics.wilcoxon import wilcoxon
from analysis.statistics.wilson import wilson

FOLDER = Path(__file__).parent / "data"
DATA = ("complete", "holes", "excluded")
ITEMS = ("joy", "fear", "anger", "shame")
CLOSED, NONCENTRAL, ITERATED = 1e-9, 1e-6, 1e-3  # closed forms; noncentral intervals; mixed models

SIDES: dict[str, Alternative] = {"greater": "greater", "less": "less", "two.sided": "two-sided"}  # R's, ours

Column = np.ndarray[tuple[int], np.dtype[np.float64]]
Numbers = Sequence[float | None] | None


@dataclass(frozen=True)
class Table:
    """A data set."""

    columns: dict[str, Column]

    def __getitem__(self, name: str) -> Column:
        return self.columns[name]

    def ratings(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """(participants, items)"""
        return np.column_stack([self[item] for item in ITEMS])

    def places(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """(participants, items)"""
        return np.column_stack([self[f"place_{item}"] for item in ITEMS])

    def long(self, *columns: str) -> tuple[Column, Column, Column]:
        """Value, whether it is of the first column, and participant, of every answer."""
        values = np.column_stack([self[column] for column in columns])
        there = ~np.isnan(values)
        person, column = np.nonzero(there)
        return values[there], (column == 0).astype(float), person.astype(float)

    def crossed(self) -> tuple[Column, Column, Column, Column]:
        """Every rating with its participant, its item and its place."""
        there = ~np.isnan(self.ratings())
        person, item = np.nonzero(there)
        return self.ratings()[there], person.astype(float), item.astype(float), self.places()[there]

    def yes(self, column: str) -> tuple[int, int]:
        """How many answered 1, and how many answered."""
        values = self[column]
        return int(np.nansum(values)), int((~np.isnan(values)).sum())

    def pairs(self) -> McNemar:
        """The choices at both levels."""
        return mcnemar(self["high"], self["low"])


def read(name: str) -> Table:
    """One of the data sets, without the participants left out."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if name != "excluded" or row["kept"] == "1"]
    return Table({
        column: np.array([float(row[column] or "nan") for row in rows])
        for column in rows[0] if column != "participant"
    })  # fmt: skip


def test_of(result: TTest) -> Numbers:
    """T, df and p."""
    return None if result.t is None else (result.t, result.df, result.p)


@dataclass(frozen=True)
class Reference:
    """What R is asked, and our answer."""

    r: str
    ours: Callable[[Table], Numbers]
    tolerance: float = CLOSED


def _t_tests() -> list[Reference]:
    found = []
    for theirs, ours in SIDES.items():
        found += [
            Reference(f"test(t.test(joy, mu = 3, alternative = '{theirs}'))",
                      lambda d, a=ours: test_of(one_sample_t(d["joy"], 3, a))),
            Reference(f"test(t.test(joy, fear, var.equal = TRUE, alternative = '{theirs}'))",
                      lambda d, a=ours: test_of(student_t(d["joy"], d["fear"], a))),
            Reference(f"test(t.test(joy, fear, alternative = '{theirs}'))",
                      lambda d, a=ours: test_of(welch_t(d["joy"], d["fear"], a))),
            Reference(f"test(t.test(joy, fear, paired = TRUE, alternative = '{theirs}'))",
                      lambda d, a=ours: test_of(paired_t(d["joy"], d["fear"], a))),
            Reference(f"test(t.test(high, low, var.equal = TRUE, alternative = '{theirs}'))",
                      lambda d, a=ours: test_of(student_t(d["high"], d["low"], a))),
        ]  # fmt: skip
    return found


REFERENCES = [
    *_t_tests(),
    Reference("t.test(flat, mu = 3)$p.value", lambda d: test_of(one_sample_t(d["flat"], 3))),
    Reference("t.test(always, never, var.equal = TRUE)$p.value",
              lambda d: test_of(student_t(d["always"], d["never"]))),
    Reference("t.test(always, never)$p.value", lambda d: test_of(welch_t(d["always"], d["never"]))),
    Reference("t.test(joy, mu = 3)$conf.int", lambda d: one_sample_t(d["joy"], 3).ci95),
    Reference("t.test(joy, fear, var.equal = TRUE)$conf.int", lambda d: student_t(d["joy"], d["fear"]).ci95),
    Reference("t.test(joy, fear)$conf.int", lambda d: welch_t(d["joy"], d["fear"]).ci95),
    Reference("t.test(joy, fear, paired = TRUE)$conf.int", lambda d: paired_t(d["joy"], d["fear"]).ci95),
    Reference("cohens_d(there(joy), mu = 3)$Cohens_d", lambda d: [one_sample_t(d["joy"], 3).d]),
    Reference("cohens_d(there(joy), there(fear))$Cohens_d", lambda d: [student_t(d["joy"], d["fear"]).d]),
    Reference("cohens_d(there(joy), there(fear), pooled_sd = FALSE)$Cohens_d",
              lambda d: [welch_t(d["joy"], d["fear"]).d]),
    Reference("p <- pairs(joy, fear); cohens_d(p$x, p$y, paired = TRUE)$Cohens_d",
              lambda d: [paired_t(d["joy"], d["fear"]).d]),
    Reference("p <- pairs(joy, fear); mean(p$d) / sqrt((var(p$x) + var(p$y)) / 2)",
              lambda d: [d_av(d["joy"], d["fear"])]),
    Reference("hedges_g(there(joy), mu = 3)$Hedges_g", lambda d: [one_sample_t(d["joy"], 3).g]),
    Reference("hedges_g(there(joy), there(fear))$Hedges_g", lambda d: [student_t(d["joy"], d["fear"]).g]),
    Reference("t <- t.test(joy, mu = 3); ncp(t, 1 / sqrt(t$parameter + 1))",
              lambda d: one_sample_t(d["joy"], 3).d_ci95, NONCENTRAL),
    Reference("t <- t.test(joy, mu = 3); J(t$parameter) * ncp(t, 1 / sqrt(t$parameter + 1))",
              lambda d: one_sample_t(d["joy"], 3).g_ci95, NONCENTRAL),
    Reference("t <- t.test(joy, fear, var.equal = TRUE); "
              "ncp(t, sqrt(1 / length(there(joy)) + 1 / length(there(fear))))",
              lambda d: student_t(d["joy"], d["fear"]).d_ci95, NONCENTRAL),
    Reference("t <- t.test(joy, fear, paired = TRUE); ncp(t, 1 / sqrt(t$parameter + 1))",
              lambda d: paired_t(d["joy"], d["fear"]).d_ci95, NONCENTRAL),
    *(
        Reference(f"w <- wilcoxsign_test(there(joy) ~ rep(3, length(there(joy))), zero.method = '{theirs}', "
                  f"alternative = 'greater'{exact}); pvalue(w)",
                  lambda d, z=ours, e=exact: [getattr(wilcoxon(d["joy"], 3, "greater", zeros=z),
                                                      "p_exact" if e else "p")])
        for theirs, ours in (("Pratt", "pratt"), ("Wilcoxon", "wilcoxon"))
        for exact in ("", ", distribution = exact()")
    ),
    Reference("p <- pairs(joy, fear); w <- wilcoxsign_test(p$x ~ p$y, zero.method = 'Pratt'); "
              "c(statistic(w), pvalue(w))",
              lambda d: [(w := wilcoxon(d["joy"] - d["fear"])).z, w.p]),
    Reference("x <- there(joy) - 3; r <- rank(abs(x))[x != 0]; s <- sign(x[x != 0]); sum(r * s) / sum(r)",
              lambda d: [wilcoxon(d["joy"], 3).rank_biserial]),
    *(
        Reference(f"x <- there(joy); perm.test(x, rep(3, length(x)), paired = TRUE, exact = TRUE, "
                  f"alternative = '{theirs}')$p.value",
                  lambda d, a=ours: [sign_flip(d["joy"], 3, a).p])
        for theirs, ours in SIDES.items()
    ),
    Reference("p <- pairs(joy, fear); perm.test(p$x, p$y, paired = TRUE, exact = TRUE)$p.value",
              lambda d: [sign_flip(d["joy"] - d["fear"]).p]),
    *(
        Reference(f"binom.test(sum(high, na.rm = TRUE), length(there(high)), 1 / {null}, '{theirs}')$p.value",
                  lambda d, n=null, a=ours: [binomial(*d.yes("high"), 1 / n, a).p])
        for null in (2, 6)
        for theirs, ours in SIDES.items()
    ),
    Reference("binom.test(sum(high, na.rm = TRUE), length(there(high)))$conf.int",
              lambda d: clopper_pearson(*d.yes("high"))),
    Reference("binom.test(sum(always), length(always))$conf.int",
              lambda d: clopper_pearson(*d.yes("always"))),
    Reference("wilson(there(high))",
              lambda d: wilson(*d.yes("high"))),
    Reference("i <- wilson(there(high)); "
              "j <- wilson(there(low)); "
              "p <- mean(high, na.rm = TRUE); q <- mean(low, na.rm = TRUE); "
              "p - q + c(-1, 1) * sqrt(c((p - i[1])^2 + (j[2] - q)^2, (i[2] - p)^2 + (q - j[1])^2))",
              lambda d: newcombe(*d.yes("high"), *d.yes("low")).ci95),
    *(
        Reference(f"fisher.test(counts(high, low), alternative = '{theirs}')$p.value",
                  lambda d, a=ours: [fisher(*d.yes("high"), *d.yes("low"), a).p])
        for theirs, ours in SIDES.items()
    ),
    Reference("fisher.test(counts(always, never))$p.value",
              lambda d: [fisher(*d.yes("always"), *d.yes("never")).p]),
    Reference("p <- pairs(high, low); b <- sum(p$d == 1); m <- sum(p$d != 0); "
              "c(binom.test(b, m, alternative = 'greater')$p.value, binom.test(b, m)$p.value)",
              lambda d: (d.pairs().p_one_sided, d.pairs().p_two_sided)),
    Reference("p <- pairs(high, low); b <- sum(p$d == 1); m <- sum(p$d != 0); k <- min(b, m - b); "
              "min(1, 2 * (pbinom(k, m, .5) - .5 * dbinom(k, m, .5)))", lambda d: [d.pairs().p_mid]),
    Reference("p <- pairs(high, low); i <- binom.test(sum(p$d == 1), sum(p$d != 0))$conf.int; i / (1 - i)",
              lambda d: d.pairs().odds_ratio_ci95),
    Reference("p <- pairs(high, low); n <- length(p$d); b <- (sum(p$d == 1) + 1) / (n + 2); "
              "c <- (sum(p$d == -1) + 1) / (n + 2); "
              "b - c + c(-1, 1) * qnorm(.975) * sqrt((b + c - (b - c)^2) / (n + 2))",
              lambda d: d.pairs().difference.ci95),
    *(
        Reference(f"p.adjust(sapply(d[items], function(x) t.test(x, mu = 3)$p.value), '{theirs}', n = 5)",
                  lambda d, c=ours: _adjusted(d, c))
        for theirs, ours in (("holm", "holm"), ("BH", "benjamini-hochberg"), ("bonferroni", "bonferroni"))
    ),
    Reference("m <- rows(d); f <- friedman.test(m); "
              "c(test(f), f$statistic / (nrow(m) * 3))",
              lambda d: [(f := friedman(d.ratings())).chi2, f.df, f.p, f.kendall_w]),
    Reference("m <- data.frame(rows(d)); "
              "a <- psych::alpha(m, warnings = FALSE); "
              "c(a$total$raw_alpha, a$feldt$lower.ci[[1]], a$feldt$upper.ci[[1]])",
              lambda d: [(a := cronbach_alpha(d.ratings())).estimate, *(a.ci95 or ())]),
    Reference("i <- ICC(t(rows(d)), lmer = FALSE)$results; "
              "c(i$ICC, i[['lower bound']], i[['upper bound']])",
              lambda d: [value for part in ("estimate", "low", "high") for value in _icc(d, part)]),
    *(
        Reference(f"kalpha(as.matrix(d[items]), '{metric}')",
                  lambda d, m=metric: [krippendorff_alpha(d.ratings(), m)])
        for metric in ("nominal", "ordinal", "interval")
    ),
    Reference("hits(d)", lambda d: confusion(d.ratings()[:, None, :])[0].tolist()),
    Reference("a <- hits(d, c('joy', 'fear')); b <- hits(d, c('anger', 'shame')); k <- rbind(a, b); "
              "c(k[1, 1]^2 / (sum(k[1, ]) * sum(k[, 1])), sum(k[1, ]) * sum(k[, 1]) / sum(k)^2)",
              lambda d: [(u := _hits(d)).hu, u.chance]),
    Reference("bca(there(joy + sqrt(seq_along(joy)) / 100))", lambda d: _bca(d["joy"])),
    Reference("bca(there(shame^2 + sqrt(seq_along(shame)) / 100))", lambda d: _bca(d["shame"] ** 2)),
    Reference("shuffled(rows(d), 1)",
              lambda d: [label_permutation(d.ratings(), 0).p]),
    Reference("max(t.test(joy, mu = 2.5, alternative = 'greater')$p.value, "
              "t.test(joy, mu = 4.5, alternative = 'less')$p.value)",
              lambda d: [equivalence(d["joy"], (2.5, 4.5)).p]),
    Reference("extractBF(ttestBF(there(joy), mu = 3))$bf",
              lambda d: [jzs_bayes_factor(one_sample_t(d["joy"], 3)).bf10], NONCENTRAL),
    Reference("extractBF(ttestBF(there(joy), mu = 3, nullInterval = c(0, Inf)))$bf[1]",
              lambda d: [jzs_bayes_factor(one_sample_t(d["joy"], 3, "greater")).bf10], NONCENTRAL),
    Reference("extractBF(ttestBF(there(joy), there(fear)))$bf",
              lambda d: [jzs_bayes_factor(student_t(d["joy"], d["fear"])).bf10], NONCENTRAL),
    Reference("p <- pairs(joy, fear); extractBF(ttestBF(p$x, p$y, paired = TRUE))$bf",
              lambda d: [jzs_bayes_factor(paired_t(d["joy"], d["fear"])).bf10], NONCENTRAL),
    Reference("l <- lm(y ~ p + s + place, shown(d)); c(summary(l)$coefficients['place', ], l$df.residual)",
              lambda d: [(e := position_effect(d.ratings(), d.places())).estimate, e.se, e.t, e.p, e.df]),
    Reference("s <- shown(d); s <- s[!is.na(s$before), ]; "
              "a <- anova(lm(y ~ p + s + place, s), lm(y ~ p + s + place + before, s)); "
              "c(a$F[2], a[['Pr(>F)']][2], a$Df[2], a$Res.Df[2])",
              lambda d: [(c := carry_over(d.ratings(), d.places())).f, c.p, *(c.df or ())]),
    Reference("g <- geeglm(y ~ x, binomial, long(d, c('high', 'low'), 1:0), id = p, corstr = 'exchangeable', "
              "control = geese.control(epsilon = 1e-13, maxit = 100)); "
              "unlist(summary(g)$coefficients['x', c(1, 2, 4)])",
              lambda d: [(g := gee_logistic(*d.long("high", "low"), bias_reduced=False)).effect, g.se, g.p],
              1e-8),
    Reference("g <- geeglm(y ~ x, binomial, long(d, c('high', 'low'), 1:0), id = p, corstr = 'exchangeable', "
              "control = geese.control(epsilon = 1e-13, maxit = 100)); mancl(g)[['x']]",
              lambda d: [gee_logistic(*d.long("high", "low"), bias_reduced=True).se], 1e-8),
    Reference("g <- glmer(y ~ x + (1 | p), long(d, c('high', 'low'), 1:0), binomial, nAGQ = 25); "
              "c(fixef(g), sqrt(vcov(g)[2, 2]), sqrt(VarCorr(g)$p[1]))",
              lambda d: [(m := logistic_mixed(*d.long("high", "low"))).intercept, m.effect, m.se,
                         m.participant_sd], ITERATED),
    Reference("c <- clmm(factor(y) ~ x + (1 | p), long(d, items, c(1, 0, 0, 0))); "
              "c(coef(c), sqrt(diag(vcov(c)))[['x']], c$ST$p[1], logLik(c))",
              lambda d: [*(c := cumulative_link_mixed(*d.long(*ITEMS))).thresholds, c.effect, c.se,
                         c.participant_sd, c.log_likelihood], ITERATED),
    Reference("m <- lmer(y ~ 1 + (1 | p) + (1 | s), shown(d)); s <- as.data.frame(VarCorr(m)); "
              "c(coef(summary(m))[1, ], s$sdcor[match(c('p', 's', 'Residual'), s$grp)], logLik(m))",
              lambda d: _mixed(linear_mixed(*d.crossed()[:3])), ITERATED),
    Reference("m <- lmer(y ~ place + (1 | p) + (1 | s), shown(d)); s <- as.data.frame(VarCorr(m)); "
              "c(coef(summary(m))[2, ], s$sdcor[match(c('p', 's', 'Residual'), s$grp)], logLik(m))",
              lambda d: _mixed(linear_mixed(*d.crossed())), ITERATED),
]  # fmt: skip


def _mixed(m: LinearMixed) -> Numbers:
    """As R's summary has them."""
    return [
        m.estimate,
        m.se,
        m.df,
        m.t,
        m.p,
        m.participant_sd,
        m.stimulus_sd,
        m.residual_sd,
        m.log_likelihood,
    ]


def _adjusted(d: Table, correction: Correction) -> Numbers:
    """P-values of the items, in a family with a test that has none."""
    family = {item: one_sample_t(d[item], 3).p for item in (*ITEMS, "flat")}
    return list(adjust(family, correction).values())[: len(ITEMS)]


def _icc(d: Table, part: str) -> list[float]:
    found = icc(d.ratings()[~np.isnan(d.ratings()).any(axis=1)].T)
    kinds = ("ICC1", "ICC2", "ICC3", "ICC1k", "ICC2k", "ICC3k")
    values = {
        "estimate": lambda one: one.estimate,
        "low": lambda one: one.ci95[0],
        "high": lambda one: one.ci95[1],
    }
    return [values[part](found[kind]) for kind in kinds]


def _hits(d: Table) -> Any:
    ratings = d.ratings()
    first, second = (confusion(ratings[:, None, columns])[0] for columns in ([0, 1], [2, 3]))
    return unbiased_hit_rates([first, second], [0, 1])[0]


def _bca(values: Column) -> Numbers:
    """The interval of the mean on 999 resamples that R can draw too, of values made to differ."""
    x = observed(values + np.sqrt(np.arange(1, values.size + 1)) / 100)
    u = np.sin(np.add.outer(np.arange(1, 1000) * 78.233, np.arange(1, x.size + 1) * 12.9898)) * 43758.5453
    means = x[np.floor(x.size * (u - np.floor(u))).astype(int)].mean(axis=1)
    return bca(means, float(x.mean()), acceleration_of_mean(x))


def work_out() -> dict[str, dict[str, list[float] | None]]:
    """Ask R for every number."""
    with NamedTemporaryFile("w", suffix=".txt", encoding="utf-8") as calls:
        calls.write("".join(f"{reference.r}\n" for reference in REFERENCES))
        calls.flush()
        sets = [FOLDER / f"{name}.csv" for name in DATA]
        program = Path(__file__).with_suffix(".R")
        done = subprocess.run(
            ["Rscript", program, calls.name, *sets], stdout=subprocess.PIPE, text=True, check=True
        )
    lines = iter(done.stdout.splitlines())
    return {name: {reference.r: _numbers(next(lines)) for reference in REFERENCES} for name in DATA}


def _numbers(line: str) -> list[float] | None:
    return None if line.strip() == "NULL" else [float(number) for number in line.split()]


if __name__ == "__main__":
    (FOLDER / "r.json").write_text(json.dumps(work_out(), indent=1) + "\n", encoding="utf-8")
