"""ServerGoals: the goals that a server knows: those under way, and for a while those over."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.action.server_goal import ServerGoalHandle

GOALS_KEPT_MAX = 1_000
"""Of those that are over: a client that sends without end costs no more memory."""


class ServerGoals:
    """Goals by their ids; any thread may ask."""

    def __init__(
        self, result_timeout_s: float, clock_s: Callable[[], float] = time.monotonic
    ) -> None:
        self._result_timeout_s = result_timeout_s
        self._clock_s = clock_s
        self._goals: dict[bytes, ServerGoalHandle] = {}
        self._lock = threading.Lock()

    def add(self, goal_id: bytes, make: Callable[[], ServerGoalHandle]) -> ServerGoalHandle | None:
        """Take up a goal, None when one of that id is known already."""
        with self._lock:
            self._drop_old()
            if goal_id in self._goals:
                return None
            made = self._goals[goal_id] = make()
            return made

    def find(self, goal_id: bytes) -> ServerGoalHandle | None:
        """Give a goal by its id."""
        with self._lock:
            self._drop_old()
            return self._goals.get(goal_id)

    def all(self) -> list[ServerGoalHandle]:
        """Give every goal in the order in which they were accepted."""
        with self._lock:
            self._drop_old()
            return list(self._goals.values())

    def end(self, goal: ServerGoalHandle) -> None:
        """Begin the time for which a goal that is over is kept."""
        with self._lock:
            goal.ended_s = self._clock_s()

    def remove(self, goal: ServerGoalHandle) -> None:
        """Forget a goal; again is harmless."""
        with self._lock:
            self._goals.pop(bytes(goal.goal_id.uuid), None)

    def _drop_old(self) -> None:
        oldest_s = self._clock_s() - self._result_timeout_s
        over = [
            (goal.ended_s, goal_id)
            for goal_id, goal in self._goals.items()
            if goal.ended_s is not None
        ]
        too_many = len(over) - GOALS_KEPT_MAX
        for place, (ended_s, goal_id) in enumerate(sorted(over)):
            if place < too_many or ended_s <= oldest_s:
                del self._goals[goal_id]
