"""Tables for a paper: LaTeX in the form of the published one, and the same numbers as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

from analysis.apa import degrees, interval, number, probability, share, significance, unbroken
from analysis.levels import Choices, Compared
from analysis.plan import Levels, Targets
from analysis.statistics.t_test import TTest

SPECIAL = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "<": "$<$", ">": "$>$", "−": "$-$", "∞": r"$\infty$", "–": "--", "“": "``", "”": "''", "\u00a0": "~",
}  # fmt: skip


ARROWS = {"higher": r"$\uparrow$", "lower": r"$\downarrow$"}


def escaped(text: str) -> str:
    """Text that LaTeX prints as it stands."""
    return "".join(SPECIAL.get(character, character) for character in text)


def confusion_latex(outcome: Levels, note: str = "") -> str:
    """Normalised confusion matrices of intended and perceived level, in the paper's form, with counts.

    Needs the packages amsmath, booktabs and diagbox. A row whose printed shares do not add up to 1.00 is
    named in the note.
    """
    judged = [(one, one.choices) for one in outcome.results.values() if one.choices is not None]
    pairs = "|".join(["cc"] * len(judged))
    rules = ["c|"] * (len(judged) - 1) + ["c"]
    heads = [
        rf"\multicolumn{{2}}{{{rule}}}{{$\mathcal{{P}}_{{\text{{{escaped(_label(one))}}}}}$}}"
        for rule, (one, _) in zip(rules, judged, strict=True)
    ]
    answers = (outcome.comparison.outcome, outcome.comparison.other)
    up, down = (ARROWS.get(answer or "", escaped(answer or "")) for answer in answers)
    arrows = " & ".join([rf"\multicolumn{{1}}{{c}}{{{up}}} & {down}"] * len(judged))
    lines = [
        r"% packages: amsmath, booktabs, diagbox",
        r"\begin{table}",
        r"  \centering",
        r"  \footnotesize",
        r"  \setlength{\tabcolsep}{1.8pt}",
        rf"  \begin{{tabular}}{{c|{pairs}}}",
        r"    \toprule",
        f"    & {' & '.join(heads)} \\\\",
        r"    \midrule",
        rf"    \diagbox[width=3em, height=2em]{{$I_M$}}{{$I_P$}} & {arrows} \\",
        r"    \midrule",
    ]
    found = escaped(unbroken(confusion_note(outcome))).replace(" p~", " $p$~")
    for level in outcome.comparison.levels:
        own = outcome.comparison.levels.index(level)
        shares, counts = [], []
        for _, choices in judged:
            row = choices.counts[level]
            shares += [_cell(share(k, sum(row)), bold=place == own) for place, k in enumerate(row)]
            counts += [rf"$\scriptscriptstyle {k}$" for k in row]
        lines += [
            f"    {escaped(level)} & {' & '.join(shares)} \\\\",
            rf"    $\scriptscriptstyle n$ & {' & '.join(counts)} \\",
        ]
    lines += [
        r"    \bottomrule",
        r"  \end{tabular}",
        rf"  \caption{{{noted(note)}"
        r"Normalized confusion matrices for intensity-scaled principles: intended ($I_M$) against "
        rf"perceived intensity ($I_P$), with counts. {found}}}",
        rf"  \label{{tab:{outcome.name}}}",
        r"\end{table}",
    ]
    return "\n".join(lines) + "\n"


def confusion_note(outcome: Levels) -> str:
    """N, test, and p per principle, in words."""
    judging = outcome.judging
    sizes = sorted(
        {sum(row) for one in outcome.results.values() if one.choices for row in one.choices.counts.values()}
    )
    n = str(sizes[0]) if len(sizes) == 1 else f"{sizes[0]} to {sizes[-1]}"
    found = [
        f"{_label(one)} p {probability(one.verdict.p_adjusted, judging.alpha)}"
        + (f" ({one.verdict.test})" if one.verdict.note else "")
        for one in outcome.results.values()
    ]
    uneven = [
        f"{_label(one)}/{level}"
        for one in outcome.results.values()
        if one.choices
        for level, row in one.choices.counts.items()
        if sum(row) and sum(round(100 * float(share(k, sum(row)))) for k in row) != 100
    ]
    return (
        f"N = {n} per cell; {judging.named}, {judging.sides}, alpha = {significance(judging.alpha)}, "
        f"{judging.adjustment}: "
        + ", ".join(found)
        + "."
        + (f" Rounded shares do not add up to 1.00 in {', '.join(uneven)}." if uneven else "")
    )


def confusion_csv(outcome: Levels, note: str = "") -> str:
    """Counts, shares and tests, one row per principle and level."""
    chosen, other = outcome.comparison.outcome, outcome.comparison.other
    head = (
        "principle", "level", "n", f"{chosen}", f"{other}", f"share_{chosen}", "share_ci_low",
        "share_ci_high", "t", "df", "p", "p_adjusted", "decided_by", "d", "d_ci_low", "d_ci_high",
        "mcnemar_p", "mcnemar_p_mid", "fisher_p", "binomial_p",
    )  # fmt: skip
    rows = []
    for one in outcome.results.values():
        if one.choices is None:
            continue
        for place, (level, (k, rest)) in enumerate(one.choices.counts.items()):
            counted = (one.name, level, k + rest, k, rest)
            rows.append(
                (
                    *counted,
                    *_own_share(one.choices, level, place),
                    *_tested(one),
                    *_exact(one.choices, level),
                )
            )
    return as_csv(head, rows, note)


def targets_csv(outcome: Targets, note: str = "") -> str:
    """The test of every target, one row per stimulus."""
    head = (
        "stimulus", "item", "n", "mean", "sd", "se", "chance", "t", "df", "p", "p_adjusted", "decided_by",
        "d", "d_ci_low", "d_ci_high", "exact_p", "wilcoxon_z", "wilcoxon_p",
    )  # fmt: skip
    rows = []
    for one in outcome.results.values():
        test = one.against.t_test
        d = (test.d, *(test.d_ci95 or (None, None)))
        summary = (one.summary.n, one.summary.mean, one.summary.sd, one.summary.se)
        tested = (test.t, test.df, one.against.test.p, one.verdict.p_adjusted, one.verdict.test, *d)
        exact = (one.against.exact.p, one.wilcoxon.z, one.wilcoxon.p_decisive)
        rows.append((one.stimulus, one.item, *summary, one.against.null, *tested, *exact))
    return as_csv(head, rows, note)


def means_csv(outcome: Targets, note: str = "") -> str:
    """Mean, SD and SE of every item for every stimulus."""
    rows = [
        (stimulus, item, one.n, one.mean, one.sd, one.se)
        for stimulus, items in outcome.means.items()
        for item, one in items.items()
    ]
    return as_csv(("stimulus", "item", "n", "mean", "sd", "se"), rows, note)


def targets_latex(outcome: Targets, note: str = "") -> str:
    """Mean target ratings and their tests. Needs the package booktabs."""
    lines = [
        r"% packages: booktabs",
        r"\begin{table}",
        r"  \centering",
        r"  \footnotesize",
        r"  \setlength{\tabcolsep}{3pt}",
        r"  \begin{tabular}{lrrrrrrr}",
        r"    \toprule",
        r"    & $N$ & $M$ & $SD$ & $t$ & $df$ & $p$ & $d$ [95\% CI] \\",
        r"    \midrule",
    ]
    for one in outcome.results.values():
        test = one.against.t_test
        p = probability(one.verdict.p_adjusted, outcome.judging.alpha).removeprefix("= ")
        lines.append(
            f"    {escaped(one.stimulus.capitalize())} & {one.summary.n} & "
            f"{in_math(number(one.summary.mean))} & {in_math(number(one.summary.sd))} & "
            f"{in_math(number(test.t))} & "
            f"{in_math(degrees(test.df))} & {in_math(p)} & "
            f"{_effect(test)} \\\\"
        )
    judging = outcome.judging
    lines += [
        r"    \bottomrule",
        r"  \end{tabular}",
        rf"  \caption{{{noted(note)}Ratings of the intended expression against chance "
        rf"({escaped(outcome.definition.says)}); {judging.named}, {judging.sides}, "
        rf"$p$ {judging.adjustment}.{_decided_otherwise(outcome)}}}",
        rf"  \label{{tab:{outcome.name}}}",
        r"\end{table}",
    ]
    return "\n".join(lines) + "\n"


def compared_csv(outcome: Levels, note: str = "") -> str:
    """The ratings compared: mean, SD and SE at each level, and the tests."""
    head = (
        "name", "level", "n", "mean", "sd", "se", "t", "df", "p", "p_adjusted", "decided_by", "d", "d_ci_low",
        "d_ci_high", "welch_p", "paired_p", "wilcoxon_p",
    )  # fmt: skip
    rows = [
        (one.name, level, m.n, m.mean, m.sd, m.se, *_tested(one), *others)
        for one in outcome.results.values()
        for others in [(one.welch.p, one.paired.p, one.wilcoxon.p_decisive)]
        for level, m in one.summaries.items()
    ]
    return as_csv(head, rows, note)


def compared_latex(outcome: Levels, note: str = "") -> str:
    """Mean ratings at both levels and their tests. Needs the package booktabs."""
    first, second = (escaped(level.capitalize()) for level in outcome.comparison.levels)
    lines = [
        r"% packages: booktabs",
        r"\begin{table}",
        r"  \centering",
        r"  \footnotesize",
        r"  \setlength{\tabcolsep}{3pt}",
        r"  \begin{tabular}{lrrrrrr}",
        r"    \toprule",
        rf"    & {first} & {second} & $t$ & $df$ & $p$ & $d$ [95\% CI] \\",
        r"    \midrule",
    ]
    for one in outcome.results.values():
        test = one.deciding_t
        p = probability(one.verdict.p_adjusted, outcome.judging.alpha).removeprefix("= ")
        means = (f"{in_math(number(m.mean))} ({in_math(number(m.sd))})" for m in one.summaries.values())
        lines.append(
            f"    {escaped(_label(one))} & {' & '.join(means)} & {in_math(number(test.t))} & "
            f"{in_math(degrees(test.df))} & {in_math(p)} & "
            f"{_effect(test)} \\\\"
        )
    judging = outcome.judging
    sizes = "; ".join(
        f"{escaped(_label(one))} $n$~=~{', '.join(str(m.n) for m in one.summaries.values())}"
        for one in outcome.results.values()
    )
    lines += [
        r"    \bottomrule",
        r"  \end{tabular}",
        rf"  \caption{{{noted(note)}Ratings compared, $M$ ($SD$): {judging.named}, {judging.sides}, "
        rf"$p$ {judging.adjustment}. {sizes}.{_decided_otherwise(outcome)}}}",
        rf"  \label{{tab:{outcome.name}}}",
        r"\end{table}",
    ]
    return "\n".join(lines) + "\n"


def noted(note: str) -> str:
    """What a caption says of answers that are no data."""
    return rf"\textbf{{{escaped(note)}.}} " if note else ""


def in_math(text: str) -> str:
    """A number as LaTeX sets it."""
    return "--" if text == "–" else f"${text.replace('−', '-').replace('∞', chr(92) + 'infty')}$"


def _effect(test: TTest) -> str:
    """The size of an effect with its interval."""
    return "--" if test.d is None else f"{in_math(number(test.d))} {in_math(interval(test.d_ci95))}"


def _decided_otherwise(outcome: Targets | Levels) -> str:
    """Which rows another test than the declared one decided."""
    replaced: dict[str, list[str]] = {}
    for name, one in outcome.results.items():
        if one.verdict.note:
            replaced.setdefault(one.verdict.test, []).append(escaped(name.capitalize()))
    return "".join(f" {', '.join(names)}: {test} test." for test, names in replaced.items())


def _cell(text: str, *, bold: bool) -> str:
    return rf"$\scriptstyle\mathbf{{{text}}}$" if bold else rf"$\scriptstyle {text}$"


def _label(one: Compared) -> str:
    return one.name.capitalize()


def _own_share(choices: Choices, level: str, place: int) -> tuple[float | None, float | None, float | None]:
    """Share of the outcome with its Wilson interval; the second level's binomial test counts the other."""
    test = choices.binomial[level]
    if test.estimate is None or test.wilson_ci95 is None:
        return None, None, None
    low, high = test.wilson_ci95
    return (test.estimate, low, high) if place == 0 else (1 - test.estimate, 1 - high, 1 - low)


def _tested(one: Compared) -> tuple[object, ...]:
    test, verdict = one.deciding_t, one.verdict
    return (test.t, test.df, test.p, verdict.p_adjusted, verdict.test, test.d, *(test.d_ci95 or (None, None)))


def _exact(choices: Choices, level: str) -> tuple[object, ...]:
    test, exact = choices.mcnemar, choices.fisher
    return test.p(exact.alternative), test.p_mid, exact.p, choices.binomial[level].p


def as_csv(head: Sequence[str], rows: Iterable[Sequence[object]], note: str) -> str:
    """The rows below their head; what is no data says so in a last column."""
    extra = [note] if note else []
    file = io.StringIO(newline="")
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow([*head, *(["note"] if note else [])])
    writer.writerows([*("" if value is None else value for value in row), *extra] for row in rows)
    return file.getvalue()
