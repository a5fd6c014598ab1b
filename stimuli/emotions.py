"""How emotions show in motion: which descriptors should move which way against neutral, and who found so.

A direction is found in the literature where a paper's abstract states it; all others are chosen for this
robot. Hurry is no emotion; it stands for Timing alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from stimuli.descriptors import DESCRIPTORS

SOURCES = {
    "Gross": "Gross, M. M., Crane, E. A. & Fredrickson, B. L. (2012). Effort-Shape and kinematic assessment "
    "of bodily expression of emotion during gait. Hum. Mov. Sci. 31, 202–221.",
    "Halovic": "Halovic, S. & Kroos, C. (2018). Not all is noticed: Kinematic cues of emotion-specific gait. "
    "Hum. Mov. Sci. 57, 478–488.",
    "Beck": "Beck, A., Cañamero, L., Hiolle, A., Damiano, L., Cosi, P., Tesser, F. & Sommavilla, G. (2013). "
    "Interpretation of emotional body language displayed by a humanoid robot: a case study with children. "
    "Int. J. Soc. Robot. 5, 325–334.",
}

EVIDENCE = (
    "Gross et al. and Halovic & Kroos measured people who walked: fastest in joy and anger, slowest in "
    "sadness, with more movement of the arms in joy and anger (Gross et al.: than in sadness) and less in"
    " sadness and fear, neck and thorax bent in sadness. A bent neck counts here as a lower gaze, a bent "
    "thorax as a head further ahead. Beck et al. sum up that a robot's head held down lowers perceived "
    "arousal and valence and one held up raises both."
)
CHOICES = (
    "Directions for which we can name no finding; they make the six expressions distinct on this robot "
    "and are ours to defend. Anger has its gaze down although a head held down lowers perceived arousal "
    "(Beck et al.): here the trunk leans forward. Wallbott (1998, Eur. J. Soc. Psychol. 28, 879–896) "
    "reports postures specific to emotions, movements partly a matter of activation; he may support some "
    "of these directions."
)
DEPARTURES = (
    "Halovic & Kroos saw frightened people walk fast, with short strides. Our fear is over sooner than "
    "the neutral motion and smaller, and being smaller it is slower."
)


@dataclass(frozen=True)
class Finding:
    """A descriptor that an emotion raises (1) or lowers (-1); without sources: as chosen here."""

    emotion: str
    descriptor: str
    direction: int
    sources: tuple[str, ...] = ()


def _findings() -> Iterator[Finding]:
    for emotion, direction, descriptors, sources in (
        ("joy", 1, ("speed_mean",), ("Gross",)),
        ("joy", 1, ("amplitude",), ("Gross", "Halovic")),
        ("joy", 1, ("gaze_elevation_mean_rad",), ("Beck",)),
        ("joy", 1, ("hand_height_m",), ()),
        ("sadness", -1, ("speed_mean", "amplitude"), ("Gross", "Halovic")),
        ("sadness", -1, ("gaze_elevation_mean_rad",), ("Gross", "Beck")),
        ("sadness", 1, ("head_forward_mean_m",), ("Gross",)),
        ("sadness", 1, ("contraction_index",), ()),
        ("sadness", -1, ("jerk_rms",), ()),
        ("anger", 1, ("speed_mean", "amplitude"), ("Gross", "Halovic")),
        ("anger", 1, ("acceleration_peak",), ()),
        ("anger", -1, ("gaze_elevation_mean_rad", "contraction_index"), ()),
        ("fear", -1, ("amplitude",), ("Halovic",)),
        ("fear", 1, ("contraction_index",), ()),
        ("fear", -1, ("log_dimensionless_jerk", "duration_s"), ()),
        ("shame", -1, ("speed_mean", "amplitude", "gaze_elevation_mean_rad"), ()),
        ("shame", 1, ("contraction_index",), ()),
        ("hurry", -1, ("duration_s",), ()),
        ("hurry", 1, ("speed_mean", "acceleration_peak"), ()),
    ):
        for descriptor in descriptors:
            yield Finding(emotion, descriptor, direction, sources)


FINDINGS = tuple(_findings())
DEPARTED_FROM = (Finding("fear", "speed_mean", 1, ("Halovic",)),)


def change(finding: Finding, described: Mapping[str, Mapping[str, float]]) -> float:
    """How far the emotion's motion is from the neutral one, in the finding's direction."""
    neutral = described["neutral"][finding.descriptor]
    return finding.direction * (described[finding.emotion][finding.descriptor] - neutral)


def emotions_as_markdown(described: Mapping[str, Mapping[str, float]]) -> str:
    """All findings beside what the motions do, as a document; `described` has descriptors by modulation."""
    used = dict.fromkeys(finding.descriptor for finding in FINDINGS)
    lines = [
        "# Six expressions and what they are after",
        "",
        "Made from the motions themselves; a test holds every line. Descriptors of the explaining gesture of "
        "`protocols/hielscher2025` without and with each modulation.",
        *("", "## Directions found in the literature", "", EVIDENCE, ""),
        *_table((finding for finding in FINDINGS if finding.sources), described),
        *("", "## Directions chosen here", "", CHOICES, ""),
        *_table((finding for finding in FINDINGS if not finding.sources), described),
        *("", "## A finding not followed", "", DEPARTURES, ""),
        *_table(DEPARTED_FROM, described),
        *("", "## Descriptors", "", *(f"- `{name}`: {DESCRIPTORS[name]}" for name in used)),
        *("", "## Sources", "", *(f"- **{name}**: {cited}" for name, cited in SOURCES.items()), ""),
    ]
    return "\n".join(lines)


def _table(findings: Iterable[Finding], described: Mapping[str, Mapping[str, float]]) -> Iterator[str]:
    yield "| expression | descriptor | expected | neutral | modulated | found by |"
    yield "|---|---|---|---|---|---|"
    for finding in findings:
        arrow = "higher" if finding.direction > 0 else "lower"
        before, after = (described[name][finding.descriptor] for name in ("neutral", finding.emotion))
        found_by = ", ".join(finding.sources) or "–"
        cells = (finding.emotion, finding.descriptor, arrow, f"{before:.3g}", f"{after:.3g}", found_by)
        yield f"| {' | '.join(cells)} |"
