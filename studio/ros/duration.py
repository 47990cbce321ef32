"""A span of time in nanoseconds, named and made as in rclpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

NANOSECONDS = 1_000_000_000


@dataclass(frozen=True, slots=True, order=True, init=False)
class Duration:
    """A span of time; seconds may be fractions, and both parts are added."""

    nanoseconds: int

    def __init__(self, *, seconds: float = 0, nanoseconds: int = 0) -> None:
        object.__setattr__(self, "nanoseconds", int(seconds * NANOSECONDS) + int(nanoseconds))

    def to_msg(self) -> Any:  # noqa: ANN401 - messages are above
        """Return a `builtin_interfaces/msg/Duration`."""
        sec, nanosec = divmod(self.nanoseconds, NANOSECONDS)
        return _makers[-1]("builtin_interfaces/msg/Duration")(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg: Any) -> Duration:  # noqa: ANN401
        """Read a `builtin_interfaces/msg/Duration`."""
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)

    def __str__(self) -> str:
        return f"{self.nanoseconds} nanoseconds"

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self.nanoseconds})"


INFINITE = Duration(nanoseconds=9223372036 * NANOSECONDS + 854775807)
_makers: list[Callable[[str], Any]] = []


def make_messages_by(make: Callable[[str], Any]) -> None:
    """Make the messages of spans by a function of the type's name: messages are a room above."""
    _makers.append(make)
