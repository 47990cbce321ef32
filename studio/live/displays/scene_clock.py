"""SceneClock: the time of a document's 3D view, and how long it has run."""

from __future__ import annotations

import time
from typing import Final

from studio.protocol.scene_time import SceneTime

_NS_PER_S: Final = 1e9


class SceneClock:
    """Counts from its first question, from a reset, and from where time went back.

    ROS time is that of /clock while it is published, else that of this machine.
    """

    def __init__(self) -> None:
        self._wall_begin_ns = 0
        self._ros_begin_ns = 0
        self._was_from_clock = False
        self._held_ns: int | None = None
        """ROS time that stands still; None: it goes on."""

    def pause(self, clock_ns: int | None, *, paused: bool) -> None:
        """Hold ROS time as it is now, or let it go on.

        Args:
            clock_ns: The newest time of /clock; None: nobody publishes it.
            paused: Which of the two.
        """
        if paused and self._held_ns is None:
            self._held_ns = time.time_ns() if clock_ns is None else clock_ns
        elif not paused:
            self._held_ns = None

    def reset(self) -> None:
        """Count from the next question on."""
        self._wall_begin_ns = self._ros_begin_ns = 0

    def told(
        self, request: int, clock_ns: int | None, *, paused: bool, now_ns: int | None = None
    ) -> SceneTime:
        """Return the time for a page that asked.

        Args:
            request: Its number.
            clock_ns: As for `pause`.
            paused: Whether drawing is paused.
            now_ns: The time of the topics, where they are recorded; None: that of this machine.
        """
        wall_ns = time.time_ns()
        ros_ns = clock_ns if clock_ns is not None else wall_ns if now_ns is None else now_ns
        if self._held_ns is not None:
            ros_ns = self._held_ns
        self._begin(wall_ns, ros_ns, from_clock=clock_ns is not None)
        return SceneTime(
            request=request,
            ros_s=round(ros_ns / _NS_PER_S, 3),
            ros_elapsed_s=round((ros_ns - self._ros_begin_ns) / _NS_PER_S, 3),
            wall_s=round(wall_ns / _NS_PER_S, 3),
            wall_elapsed_s=round((wall_ns - self._wall_begin_ns) / _NS_PER_S, 3),
            from_clock=clock_ns is not None,
            paused=paused,
        )

    def _begin(self, wall_ns: int, ros_ns: int, *, from_clock: bool) -> None:
        """Begin to count where it has not begun, and where ROS time is another or went back."""
        if self._wall_begin_ns == 0 or wall_ns < self._wall_begin_ns:
            self._wall_begin_ns = wall_ns
        is_other = from_clock is not self._was_from_clock
        if self._ros_begin_ns == 0 or is_other or ros_ns < self._ros_begin_ns:
            self._ros_begin_ns = ros_ns
        self._was_from_clock = from_clock
