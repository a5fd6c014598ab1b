"""Whether the p-values in a text follow from the statistics beside them.

After statcheck (Nuijten et al. 2016, Behavior Research Methods 48). Where a text leaves more than one reading
open, any of them will do: a false alarm costs more than a miss.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Decimal
from itertools import product
from pathlib import Path

from scipy.special import chdtrc, fdtrc, ndtr, stdtr

from stimuli.errors import InputError

MINUS = "−–-"
NUMBER = rf"[{MINUS}]?\d*\.?\d+"
EITHER = rf"[{MINUS}]?\d*[.,]?\d+"  # with a point or, as in German, a comma
POWER = rf"(?:[eE][{MINUS}]?\d+|\s*[×x·]\s*10\s*\^?\s*\{{?[{MINUS}]\d+\}}?)?"  # 1.2e-5, 1.2 × 10^-5
EFFECT = (
    rf"(?:d|dz|g|r|SE|b|B|β|η2|η²|ηp2|ηp²|ω2|ω²|V|W|M|SD|MSE)\s*=\s*{NUMBER}"
    r"|\d\d\s*%\s*CI\s*[:=]?\s*\[[^\]]*\]"
)
REPORTED = re.compile(
    rf"(?<![\w.])(?P<symbol>t|F|r|z|Z|H|[χΧX]\s?\^?\s?[2²]|chi2|chi-squared?)"
    rf"\s*(?:(?:\(|(?<![rzZH])\{{(?=\d\d|\d+\s*,))\s*(?:df\s*=\s*)?(?P<df>{NUMBER}(?:\s*,\s*{NUMBER})?)[^)}}]*[)}}])?"
    rf"\s*=\s*(?P<value>{EITHER})(?![\d.])"
    rf"(?:\s*[,;]\s*(?:{EFFECT}))*\s*[,;:]?\s*\(?\s*"
    rf"[pP](?:[\s-]value)?\s*(?P<sign>[<>=≤≥])\s*(?P<p>{EITHER}{POWER})"
)
ONE_SIDED = re.compile(r"one[-\s](?:sided|tailed)|directional|einseitig", re.IGNORECASE)
TWO_SIDED = re.compile(r"two[-\s](?:sided|tailed)|zweiseitig", re.IGNORECASE)
OTHER_P = re.compile(rf"[\w-]*(?:adjusted|corrected)\s+p\s*[<>=≤≥]\s*{NUMBER}", re.IGNORECASE)
CORRECTED = re.compile(r"adjust|correct|bonferroni|holm|hochberg|greenhouse|huynh", re.IGNORECASE)
LATEX = {  # and HTML
    r"\\chi\s*\^?\{?2\}?": "χ2",
    r"\\(?:times|cdot)(?![a-z])": "×",
    r"\\leq?(?:slant)?(?![a-z])": "≤",
    r"\\geq?(?:slant)?(?![a-z])": "≥",
    r"&lt;": "<",
    r"&gt;": ">",
    r"\\[,;:! ]|~": " ",
    r"(?<=[<>=≤≥])\s*10\s*(?=\^)": "1×10",
}
TABLE = re.compile(
    r"\\begin\{(?:tabular|longtable)|^[ \t:|-]*-[ \t:-]*\|[ \t:|-]*$|<table",
    re.MULTILINE | re.IGNORECASE,
)
MARKUP = re.compile(
    r"\\(?:textit|textbf|emph|mathit|mathrm|text)\{([^{}\n]*)\}|[*$]|(?<!\w)_(?=\w)|(?<=\w)_(?!\w)"
)


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
    tables: int = 0  # which are not read

    @property
    def faults(self) -> tuple[Checked, ...]:
        """Those whose p does not follow from their statistic."""
        return tuple(one for one in self.checked if not one.consistent)

    def __str__(self) -> str:
        n, bad = len(self.checked), len(self.faults)
        found = f"{n} reported test{'s' * (n > 1)} recomputed, {bad} inconsistent."
        if not self.checked:
            found = "No test in the form t(33) = 4.82, p < .001 is reported here."
        return "\n".join([found, *(f"  {one}" for one in self.faults), *self._unread()])

    def _unread(self) -> Iterator[str]:
        if self.tables:
            what, it = ("1 table was", "it") if self.tables == 1 else (f"{self.tables} tables were", "them")
            yield f"{what} not read: say how many participants are behind {it}, as in -n 34."


def read_text(path: Path) -> str:
    """What a text file says. Raises InputError."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is no UTF-8 text (a PDF or Word file?); save it as plain text") from error


def tables_in(text: str) -> int:
    """How many tables a text has."""
    return len(TABLE.findall(text))


def check_text(text: str, alpha: float = 0.05) -> list[Checked]:
    """Recompute every `t(33) = 4.82, p < .001` and its kin (F, r, z, χ², H) in a text, plain or marked up.

    A test called one-sided (or two-sided) right beside it is taken at its word; where the text speaks of
    one-sided tests elsewhere, either will do. A p that is called corrected may be larger than recomputed.
    """
    plain = text
    for written, meant in LATEX.items():
        plain = re.sub(written, meant, plain)
    plain = MARKUP.sub(lambda match: match.group(1) or "", plain)
    return list(_each(plain, alpha))


