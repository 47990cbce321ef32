"""Clock and Time: instants of the system, of a steady clock or of ROS, which /clock may set."""

from __future__ import annotations

import operator
import time
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, overload

from studio.ros.condition import Condition
from studio.ros.duration import NANOSECONDS, Duration
from studio.ros.messages import message
from studio.ros.node.context import default_context
from studio.ros.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.context import Context
    from studio.ros.types.classes import MessageValue

_CHECK_S = 0.1
CLOCK_TOPIC = "/clock"
CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class ClockType(IntEnum):
    """The time base of an instant."""

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
        """The kind of its clock."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Whole seconds, and the nanoseconds that are left."""
        return divmod(self._nanoseconds, NANOSECONDS)

    def to_msg(self) -> MessageValue:
        """Return it as a builtin_interfaces/msg/Time."""
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
        if not isinstance(other, Duration):  # pyright: ignore[reportUnnecessaryIsInstance]
            return NotImplemented
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
    """Return a builtin_interfaces/msg/Time in nanoseconds."""
    return stamp.sec * NANOSECONDS + stamp.nanosec


class Clock:
    """Returns instants of its kind; ROS time is that of the system until /clock takes over."""

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME) -> None:
        self._clock_type = clock_type
        self._ros_time_ns: int | None = None
        self._moved = Condition()
        self._handles: list[JumpHandle] = []
        self._watchers: list[Callable[[], None]] = []

    @property
    def clock_type(self) -> ClockType:
        """The kind of clock."""
        return self._clock_type

    @property
    def ros_time_is_active(self) -> bool:
        """Whether /clock sets the time."""
        return self._ros_time_ns is not None

    def now(self) -> Time:
        """Return this instant."""
        return Time(nanoseconds=self.now_ns(), clock_type=self._clock_type)

    def now_ns(self) -> int:
        """Return this instant in nanoseconds."""
        ros_time_ns = self._ros_time_ns
        if ros_time_ns is not None:
            return ros_time_ns
        steady = self._clock_type is ClockType.STEADY_TIME
        return time.monotonic_ns() if steady else time.time_ns()

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Call back before and after jumps that meet a threshold."""
        handle = JumpHandle(self, threshold, pre_callback, post_callback)
        with self._moved:
            self._handles.append(handle)
        return handle

    def forget(self, handle: JumpHandle) -> None:
        """Remove a callback."""
        with self._moved:
            if handle in self._handles:
                self._handles.remove(handle)

    def set_ros_time(self, now_ns: int | None) -> None:
        """Set ROS time, as /clock does; None returns to the time of the system.

        Raises:
            ValueError: It is no clock of ROS time.
        """
        if self._clock_type is not ClockType.ROS_TIME:
            raise ValueError("only a clock of ROS time can be set")
        jump = self._jump_to(now_ns)
        with self._moved:
            met = [handle for handle in self._handles if handle.threshold.is_met_by(jump)]
        for handle in met:
            if handle.before is not None:
                handle.before()
        with self._moved:
            self._ros_time_ns = now_ns
            watchers = tuple(self._watchers)
            self._moved.notify_all()
        for handle in met:
            if handle.after is not None:
                handle.after(jump)
        for watcher in watchers:
            watcher()

    def watch(self, watcher: Callable[[], None]) -> None:
        """Call back whenever the time is set; the callback must not wait."""
        with self._moved:
            self._watchers.append(watcher)

    def unwatch(self, watcher: Callable[[], None]) -> None:
        """Call back no more; again is harmless."""
        with self._moved:
            if watcher in self._watchers:
                self._watchers.remove(watcher)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Sleep until an instant of this clock; whether it came before the context ended.

        A clock that /clock sets wakes when it is set, which never happens while the only thread
        that carries out work sleeps.

        Raises:
            ValueError: The instant is one of another clock.
        """
        if until.clock_type is not self._clock_type:
            raise ValueError("the instant is one of another clock")
        ended = context or default_context()
        ended.on_end(self._wake)
        try:
            return self._slept_until(until, ended)
        finally:
            ended.forget_end(self._wake)  # a node that sleeps in a loop leaves nothing behind

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Sleep for a span of this clock; whether it went by before the context ended."""
        return self.sleep_until(self.now() + rel_time, context)

    def _slept_until(self, until: Time, context: Context) -> bool:
        with self._moved:
            while (left_ns := until.nanoseconds - self.now_ns()) > 0:
                if not context.ok():
                    return False
                is_set = self.ros_time_is_active
                self._moved.wait(_CHECK_S if is_set else min(_CHECK_S, left_ns / NANOSECONDS))
        return True

    def _wake(self) -> None:
        with self._moved:
            self._moved.notify_all()

    def _jump_to(self, now_ns: int | None) -> TimeJump:
        before_ns, was_set = self.now_ns(), self._ros_time_ns is not None
        if now_ns is None:
            delta_ns, change = time.time_ns() - before_ns, ClockChange.ROS_TIME_DEACTIVATED
        else:
            delta_ns = now_ns - before_ns
            change = ClockChange.ROS_TIME_NO_CHANGE if was_set else ClockChange.ROS_TIME_ACTIVATED
        return TimeJump(change, Duration(nanoseconds=delta_ns))


class ROSClock(Clock):
    """A clock of ROS's time, which /clock may set."""

    def __init__(self) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)


