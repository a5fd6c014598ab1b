"""Named modulations and levels: what a protocol varies."""

from __future__ import annotations

from typing import Any

Modulation = dict[str, Any]
