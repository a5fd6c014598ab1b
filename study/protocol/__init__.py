"""The protocol language: a study as one YAML file, read into one value or refused with all its errors."""

from __future__ import annotations

from study.protocol.errors import Problem, ProtocolError
from study.protocol.parts import NEUTRAL, PRACTICE, Order, Part, Practice, Stimulus
from study.protocol.plan import Analysis, Exclusions, Hypothesis, Participants
from study.protocol.protocol import Protocol, load_protocol
from study.protocol.texts import Texts
from study.text import Text

__all__ = [
    "NEUTRAL",
    "PRACTICE",
    "Analysis",
    "Exclusions",
    "Hypothesis",
    "Order",
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
