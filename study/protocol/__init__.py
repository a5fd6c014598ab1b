"""The protocol language: a study as one YAML file, read into one value or refused with every error at its line."""

from __future__ import annotations

from study.protocol.errors import Problem, ProtocolError
from study.protocol.parts import Order, Part, Practice, Stimulus
from study.protocol.plan import Analysis, Exclusions, Hypothesis, Participants
from study.protocol.protocol import Protocol, load_protocol
from study.text import Text

__all__ = [
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
    "load_protocol",
]
