"""A span of time in nanoseconds, named and made as in rclpy."""

from __future__ import annotations

from dataclasses import dataclass

NANOSECONDS = 1_000_000_000


@dataclass(frozen=True, slots=True, order=True, init=False)
class Duration:
    """A span of time; seconds may be fractions, and both parts are added."""

    nanoseconds: int

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        object.__setattr__(self, "nanoseconds", int(seconds * NANOSECONDS) + int(nanoseconds))

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self.nanoseconds})"


INFINITE = Duration(nanoseconds=9223372036 * NANOSECONDS + 854775807)
