"""A NamedPose: joint positions that a file gives a name."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Final

JOINT_LIMIT: Final = 2_000
"""Joints of one pose."""
NAME_LIMIT: Final = 100
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_LARGEST: Final = 1e9
"""rad or m; no joint goes so far."""


@dataclass(frozen=True, slots=True)
class NamedPose:
    """Positions of some joints of a robot; the others stay where they are."""

    name: str
    positions: dict[str, float]
    """By joint, rad or m."""
    group: str = ""
    """The planning group that an SRDF states it for."""
    file: str = ""
    line: int = 0
    """From 1; 0 when it is not known."""
    unread: tuple[str, ...] = ()
    """Joints whose value is no single number, such as those of a floating joint."""


def position_of(text: str) -> float | None:
    """A position as written, rad or m; None when it is no finite number that a joint can have."""
    trimmed = text.strip()
    if len(trimmed) > 100 or not _NUMBER.fullmatch(trimmed):
        return None
    value = float(trimmed)
    return value if math.isfinite(value) and abs(value) <= _LARGEST else None
