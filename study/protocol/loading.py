"""From a file to a protocol, or to everything that is wrong with it."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from study.protocol.errors import Problem, ProtocolError
from study.protocol.protocol import Protocol
from study.protocol.references import contradictions
from study.protocol.source import Source, read_source
from study.written import NAME


def load_protocol(path: Path, *, kept: bool = False) -> Protocol:
    """Read a protocol from its file, or from the `protocol.yaml` in a folder.

    Raises ProtocolError with everything that is wrong, each at its line. `kept`: a copy of what participants
    began with, in which files need not lie as in a study that is to begin.
    """
    return read_protocol(read_source(path / "protocol.yaml" if path.is_dir() else path), kept=kept)


def read_protocol(source: Source, *, kept: bool = False) -> Protocol:
    """Read a protocol from what a file says. Raises ProtocolError."""
    if "joints" in source.value and "parts" not in source.value:
        message = "is a gesture, not a protocol; give the protocol that names it, or its folder"
        raise ProtocolError([Problem(source.path, None, None, "", message)])
    try:
        protocol = Protocol.model_validate(source.value)
    except ValidationError as error:
        raise ProtocolError(
            source.problem(detail["loc"], detail["msg"], name=detail["type"] == NAME)
            for detail in error.errors(include_url=False)
        ) from None
    protocol._source = source
    problems = [
        source.problem(location, message) for location, message in contradictions(protocol, kept=kept)
    ]
    if problems:
        raise ProtocolError(problems)
    return protocol
