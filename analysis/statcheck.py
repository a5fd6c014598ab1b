"""Whether the p-values in a text follow from the statistics beside them.

After statcheck (Nuijten et al. 2016, Behavior Research Methods 48): the word "one-sided" or "one-tailed"
halves a p-value. The direction of a one-sided test is not printed, so either tail will do.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from scipy.special import chdtrc, fdtrc, ndtr, stdtr

from stimuli.errors import InputError

NUMBER = r"[−\-–]?\d*\.?\d+"
REPORTED = re.compile(
    rf"(?P<symbol>t|F|r|z|χ2|χ²|chi2)\s*(?:\(\s*(?P<df>{NUMBER}(?:\s*,\s*{NUMBER})?)[^)]*\))?\s*=\s*(?P<value>{NUMBER})"
    rf"\s*,\s*p\s*(?P<sign>[<>=])\s*(?P<p>{NUMBER})"
)
ONE_SIDED = re.compile(r"one[-\s](?:sided|tailed)", re.IGNORECASE)


@dataclass(frozen=True)
class Checked:
    """One reported test with the p-values its printed statistic allows."""

    line: int
    text: str
    low: float
    high: float
    consistent: bool
    decision_error: bool  # the printed p and the recomputed one lie on different sides of .05

    def __str__(self) -> str:
        between = f"{self.low:.3g}" if self.low == self.high else f"{self.low:.3g} to {self.high:.3g}"
        decision = "; the decision changes" if self.decision_error else ""
        return f"line {self.line}: {self.text}, but p is {between}{decision}"


@dataclass(frozen=True)
class Reading:
    """Every reported test of a text, recomputed."""

    checked: tuple[Checked, ...]

    @property
    def faults(self) -> tuple[Checked, ...]:
        """Those whose p does not follow from their statistic."""
        return tuple(one for one in self.checked if not one.consistent)

    def __str__(self) -> str:
        if not self.checked:
            return "No test in the form t(33) = 4.82, p < .001 is reported here."
        found = f"{len(self.checked)} reported tests recomputed, {len(self.faults)} inconsistent."
        return "\n".join([found, *(f"  {one}" for one in self.faults)])


def check_file(path: Path) -> Reading:
    """Recompute every reported test of a text file."""
    try:
        return Reading(tuple(check_text(path.read_text(encoding="utf-8-sig"))))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read as UTF-8 text: {error}") from error


def check_text(text: str, alpha: float = 0.05) -> list[Checked]:
    """Recompute every `t(33) = 4.82, p < .001` and its kin (F, r, z, χ²) in a text."""
    return [_check(match, text, alpha) for match in REPORTED.finditer(text) if _known(match)]


def _known(match: re.Match[str]) -> bool:
    return match["symbol"] == "z" or match["df"] is not None


def _check(match: re.Match[str], text: str, alpha: float) -> Checked:
    value, p = _decimal(match["value"]), _decimal(match["p"])
    half = Decimal(5).scaleb(-_places(value) - 1)
    one_sided = ONE_SIDED.search(_rest_of_sentence(text, match.end())) is not None
    df = [float(number) for number in (match["df"] or "").split(",") if number.strip()]
    tail = TAILS[match["symbol"]]
    allowed = [tail(float(edge), df) for edge in (max(abs(value) - half, Decimal(0)), abs(value) + half)]
    low, high = min(allowed), max(allowed)
    ranges = [(low / 2, high / 2), (1 - high / 2, 1 - low / 2)] if one_sided else [(low, high)]
    consistent = any(_agrees(match["sign"], p, *between) for between in ranges)
    said = p < Decimal(str(alpha)) or (match["sign"] == "<" and p <= Decimal(str(alpha)))
    decision = not any(said == (edge < alpha) for between in ranges for edge in between)
    best = ranges[0]
    return Checked(
        line=text.count("\n", 0, match.start()) + 1,
        text=match.group(0),
        low=best[0],
        high=best[1],
        consistent=consistent,
        decision_error=not consistent and decision,
    )


def _agrees(sign: str, p: Decimal, low: float, high: float) -> bool:
    if sign == "<":
        return low < float(p)
    if sign == ">":
        return high > float(p)
    half = 0.5 * 10.0 ** -_places(p)
    return low <= float(p) + half and high >= float(p) - half and p > 0


def _rest_of_sentence(text: str, start: int) -> str:
    end = re.search(r"[.;](?=\s|$)", text[start:])
    return text[start : start + end.start()] if end else text[start:]


def _decimal(text: str) -> Decimal:
    return Decimal(text.replace("−", "-").replace("–", "-"))


def _places(value: Decimal) -> int:
    exponent = value.as_tuple().exponent
    return -exponent if isinstance(exponent, int) else 0


def _of_r(value: float, df: list[float]) -> float:
    return 0.0 if value >= 1 else _of_t(value * (df[0] / (1 - value**2)) ** 0.5, df)


def _of_t(value: float, df: list[float]) -> float:
    return float(2 * stdtr(df[0], -value))


TAILS: dict[str, Callable[[float, list[float]], float]] = {  # two-sided p of a statistic ≥ 0
    "t": _of_t,
    "r": _of_r,
    "z": lambda value, df: float(2 * ndtr(-value)),  # noqa: ARG005
    "F": lambda value, df: float(fdtrc(df[0], df[1], value)),
    "χ2": lambda value, df: float(chdtrc(df[0], value)),
    "χ²": lambda value, df: float(chdtrc(df[0], value)),
    "chi2": lambda value, df: float(chdtrc(df[0], value)),
}
