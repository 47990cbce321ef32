"""ROSClock: the clock of ROS's time, which /clock may set."""

from __future__ import annotations

from studio.ros.node.clock import Clock, ClockType


class ROSClock(Clock):
    """A clock of ROS's time."""

    def __init__(self) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME)
