"""A study that has begun is changed only with a date and a reason."""

from pathlib import Path

import pytest

from study.methods import methods
from study.preregister import preregister
from study.protocol import ProtocolError
from study.protocol.amendments import as_replaced
from study.versions import refuse_undeclared

PAPER = Path(__file__).parents[3] / "protocols" / "hielscher2025"


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
    assert f"replaces: {as_replaced(before)}" in str(refused.value)


@pytest.mark.parametrize(
    ("sha256", "written"),
    [
        ("0123456789abcd", "0123456789ab"),
        ("01234567890123", '"012345678901"'),
        ("123e45678901", '"123e45678901"'),
    ],
)
def test_a_hash_that_looks_like_a_number_is_quoted(sha256, written):
    assert as_replaced(sha256) == written


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


def test_the_documents_tell_of_amendments(load, written, tmp_path):
    (tmp_path / "gestures").symlink_to(PAPER / "gestures")
    written["participants"]["stop"] = "by hand"
    protocol = load(amended(written, "0123456789ab"))
    document = preregister(protocol)
    assert "Amended on 2026-11-22 (SHA-256 `0123456789ab` before): A typing error" in document
    assert "To be registered beside what was registered before it began." in document
    draft = methods(protocol)
    assert "amended on 2026-11-22, after [number] participants: A typing error in the consent." in draft
    assert "gathered until [when] we closed the study. [Number] took part" in draft
    assert ".." not in draft
