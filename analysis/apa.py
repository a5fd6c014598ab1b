"""Numbers and sentences as the APA manual has them (7th edition, chapter 6)."""

from __future__ import annotations

import re
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

from analysis.statistics.t_test import Alternative, TTest

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
TOGETHER = re.compile(r" [=<>] |95% CI \[[^\]]*\]|F\([^)]*\)")
SIDES: dict[Alternative, str] = {
    "greater": "one-sided",
    "less": "one-sided",
    "two-sided": "two-sided",
}


def number(value: float | None, decimals: int = 2) -> str:
    """A number with fixed decimals, never "-0.00"; a dash where there is none."""
    if value is None:
        return "–"
    text = f"{value:.{decimals}f}"
    return text.removeprefix("-") if float(text) == 0 else text.replace("-", "−")


def bounded(value: float | None, decimals: int = 2) -> str:
    """A number that cannot exceed 1, without its leading zero: .79, −.12, 1.00."""
    text = number(value, decimals)
    return text.replace("0.", ".", 1) if text.lstrip("−").startswith("0.") else text


def probability(p: float | None, alpha: float = 0.05) -> str:
    """A p-value with its sign: "= .014", "< .001"; a fourth decimal close to alpha."""
    if p is None:
        return "undefined"
    if p < 0.001:
        return "< .001"
    if p > 0.999:
        return "> .999"
    return f"= {bounded(p, 4 if abs(p - alpha) < 0.0005 else 3)}"


def significance(alpha: float) -> str:
    """A level of significance with all its digits: .05, .0167."""
    return f"{alpha:.4f}".rstrip("0").removeprefix("0")


def degrees(df: float | None) -> str:
    """Degrees of freedom: whole where they are, else to two decimals."""
    if df is None:
        return "–"
    return str(round(df)) if abs(df - round(df)) < 1e-9 else f"{df:.2f}"


def unbroken(sentence: str) -> str:
    """A sentence that is not broken within "p = .014", "95% CI [0.06, 1.03]" or "F(5, 125)"."""
    return TOGETHER.sub(lambda found: found[0].replace(" ", "\u00a0"), sentence)


def factor(value: float | None) -> str:
    """A Bayes factor: 18.69, 2.0 × 10⁶."""
    if value is None:
        return "–"
    if 0.001 <= value < 1000:
        return number(value)
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa} × 10{str(int(exponent)).translate(RAISED)}"


def interval(limits: tuple[float | None, float | None] | None, decimals: int = 2) -> str:
    """A confidence interval, "[0.43, 1.21]"; ∞ where a limit is unbounded."""
    if limits is None:
        return "–"
    low, high = limits
    return f"[{number(low, decimals)}, {'∞' if high is None else number(high, decimals)}]"


def estimate(value: float | None, limits: tuple[float | None, float | None] | None) -> str:
    """An estimate and its interval, as far as there are any.

    >>> print(estimate(0.68, (0.19, 1.17)), estimate(3, None), estimate(None, None))
    0.68 [0.19, 1.17] 3.00 –
    """
    return number(value) if limits is None else f"{number(value)} {interval(limits)}"


def share(count: int, total: int, decimals: int = 2) -> str:
    """count/total rounded half up from the exact fraction, "0.79"; a dash for 0/0."""
    if total == 0:
        return "–"
    exact = Fraction(count, total) * 10**decimals
    rounded = int(exact + Fraction(1, 2))
    return str((Decimal(rounded) / 10**decimals).quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP))


def t_sentence(
    result: TTest, p_adjusted: float | None = None, alpha: float = 0.05, adjustment: str = ""
) -> str:
    """One t-test: t(33) = 4.82, p < .001, one-sided, d = 0.83, 95% CI [0.43, 1.21]."""
    n = ", ".join(f"n = {size}" for size in result.n) if len(result.n) > 1 else f"N = {result.n[0]}"
    if result.t is None:
        df = f", df = {degrees(result.df)}" if result.df is not None else ""
        return f"t {result.reason}{df}, {n}"
    adjusted = f", {adjustment} p {probability(p_adjusted, alpha)}" if p_adjusted is not None else ""
    found = f"t({degrees(result.df)}) = {number(result.t)}, p {probability(result.p, alpha)}"
    effect = f"d = {number(result.d)}, 95% CI {interval(result.d_ci95)}"
    return f"{found}, {SIDES[result.alternative]}, {effect}{adjusted}, {n}"
