"""ClientGoalHandle: a goal as the client that sent it sees it, by rclpy's names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.ros.action.states import GoalStatus

if TYPE_CHECKING:
    from studio.ros.action.client import ActionClient
    from studio.ros.node.future import Future
    from studio.ros.types.classes import MessageValue


class ClientGoalHandle:
    """A goal that a server took or refused."""

    def __init__(self, client: ActionClient, goal_id: MessageValue, response: MessageValue) -> None:
        self._client = client
        self._goal_id = goal_id
        self._response = response
        self._status = GoalStatus.UNKNOWN

    @property
    def goal_id(self) -> MessageValue:
        """Its id, a unique_identifier_msgs/msg/UUID."""
        return self._goal_id

    @property
    def stamp(self) -> MessageValue:
        """When it was accepted, by the server's clock."""
        return self._response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the server took it."""
        return bool(self._response.accepted)

    @property
    def status(self) -> GoalStatus:
        """How far it is, as the server told last."""
        return self._status

    def told(self, status: GoalStatus) -> None:
        """Take note of its status; of the client. It never goes back."""
        self._status = max(self._status, status) if not self._status.is_over else self._status

    def cancel_goal_async(self) -> Future[Any]:
        """Ask that it end; becomes an action_msgs/srv/CancelGoal response.

        An error of the future says that the server is gone.
        """
        return self._client.cancel_goal(self)

    def cancel_goal(self) -> Any:  # noqa: ANN401  # a CancelGoal response
        """Ask that it end and wait for the answer; never within a callback.

        Raises:
            ActionServerGoneError: The server ended.
        """
        return waited(self.cancel_goal_async())

    def get_result_async(self) -> Future[Any]:
        """Ask for its result; becomes a response with `status` and `result`.

        An error of the future says that the server is gone.
        """
        return self._client.get_result(self)

    def get_result(self) -> Any:  # noqa: ANN401  # a GetResult response
        """Wait for its result; never within a callback.

        Raises:
            ActionServerGoneError: The server ended.
        """
        return waited(self.get_result_async())

    def __repr__(self) -> str:
        return (
            f"ClientGoalHandle(id={bytes(self._goal_id.uuid).hex()}, accepted={self.accepted}, "
            f"status={self._status.name})"
        )


def waited(future: Future[Any]) -> Any:  # noqa: ANN401
    """Block until a future is done, while somebody else spins the node."""
    future.wait()
    return future.result()
