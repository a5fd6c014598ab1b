"""Animation principles as modulations of a movement primitive: one file each, this folder is the list.

A protocol names them by `kind`: `{time: 0.85, exa: 1.3, ant: {intensity: 0.3, window: 0.075}}`. A bare number is
the principle's intensity. What is not named is neutral, and neutral changes nothing, bit for bit.
"""

from __future__ import annotations