def _each(text: str, alpha: float) -> Iterator[Checked]:
    for match in REPORTED.finditer(text):
        symbol = SYMBOLS.get(match["symbol"][0], match["symbol"])
        df = [_decimal(number) for number in (match["df"] or "").split(",") if number.strip()]
        if (
            len(df) >= NEEDED[symbol]
            and 0 <= _p_value(match["p"]) <= 1
            and not (symbol == "t" and len(df) > 1)
        ):
            yield _check(match, symbol, df, text, alpha)


def _check(match: re.Match[str], symbol: str, df: list[Decimal], text: str, alpha: float) -> Checked:
    value, p = _decimal(match["value"]), _p_value(match["p"])
    corners = product(_rounded(abs(value)), *(_rounded(one) if _places(one) else (float(one),) for one in df))
    allowed = sorted(TAILS[symbol](edge, [*dfs]) for edge, *dfs in corners)
    ranges = list(_readings(match, (allowed[0], allowed[-1]), text, sided=symbol != "F" or df[0] == 1))
    consistent = any(_agrees(match["sign"], p, *between) for between in ranges)
    if not consistent and _is_corrected(match, text):
        consistent = match["sign"] not in "<≤" and float(p) > ranges[0][0]
    said = p < Decimal(str(alpha)) or (match["sign"] in "<≤" and p <= Decimal(str(alpha)))
    decision = not any(said == (edge < alpha) for between in ranges for edge in between)
    return Checked(
        line=text.count("\n", 0, match.start()) + 1,
        text=" ".join(match.group(0).split()),
        low=ranges[0][0],
        high=ranges[0][1],
        consistent=consistent,
        decision_error=not consistent and decision,
    )


def _readings(
    match: re.Match[str], two_sided: tuple[float, float], text: str, *, sided: bool
) -> Iterator[tuple[float, float]]:
    """The ranges of p that the words allow, the most literal first; of a one-sided test either tail."""
    low, high = two_sided
    beside = _rest_of_sentence(text, match.end()).split(" p ")[0]
    one = [(low / 2, high / 2), (1 - high / 2, 1 - low / 2)] if sided else []
    if ONE_SIDED.search(beside) and one:
        yield from one
    else:
        yield two_sided
        if not TWO_SIDED.search(beside) and ONE_SIDED.search(text):
            yield from one


def _is_corrected(match: re.Match[str], text: str) -> bool:
    """Whether the sentence calls this p corrected; a corrected p of its own beside it does not count."""
    start = max(text.rfind(end, 0, match.start()) for end in (". ", ".\n", "; ", "\n\n"))
    sentence = text[start + 1 : match.start()] + OTHER_P.sub("", _rest_of_sentence(text, match.end()))
    return CORRECTED.search(sentence) is not None


def _agrees(sign: str, p: Decimal, low: float, high: float) -> bool:
    if sign in "<≤":
        return low < float(p)
    if sign in ">≥":
        return high > float(p)
    half = float(Decimal(5).scaleb(-_places(p) - 1))
    return low <= float(p) + half and high >= float(p) - half and p > 0


def _rest_of_sentence(text: str, start: int) -> str:
    end = re.search(r"[.;](?=\s|$)", text[start:])
    return text[start : start + end.start()] if end else text[start:]


def _decimal(text: str) -> Decimal:
    return Decimal(re.sub(f"[{MINUS}]", "-", text.strip()).replace(",", "."))


def _rounded(printed: Decimal) -> tuple[float, float]:
    """The least and the greatest number that is printed so."""
    half = Decimal(5).scaleb(-_places(printed) - 1)
    return float(max(printed - half, Decimal(0))), float(printed + half)


def _p_value(text: str) -> Decimal:
    """A printed probability, in powers of ten if need be."""
    mantissa, _, exponent = re.sub(r"\s*[×x·]\s*10\s*\^?\s*\{?", "e", text).rstrip("}").lower().partition("e")
    return _decimal(mantissa).scaleb(int(_decimal(exponent or "0")))


def _places(value: Decimal) -> int:
    exponent = value.as_tuple().exponent
    return -exponent if isinstance(exponent, int) else 0


def _of_r(value: float, df: list[float]) -> float:
    return 0.0 if value >= 1 else _of_t(value * (df[0] / (1 - value**2)) ** 0.5, df)


def _of_t(value: float, df: list[float]) -> float:
    return float(2 * stdtr(df[0], -value))


SYMBOLS = {"Z": "z", "χ": "χ²", "Χ": "χ²", "X": "χ²", "c": "χ²", "H": "χ²"}  # by first letter
NEEDED = {"t": 1, "r": 1, "z": 0, "F": 2, "χ²": 1}  # degrees of freedom
TAILS: dict[str, Callable[[float, list[float]], float]] = {  # two-sided p of a statistic ≥ 0
    "t": _of_t,
    "r": _of_r,
    "z": lambda value, df: float(2 * ndtr(-value)),  # noqa: ARG005
    "F": lambda value, df: float(fdtrc(df[0], df[1], value)),
    "χ²": lambda value, df: float(chdtrc(df[0], value)),
}
