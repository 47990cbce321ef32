"""Timer, which calls back once in every period, and Rate, which sleeps until the next one."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from studio.errors import DestroyedError, ExternalShutdownException
from studio.ros.condition import Condition
from studio.ros.duration import NANOSECONDS, Duration
from studio.ros.node.clock import ClockType, JumpThreshold
from studio.ros.node.work import Work

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.clock import Clock, TimeJump
    from studio.ros.node.context import Context
    from studio.ros.node.logger import Logger
    from studio.ros.node.work import CallbackGroup

_PATIENCE_S = 2.0


class Timer(Work):
    """Calls back every `timer_period_ns`, on a clock of its own choice.

    In the time of the system, periods are measured on the steady clock: setting the time of the
    machine stops no timer. When /clock sets the time, they are periods of /clock, and a jump
    backwards begins a period again.
    """

    def __init__(
        self,
        callback: Callable[[], object] | None,
        period_ns: int,
        clock: Clock,
        group: CallbackGroup,
        *,
        autostart: bool = True,
    ) -> None:
        super().__init__(group)
        if period_ns < 0:
            raise ValueError("the period of a timer is not below zero")
        self.callback = callback
        self.clock = clock
        self._period_ns = period_ns
        self._lock = threading.Lock()
        self._cancelled = not autostart
        self._last_ns: int | None = None
        self._next_ns = self._now_ns() + period_ns
        self._jumps = clock.create_jump_callback(
            JumpThreshold(min_backward=Duration(nanoseconds=-1)), post_callback=self._jumped
        )
        clock.watch(self._time_was_set)

    @property
    def timer_period_ns(self) -> int:
        """The period in nanoseconds."""
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, period_ns: int) -> None:
        self._period_ns = int(period_ns)
        self.reset()

    @property
    def is_ready(self) -> bool:
        """Whether its time has come."""
        return not self._cancelled and self._now_ns() >= self._next_ns

    @property
    def is_timed(self) -> bool:
        """True: a timer gets ready by itself."""
        return True

    @property
    def due_s(self) -> float | None:
        """When it will be ready, on the monotonic clock; None if it is not to be waited for."""
        if self._cancelled:
            return None
        left_ns = self._next_ns - self._now_ns()
        if self.clock.ros_time_is_active and left_ns > 0:
            return None  # /clock will set the time, and that wakes the executor
        return time.monotonic() + left_ns / NANOSECONDS

    def take(self) -> Callable[[], object] | None:
        """Count the period as called, and return the callback."""
        with self._lock:
            if not self.is_ready:
                return None
            now_ns = self._now_ns()
            self._last_ns = now_ns
            self._next_ns = self._after(now_ns)
        return self.callback or _nothing

    def cancel(self) -> None:
        """Stop, until `reset`."""
        self._cancelled = True

    def is_canceled(self) -> bool:
        """Whether it was cancelled."""
        return self._cancelled

    def reset(self) -> None:
        """Start a new period."""
        with self._lock:
            self._next_ns = self._now_ns() + self._period_ns
            self._cancelled = False
        self.announce()

    def time_since_last_call(self) -> int:
        """Return nanoseconds since it was last carried out, or since its period began."""
        last_ns = self._last_ns
        return self._now_ns() - (self._next_ns - self._period_ns if last_ns is None else last_ns)

    def time_until_next_call(self) -> int | None:
        """Return nanoseconds until it is ready, below zero when it is late, None when cancelled."""
        return None if self._cancelled else self._next_ns - self._now_ns()

    def destroy(self) -> None:
        """Stop for good."""
        self.cancel()
        self._jumps.unregister()
        self.clock.unwatch(self._time_was_set)

    def _after(self, now_ns: int) -> int:
        """Return the end of the running period: periods that were missed are left out."""
        next_ns = self._next_ns + self._period_ns
        if next_ns > now_ns or not self._period_ns:
            return max(next_ns, now_ns)
        missed = (now_ns - next_ns) // self._period_ns
        return next_ns + (missed + 1) * self._period_ns

    def _now_ns(self) -> int:
        if self.clock.clock_type is not ClockType.ROS_TIME or not self.clock.ros_time_is_active:
            return time.monotonic_ns()
        return self.clock.now_ns()

    def _time_was_set(self) -> None:
        if self.is_ready:
            self.announce()

    def _jumped(self, jump: TimeJump) -> None:
        del jump
        with self._lock:
            self._next_ns = self._now_ns() + self._period_ns
        self.announce()


def _nothing() -> None:
    return


class Rate:
    """Sleeps until a timer calls back, which needs a node that spins.

    A call that came before `sleep` counts, so that a loop of `spin_once` and `sleep` keeps time.
    """

    def __init__(
        self, timer: Timer, context: Context, logger: Logger, forget: Callable[[Timer], object]
    ) -> None:
        """Sleep until a timer calls back; `forget` takes the timer from its node at the end."""
        self._changed, self._beaten = Condition(), False
        self._timer: Timer | None = timer
        self._context, self._logger, self._forget = context, logger, forget
        self._patience_s = 2 * timer.timer_period_ns / NANOSECONDS + _PATIENCE_S
        timer.callback = self._beat
        context.on_end(self._beat)

    def sleep(self) -> None:
        """Sleep until the timer calls back next.

        Raises:
            DestroyedError: The rate was destroyed.
            ExternalShutdownException: The process was asked to end.
        """
        while not self._wait():
            self._logger.warning(
                "Nobody spins this node, so that its rate sleeps on: call spin_once in the loop, "
                "or spin in a thread.",
                once=True,
            )
        if not self._context.ok():
            raise ExternalShutdownException
        if self._timer is None:
            raise DestroyedError("rate")

    def destroy(self) -> None:
        """Destroy the timer, and wake what sleeps."""
        timer, self._timer = self._timer, None
        if timer is not None:
            self._forget(timer)
            self._context.forget_end(self._beat)
        self._beat()

    def _beat(self) -> None:
        with self._changed:
            self._beaten = True
            self._changed.notify_all()

    def _wait(self) -> bool:
        """Wait for a beat, and take it; False when none comes in time.

        The last beat is left for whoever else sleeps.
        """
        with self._changed:
            beaten = self._changed.wait_for(lambda: self._beaten, self._patience_s)
            if beaten and self._context.ok() and self._timer is not None:
                self._beaten = False
        return beaten
