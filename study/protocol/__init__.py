"""The protocol language: a study as one YAML file, read into one value or refused with all its errors."""

from __future__ import annotations

from study.protocol.errors import Problem, ProtocolError
from study.protocol.loading import load_protocol
from study.protocol.pairs import Pair
from study.protocol.parts import BESIDE, NEUTRAL, PRACTICE, Order, Part, Practice
from study.protocol.plan import Analysis, Exclusions, Hypothesis, Participants
from study.protocol.protocol import Protocol
from study.protocol.stimulus import Stimulus
from study.protocol.texts import Texts
from study.text import Text

__all__ = [
    "BESIDE",
    "NEUTRAL",
    "PRACTICE",
    "Analysis",
    "Exclusions",
    "Hypothesis",
    "Order",
    "Pair",
    "Part",
    "Participants",
    "Practice",
    "Problem",
    "Protocol",
    "ProtocolError",
    "Stimulus",
    "Text",
    "Texts",
    "load_protocol",
]
