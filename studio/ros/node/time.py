"""Time: an instant of one kind of clock, named and made as in rclpy."""

from __future__ import annotations

import operator
from enum import IntEnum
from typing import TYPE_CHECKING, overload

from studio.ros.duration import NANOSECONDS, Duration
from studio.ros.messages import message

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.classes import MessageValue


class ClockType(IntEnum):
    """What an instant counts from."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    SYSTEM_TIME = 2
    STEADY_TIME = 3


class Time:
    """An instant; instants of different clocks are neither compared nor subtracted."""

    __slots__ = ("_clock_type", "_nanoseconds")

    def __init__(
        self,
        *,
        seconds: float = 0,
        nanoseconds: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        total_ns = int(seconds * NANOSECONDS) + int(nanoseconds)
        if total_ns < 0:
            raise ValueError("an instant is not before zero")
        self._nanoseconds, self._clock_type = total_ns, clock_type

    @property
    def nanoseconds(self) -> int:
        """Since the zero of its clock."""
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        """The kind of clock that told it."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Whole seconds, and the nanoseconds that are left."""
        return divmod(self._nanoseconds, NANOSECONDS)

    def to_msg(self) -> MessageValue:
        """Give it as a builtin_interfaces/msg/Time."""
        seconds, rest_ns = self.seconds_nanoseconds()
        return message("builtin_interfaces/msg/Time")(sec=seconds, nanosec=rest_ns)

    @classmethod
    def from_msg(cls, msg: MessageValue, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Read a builtin_interfaces/msg/Time.

        Raises:
            ValueError: It is before zero.
        """
        return cls(seconds=0, nanoseconds=stamp_ns(msg), clock_type=clock_type)

    def __add__(self, other: Duration) -> Time:
        return self._moved(other.nanoseconds)

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...
    @overload
    def __sub__(self, other: Duration) -> Time: ...
    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            self._same_clock(other)
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        return self._moved(-other.nanoseconds)

    def __eq__(self, other: object) -> bool:
        return self._compared(other, operator.eq) if isinstance(other, Time) else NotImplemented

    def __lt__(self, other: Time) -> bool:
        return self._compared(other, operator.lt)

    def __le__(self, other: Time) -> bool:
        return self._compared(other, operator.le)

    def __gt__(self, other: Time) -> bool:
        return self._compared(other, operator.gt)

    def __ge__(self, other: Time) -> bool:
        return self._compared(other, operator.ge)

    def __hash__(self) -> int:
        return hash((self._nanoseconds, self._clock_type))

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self._clock_type.name})"

    def _moved(self, by_ns: int) -> Time:
        return Time(nanoseconds=self._nanoseconds + by_ns, clock_type=self._clock_type)

    def _compared(self, other: Time, compare: Callable[[int, int], bool]) -> bool:
        self._same_clock(other)
        return compare(self._nanoseconds, other._nanoseconds)

    def _same_clock(self, other: Time) -> None:
        if self._clock_type is not other._clock_type:
            raise TypeError(
                f"instants of {self._clock_type.name} and {other._clock_type.name} do not compare"
            )


def stamp_ns(stamp: MessageValue) -> int:
    """Give a builtin_interfaces/msg/Time in nanoseconds."""
    return stamp.sec * NANOSECONDS + stamp.nanosec
