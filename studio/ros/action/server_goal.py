"""ServerGoalHandle: a goal as its server sees it, and the goals that a server knows."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Any, Protocol

from studio.ros.action.protocol import GoalEvent, GoalStatus, KnownGoal, next_status
from studio.ros.node.task import Future

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.classes import MessageValue

GOALS_KEPT_MAX = 1_000
"""Limit of those that are over: a client that sends without end costs no more memory."""


class GoalServer(Protocol):
    """The part of an action server that a goal uses."""

    def execute(
        self, goal: ServerGoalHandle, callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Carry out the work on a goal, with the server's callback or another one."""
        ...

    def publish_feedback(self, goal: ServerGoalHandle, feedback: MessageValue) -> None:
        """Publish how far a goal is."""
        ...

    def publish_status(self) -> None:
        """Publish the states of all goals."""
        ...

    def forget(self, goal: ServerGoalHandle) -> None:
        """Remove a goal."""
        ...


class ServerGoalHandle:
    """A running goal; thread-safe.

    Attributes:
        result: Becomes the result when the goal is over.
        given_result: The result, where it was given when the goal was ended.
        ended_s: Time of its end, on the monotonic clock; None before.
    """

    def __init__(
        self, server: GoalServer, info: MessageValue, request: MessageValue, accepted_ns: int
    ) -> None:
        self._server = server
        self._info = info
        self._request = request
        self._accepted_ns = accepted_ns
        self._status = GoalStatus.ACCEPTED
        self._lock = threading.Lock()
        self.result: Future[MessageValue] = Future()
        self.given_result: MessageValue | None = None
        self.ended_s: float | None = None

    @property
    def request(self) -> Any:  # noqa: ANN401  # of the action's own type
        """The goal as it was sent."""
        return self._request

    @property
    def goal_id(self) -> MessageValue:
        """Its id, a unique_identifier_msgs/msg/UUID."""
        return self._info.goal_id

    @property
    def info(self) -> MessageValue:
        """Its id and when it was accepted, an action_msgs/msg/GoalInfo."""
        return self._info

    @property
    def status(self) -> GoalStatus:
        """Its state."""
        return self._status

    @property
    def is_active(self) -> bool:
        """Whether it is not over."""
        return self._status.is_active

    @property
    def is_cancel_requested(self) -> bool:
        """Whether it is to end: clean up, call `canceled()` and return a result."""
        return self._status is GoalStatus.CANCELING

    @property
    def known(self) -> KnownGoal:
        """Return the facts that requests to cancel are checked against."""
        return KnownGoal(bytes(self.goal_id.uuid), self._accepted_ns, self._status)

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Execute it, with the server's callback or another one.

        Raises:
            GoalStateError: It was begun before, or is over.
        """
        # A goal that was asked to end before it began is still given to its callback.
        if not self.is_cancel_requested:
            self.change(GoalEvent.EXECUTE)
        self._server.execute(self, execute_callback)

    def publish_feedback(self, feedback: MessageValue) -> None:
        """Publish how far it is.

        Raises:
            MessageValueError: It is no feedback of this action.
        """
        self._server.publish_feedback(self, feedback)

    def succeed(self, response: MessageValue | None = None) -> None:
        """End it as succeeded; then return the result, or give it here.

        Raises:
            GoalStateError: It is over, or was never begun.
        """
        self.change(GoalEvent.SUCCEED)
        self.given_result = response

    def abort(self, response: MessageValue | None = None) -> None:
        """End it as aborted.

        Raises:
            GoalStateError: It is over, or was never begun.
        """
        self.change(GoalEvent.ABORT)
        self.given_result = response

    def canceled(self, response: MessageValue | None = None) -> None:
        """End it as canceled.

        Raises:
            GoalStateError: Nobody asked it to end, or it is over.
        """
        self.change(GoalEvent.CANCELED)
        self.given_result = response

    def change(self, event: GoalEvent) -> None:
        """Take it to the state after an event, and publish that.

        Raises:
            GoalStateError: The event does not follow.
        """
        with self._lock:
            self._status = next_status(self._status, event)
        self._server.publish_status()

    def destroy(self) -> None:
        """Remove it from the server before its time."""
        self._server.forget(self)


class ServerGoals:
    """Goals by their ids; thread-safe."""

    def __init__(
        self, result_timeout_s: float, clock_s: Callable[[], float] = time.monotonic
    ) -> None:
        self._result_timeout_s = result_timeout_s
        self._clock_s = clock_s
        self._goals: dict[bytes, ServerGoalHandle] = {}
        self._lock = threading.Lock()

    def add(self, goal_id: bytes, make: Callable[[], ServerGoalHandle]) -> ServerGoalHandle | None:
        """Add a goal; return None when one of that id is known already."""
        with self._lock:
            self._drop_old()
            if goal_id in self._goals:
                return None
            made = self._goals[goal_id] = make()
            return made

    def find(self, goal_id: bytes) -> ServerGoalHandle | None:
        """Return a goal by its id."""
        with self._lock:
            self._drop_old()
            return self._goals.get(goal_id)

    def all(self) -> list[ServerGoalHandle]:
        """Return every goal in the order in which they were accepted."""
        with self._lock:
            self._drop_old()
            return list(self._goals.values())

    def end(self, goal: ServerGoalHandle) -> None:
        """Begin the time for which a goal that is over is kept."""
        with self._lock:
            goal.ended_s = self._clock_s()

    def remove(self, goal: ServerGoalHandle) -> None:
        """Remove a goal; again is harmless."""
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
