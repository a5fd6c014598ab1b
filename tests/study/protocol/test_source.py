"""Hostile and broken YAML ends in one clear message at its place."""

import pytest

from study.protocol import ProtocolError
from study.protocol.source import MAX_BYTES, read_source

BOMB = "a: &a [x, x]\n" + "".join(
    f"{b}: &{b} [*{a}, *{a}, *{a}]\n" for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)

HOSTILE = {
    "alias bomb": (BOMB, "1:4", "anchors"),
    "alias to nothing": ("a: *b\n", "1:4", "anchors"),
    "repeated key": ("study: a\nseed: 1\nstudy: b\n", "3:1", "given twice; first in line 1"),
    "repeated key inside": ("a: {b: 1, c: {d: 1, d: 2}}\n", "1:21", "a.c.d is given twice"),
    "tab": ("study: a\nparts:\n\tone: 1\n", "3:1", "tab"),
    "tag": ("study: !!python/object:os.system {}\n", "1:8", "tags"),
    "nan": ("seed: .nan\n", "1:7", "no number"),
    "infinity": ("a: {b: [1, -.inf]}\n", "1:12", "no number"),
    "latin-1": ("study: a\ntitle: Gefühl\n".encode("latin-1"), "2: ", "UTF-8"),
    "utf-16": ("study: a".encode("utf-16"), "1: ", "UTF-8"),
    "null byte": ("study: a\nb: \0\n", "2: ", "U+0000"),
    "10 MB": (b"a: b\n" * 2_000_000, " is larger", "larger than"),
    "deep": ("a: " + "[" * 3000 + "]" * 3000, "1:", "nested more than"),
    "second document": ("a: 1\n---\nb: 2\n", "2:1", "second document"),
    "empty": ("", " is empty", "study new"),
    "only a comment": ("# nothing\n", " is empty", "study new"),
    "a list": ("- a\n- b\n", "1:1", "must be a mapping"),
    "a key that is a list": ("{[a]: 1}\n", "1:2", "must be plain text"),
    "an open bracket": ("a: [1, 2\nb: 3\n", "2:2", "is not YAML"),
    "a colon in braces": ("title: {en: Why: because, de: x}\n", "1:", '"quotes"'),
    "a number of many digits": ("seed: " + "9" * 40 + "\n", "1:7", "more digits"),
    "no space after a colon": ("study: a\nrobot:pepper\nseed: 1\n", "2:1", "a name without a value"),
    "a merge of what is not there": ("a: {<<: *base}\n", "1:5", "merging"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_yaml_gets_one_message_at_its_place(name, tmp_path):
    content, place, message = HOSTILE[name]
    path = tmp_path / "protocol.yaml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ProtocolError) as refused:
        read_source(path)
    (problem,) = refused.value.problems
    assert str(problem).startswith(f"{path}:{place}")
    assert message in str(problem)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ProtocolError, match=r"nowhere\.yaml: cannot be read: No such file"):
        read_source(tmp_path / "nowhere.yaml")


def test_plain_words_are_read_as_in_yaml_1_2(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text(
        "no: {yes: on, off: 12:30, a: 010, b: true, c: ~, d: 1e3, e: 1_000, f: 2025-01-01, g: '1'}\n"
    )
    assert read_source(path).value == {
        "no": {"yes": "on", "off": "12:30", "a": 10, "b": True, "c": None, "d": 1000.0, "e": "1_000",
               "f": "2025-01-01", "g": "1"}
    }  # fmt: skip


def test_a_file_just_small_enough_is_read(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text("a: b\n" + "#" * (MAX_BYTES - 5))
    assert read_source(path).value == {"a": "b"}


def test_a_byte_order_mark_is_passed_over(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_bytes("a: b\n".encode("utf-8-sig"))
    assert read_source(path).value == {"a": "b"}
