"""How emotions show in motion: which descriptors should move which way against neutral, and who found so.

What is not listed was not found, or not found clearly. Hurry is no emotion; it stands for Timing alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from stimuli.descriptors import DESCRIPTORS

SOURCES = {
    "Wallbott": "Wallbott, H. G. (1998). Bodily expression of emotion. Eur. J. Soc. Psychol. 28, 879–896.",
    "Crane": "Crane, E. A. & Gross, M. M. (2013). Effort-shape characteristics of emotion-related body "
    "movement. J. Nonverbal Behav. 37, 91–105.",
    "Roether": "Roether, C. L., Omlor, L., Christensen, A. & Giese, M. A. (2009). Critical features for the "
    "perception of emotion from gait. J. Vision 9(6):15.",
    "Halovic": "Halovic, S. & Kroos, C. (2018). Not all is noticed: Kinematic cues of emotion-specific gait. "
    "Hum. Mov. Sci. 57, 478–488.",
    "Beck": "Beck, A., Cañamero, L. & Bard, K. A. (2010). Towards an affect space for robots to display "
    "emotional body language. IEEE RO-MAN, 464–469.",
    "Keltner": "Keltner, D. (1995). Signs of appeasement: evidence for the distinct displays of "
    "embarrassment, amusement, and shame. J. Pers. Soc. Psychol. 68, 441–454.",
    "Darwin": "Darwin, C. (1872). The expression of the emotions in man and animals. John Murray.",
    "Lasseter": "Lasseter, J. (1987). Principles of traditional animation applied to 3D computer animation. "
    "SIGGRAPH Comput. Graph. 21(4), 35–44.",
}

EVIDENCE = (
    "Wallbott coded actors' movements and postures; Crane & Gross, Roether et al. and Halovic & Kroos "
    "studied gait; Beck et al. had people judge a robot's poses with its head up and down; Keltner, Darwin "
    "and Lasseter describe. Where findings differ one is followed: Roether et al. saw arms bent in anger as "
    "in fear, Wallbott expansive movement."
)


@dataclass(frozen=True)
class Finding:
    """A descriptor that an emotion raises (1) or lowers (-1) against neutral."""

    emotion: str
    descriptor: str
    direction: int
    sources: tuple[str, ...]


def _findings() -> Iterator[Finding]:
    for emotion, direction, descriptors, sources in (
        ("joy", 1, ("speed_mean",), ("Wallbott", "Crane", "Roether")),
        ("joy", 1, ("amplitude",), ("Wallbott", "Roether", "Halovic")),
        ("joy", 1, ("hand_height_m",), ("Wallbott",)),
        ("joy", 1, ("gaze_elevation_mean_rad",), ("Wallbott", "Beck")),
        ("sadness", -1, ("speed_mean",), ("Wallbott", "Crane", "Roether", "Halovic")),
        ("sadness", -1, ("jerk_rms",), ("Crane",)),
        ("sadness", -1, ("amplitude",), ("Wallbott", "Roether", "Halovic")),
        ("sadness", -1, ("gaze_elevation_mean_rad",), ("Roether", "Beck")),
        ("sadness", 1, ("contraction_index", "head_forward_mean_m"), ("Wallbott",)),
        ("anger", 1, ("speed_mean",), ("Wallbott", "Crane", "Roether", "Halovic")),
        ("anger", 1, ("acceleration_peak",), ("Wallbott", "Crane")),
        ("anger", 1, ("amplitude",), ("Wallbott", "Roether", "Halovic")),
        ("anger", -1, ("gaze_elevation_mean_rad",), ("Beck",)),
        ("anger", -1, ("contraction_index",), ("Wallbott",)),
        ("fear", 1, ("contraction_index",), ("Roether",)),
        ("fear", -1, ("amplitude",), ("Roether", "Halovic")),
        ("fear", -1, ("log_dimensionless_jerk",), ("Darwin",)),
        ("shame", -1, ("speed_mean", "amplitude"), ("Wallbott",)),
        ("shame", -1, ("gaze_elevation_mean_rad",), ("Wallbott", "Keltner")),
        ("shame", 1, ("contraction_index",), ("Wallbott",)),
        ("hurry", -1, ("duration_s",), ("Lasseter",)),
        ("hurry", 1, ("speed_mean", "acceleration_peak"), ("Lasseter",)),
    ):
        for descriptor in descriptors:
            yield Finding(emotion, descriptor, direction, sources)


FINDINGS = tuple(_findings())


def change(finding: Finding, described: Mapping[str, Mapping[str, float]]) -> float:
    """How far the emotion's motion is from the neutral one, in the finding's direction."""
    neutral = described["neutral"][finding.descriptor]
    return finding.direction * (described[finding.emotion][finding.descriptor] - neutral)


def emotions_as_markdown(described: Mapping[str, Mapping[str, float]]) -> str:
    """All findings beside what the motions do, as a document; `described` has descriptors by modulation."""
    lines = [
        "# Six expressions and what they are after",
        "",
        "Made from the motions themselves; a test holds every line. Descriptors of the explaining gesture of "
        f"`protocols/hielscher2025` without and with each modulation. {EVIDENCE}",
        "",
        "| expression | descriptor | expected | neutral | modulated | after |",
        "|---|---|---|---|---|---|",
    ]
    for finding in FINDINGS:
        arrow = "higher" if finding.direction > 0 else "lower"
        before, after = (described[name][finding.descriptor] for name in ("neutral", finding.emotion))
        lines.append(
            f"| {finding.emotion} | {finding.descriptor} | {arrow} | {before:.3g} | {after:.3g} | "
            f"{', '.join(finding.sources)} |"
        )
    used = dict.fromkeys(finding.descriptor for finding in FINDINGS)
    lines += ["", "## Descriptors", "", *(f"- `{name}`: {DESCRIPTORS[name]}" for name in used)]
    lines += ["", "## Sources", "", *(f"- **{name}**: {cited}" for name, cited in SOURCES.items()), ""]
    return "\n".join(lines)
