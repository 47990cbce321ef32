"""ServerGoalHandle: a goal as the server that accepted it sees it, by rclpy's names."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from studio.ros.action.cancelling import KnownGoal
from studio.ros.action.states import GoalEvent, GoalStatus, next_status

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.action.server import ActionServer
    from studio.ros.node.future import Future
    from studio.ros.types.classes import MessageValue


class ServerGoalHandle:
    """A goal under way; any thread may report on it.

    Attributes:
        result: Becomes the result when the goal is over, for those who wait for it.
        ended_s: When it was over, on the monotonic clock; None before.
    """

    def __init__(
        self, server: ActionServer, info: MessageValue, request: MessageValue, accepted_ns: int
    ) -> None:
        self._server = server
        self._info = info
        self._request = request
        self._accepted_ns = accepted_ns
        self._status = GoalStatus.ACCEPTED
        self._lock = threading.Lock()
        self.result: Future[MessageValue] = server.new_future()
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
        """How far it is."""
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
        """What requests to cancel are held against."""
        return KnownGoal(bytes(self.goal_id.uuid), self._accepted_ns, self._status)

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Begin to work on it, with the server's callback or another one.

        Raises:
            GoalStateError: It was begun before, or is over.
        """
        # A goal that was asked to end before it began is still given to its callback.
        if not self.is_cancel_requested:
            self.change(GoalEvent.EXECUTE)
        self._server.execute(self, execute_callback)

    def publish_feedback(self, feedback: MessageValue) -> None:
        """Tell how far it is.

        Raises:
            MessageValueError: It is no feedback of this action.
        """
        self._server.publish_feedback(self, feedback)

    def succeed(self) -> None:
        """Say that it reached its end; then return the result.

        Raises:
            GoalStateError: It is over, or was never begun.
        """
        self.change(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """Say that it cannot be reached.

        Raises:
            GoalStateError: It is over, or was never begun.
        """
        self.change(GoalEvent.ABORT)

    def canceled(self) -> None:
        """Say that it ended because it was asked to.

        Raises:
            GoalStateError: Nobody asked it to end, or it is over.
        """
        self.change(GoalEvent.CANCELED)

    def change(self, event: GoalEvent) -> None:
        """Take it to the state after an event, and tell everybody.

        Raises:
            GoalStateError: The event does not follow.
        """
        with self._lock:
            self._status = next_status(self._status, event)
        self._server.publish_status()

    def destroy(self) -> None:
        """Forget it before its time."""
        self._server.forget(self)