class ClockChange(IntEnum):
    """What a jump changed besides the time."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


@dataclass(frozen=True, slots=True)
class TimeJump:
    """A step of a clock that was set; `delta` is below zero for a step backwards."""

    clock_change: ClockChange
    delta: Duration


@dataclass(frozen=True, slots=True, kw_only=True)
class JumpThreshold:
    """Jumps that count; None for none in that direction."""

    min_forward: Duration | None = None
    min_backward: Duration | None = None
    on_clock_change: bool = True

    def is_met_by(self, jump: TimeJump) -> bool:
        """Whether a jump is one of these."""
        if jump.clock_change in {
            ClockChange.ROS_TIME_ACTIVATED,
            ClockChange.ROS_TIME_DEACTIVATED,
        }:
            return self.on_clock_change
        forward, backward = self.min_forward, self.min_backward
        return (forward is not None and jump.delta >= forward > Duration()) or (
            backward is not None and jump.delta <= backward < Duration()
        )


class JumpHandle:
    """The callbacks on jumps of a clock; `unregister` ends them."""

    def __init__(
        self,
        clock: Clock,
        threshold: JumpThreshold,
        before: Callable[[], None] | None,
        after: Callable[[TimeJump], None] | None,
    ) -> None:
        self._clock, self.threshold, self.before, self.after = clock, threshold, before, after

    def unregister(self) -> None:
        """End the callbacks; again is harmless."""
        self._clock.forget(self)


class TimeSource:
    """Sets a clock by /clock; until the first message the time is zero, as in rclpy."""

    def __init__(
        self,
        clock: Clock,
        subscribe: Callable[[Callable[[MessageValue], None]], Callable[[], object]],
    ) -> None:
        """Make one that follows nothing yet.

        Args:
            clock: The clock that is set.
            subscribe: Subscribes to /clock with a callback, and returns what ends that.
        """
        self._clock, self._subscribe = clock, subscribe
        self._unsubscribe: Callable[[], object] | None = None

    @property
    def ros_time_is_active(self) -> bool:
        """Whether /clock is followed."""
        return self._unsubscribe is not None

    @ros_time_is_active.setter
    def ros_time_is_active(self, active: bool) -> None:
        if active == self.ros_time_is_active:
            return
        if active:
            self._follow()
        else:
            self._leave()

    def _follow(self) -> None:
        self._clock.set_ros_time(0)
        self._unsubscribe = self._subscribe(self._set)

    def _leave(self) -> None:
        unsubscribe, self._unsubscribe = self._unsubscribe, None
        if unsubscribe is not None:
            unsubscribe()
        self._clock.set_ros_time(None)

    def _set(self, clock: MessageValue) -> None:
        if self._unsubscribe is not None:
            self._clock.set_ros_time(max(0, stamp_ns(clock.clock)))
