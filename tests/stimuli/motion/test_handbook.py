"""The document on the principles says what the code does."""

from __future__ import annotations

from pathlib import Path

from stimuli.handbook import principles_as_markdown
from stimuli.principles import PRINCIPLES


def test_the_document_has_every_principle_with_every_parameter():
    """Where this fails after a change, write docs/principles.md anew, with this function."""
    text = principles_as_markdown()
    for kind in PRINCIPLES.values():
        _, _, section = text.partition(f"## {kind.title}: `{kind.kind}`")
        table = section.partition("\n## ")[0]
        assert all(f"| `{name}` |" in table for name in kind.model_fields)
    assert "| `form` | `literal`, `mirror` | `literal` |" in text
    assert "| `window` | > 0, < 1 | `0.075` |" in text
    assert Path("docs/principles.md").read_text() == text
    assert Path("docs/principles.png").exists()
