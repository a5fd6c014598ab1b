"""A study that has begun is changed only with a date and a reason."""

import pytest

from study.protocol import ProtocolError
from study.versions import refuse_undeclared


def amended(written, replaces):
    change = {"date": "2026-11-22", "reason": "A typing error in the consent.", "replaces": replaces}
    return written | {"amendments": [*written.get("amendments", []), change]}


def test_the_first_participants_and_an_unchanged_protocol_need_no_amendment(load, written):
    protocol = load(written)
    refuse_undeclared(protocol, set())
    refuse_undeclared(protocol, {protocol.sha256})


def test_a_changed_protocol_is_refused_and_says_what_to_write(load, written):
    before = load(written).sha256
    after = load(written | {"seed": 7})
    with pytest.raises(ProtocolError, match="has changed since participants took part") as refused:
        refuse_undeclared(after, {before})
    assert f"replaces: {before[:12]}" in str(refused.value)


def test_a_declared_change_is_let_through_and_so_is_the_next(load, written):
    first = load(written).sha256
    once = amended(written | {"seed": 7}, first[:12])
    refuse_undeclared(load(once), {first})
    second = load(once).sha256
    twice = once | {"seed": 8}
    with pytest.raises(ProtocolError):
        refuse_undeclared(load(twice), {first, second})
    refuse_undeclared(load(amended(twice, second)), {first, second})


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("date", "yesterday", "must be a date, such as 2026-11-22"),
        ("replaces", "abc", "must"),
        ("reason", "", "must"),
    ],
)
def test_amendments_are_dated_reasoned_and_name_what_they_replace(load, written, field, value, message):
    written = amended(written, "0" * 12)
    written["amendments"][0][field] = value
    with pytest.raises(ProtocolError, match=rf"amendments\[0\].{field}.*") as refused:
        load(written)
    assert message in refused.value.problems[0].message


def test_the_preregistration_tells_of_amendments(tmp_path):
    from pathlib import Path
    from shutil import copytree

    from study.preregister import preregister
    from study.protocol import load_protocol

    template = Path(__file__).parents[3] / "protocols" / "template"
    folder = tmp_path / "study"
    copytree(template, folder)
    protocol = folder / "protocol.yaml"
    more = "\namendments:\n  - {date: 2026-11-22, reason: A misspelt word, replaces: 0123456789ab}\n"
    protocol.write_text(protocol.read_text(encoding="utf-8") + more, encoding="utf-8")
    assert "Amended on 2026-11-22 (SHA-256 `0123456789ab` before): A misspelt word" in preregister(
        load_protocol(folder)
    )
