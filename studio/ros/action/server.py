"""ActionServer: accepts goals, executes them and reports on them, by rclpy's names."""

from __future__ import annotations

import asyncio
import inspect
import threading
import traceback
from collections import deque
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from studio.errors import MessageValueError
from studio.ros import strictness
from studio.ros.action.protocol import (
    FEEDBACK_QOS,
    ActionNames,
    ActionQos,
    CancelCode,
    GoalEvent,
    GoalStatus,
    can_follow,
    goal_id_of,
    goals_to_cancel,
)
from studio.ros.action.server_goal import ServerGoalHandle, ServerGoals
from studio.ros.cdr import check_kind
from studio.ros.node.clock import stamp_ns
from studio.ros.node.work import ReentrantCallbackGroup, Work
from studio.ros.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from studio.ros.types.classes import definition_of

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from studio.ros.node.logger import Logger
    from studio.ros.node.node import Node
    from studio.ros.node.service import Service
    from studio.ros.node.work import CallbackGroup
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ActionType

RESULT_TIMEOUT_S = 900
# Of a callback of the user's; what it awaits may be cancelled, which is no Exception.
_RAISED = (Exception, asyncio.CancelledError)


class GoalResponse(IntEnum):
    """Whether a goal is taken."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(IntEnum):
    """Whether a goal will end when it is asked to."""

    REJECT = 1
    ACCEPT = 2


def default_goal_callback(goal_request: object) -> GoalResponse:
    """Take every goal."""
    del goal_request
    return GoalResponse.ACCEPT


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Begin to work on a goal at once."""
    goal_handle.execute()


def default_cancel_callback(cancel_request: object) -> CancelResponse:
    """Let no goal end before its time."""
    del cancel_request
    return CancelResponse.REJECT


async def call_or_await(callback: Callable[..., Any], *arguments: object) -> Any:  # noqa: ANN401
    """Call a function or coroutine function, and return its result."""
    result = callback(*arguments)
    return await result if inspect.isawaitable(result) else result


class ActionServer:
    """Serves one action; several goals may run at once.

    Callbacks may be functions or coroutines. One that raises aborts its goal, and its error goes
    to the log. Results are kept for `result_timeout` seconds after the end of a goal.
    """

    def __init__(  # noqa: PLR0913  # as in rclpy
        self,
        node: Node,
        action_type: ActionType,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any] = (
            default_handle_accepted_callback
        ),
        cancel_callback: Callable[[ServerGoalHandle], Any] = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = FEEDBACK_QOS,
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = RESULT_TIMEOUT_S,
    ) -> None:
        self._node = node
        self._type = action_type
        self._goals = ServerGoals(result_timeout)
        self._destroyed = False
        self._status_lock = threading.Lock()
        self._status_type = node.context.wire.types.message("action_msgs/msg/GoalStatusArray")
        self._goal_status_type = node.context.wire.types.message("action_msgs/msg/GoalStatus")
        self._goal_info_type = node.context.wire.types.message("action_msgs/msg/GoalInfo")
        self.register_goal_callback(goal_callback)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        names = ActionNames.of(node.resolve_service_name(action_name))
        qos = ActionQos(
            goal_service_qos_profile,
            result_service_qos_profile,
            cancel_service_qos_profile,
            feedback_pub_qos_profile,
            status_pub_qos_profile,
        )
        self._feedback = node.create_publisher(
            action_type.FeedbackMessage, names.feedback, qos.feedback
        )
        self._status = node.create_publisher(self._status_type, names.status, qos.status)
        self._later = CoroutineQueue()
        node.add_work(self._later)
        self._services = self._serve(names, qos, callback_group)
        node.on_destroy(self.destroy)
        self.publish_status()

    @property
    def action_type(self) -> ActionType:
        """The type of the action."""
        return self._type

    def register_goal_callback(self, goal_callback: Callable[[Any], Any] | None) -> None:
        """Decide with another callback whether a goal is taken; None takes all."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Begin goals with another callback; None begins them at once."""
        self._accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_cancel_callback(
        self, cancel_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Decide with another callback whether a goal may end; None lets none."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(
        self, execute_callback: Callable[[ServerGoalHandle], Any]
    ) -> None:
        """Work on goals with another callback.

        Raises:
            TypeError: It cannot be called.
        """
        if not callable(execute_callback):
            raise TypeError("execute_callback must be a function that takes the goal handle")
        self._execute_callback = execute_callback

    def destroy(self) -> None:
        """End the server; clients of running goals learn that nobody serves the action."""
        with self._status_lock:
            self._destroyed = True
        self._node.forget_destroy(self.destroy)
        for service in self._services:
            self._node.destroy_service(service)
        self._node.remove_work(self._later)
        # After the services: what waits for results must not be answered with one of no goal.
        for goal in self._goals.all():
            goal.result.set_result(self._type.Result())
        for publisher in (self._feedback, self._status):
            self._node.destroy_publisher(publisher)

    def execute(
        self, goal: ServerGoalHandle, callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Execute a goal; called by goals."""
        self._later.add(self._execute(goal, callback or self._execute_callback))

    def publish_feedback(self, goal: ServerGoalHandle, feedback: MessageValue) -> None:
        """Publish feedback of a goal; called by goals.

        Raises:
            MessageValueError: It is no feedback of this action.
        """
        expected = definition_of(self._type.Feedback).name
        if type(feedback).__name__ != self._type.Feedback.__name__:
            raise MessageValueError(expected, "a value of it is expected as feedback")
        self._feedback.publish(self._type.FeedbackMessage(goal_id=goal.goal_id, feedback=feedback))

    def publish_status(self) -> None:
        """Publish the states of all goals, until the server is destroyed; called by goals."""
        # Late subscriptions get the last one published: it must be the newest.
        with self._status_lock:
            if not self._destroyed:
                self._status.publish(self._status_type(status_list=self._statuses()))

    def _statuses(self) -> list[MessageValue]:
        return [
            self._goal_status_type(goal_info=goal.info, status=int(goal.status))
            for goal in self._goals.all()
        ]

    def forget(self, goal: ServerGoalHandle) -> None:
        """Remove a goal; called by goals."""
        self._goals.remove(goal)

    def _serve(
        self, names: ActionNames, qos: ActionQos, group: CallbackGroup | None
    ) -> list[Service]:
        cancel = self._node.context.wire.types.service("action_msgs/srv/CancelGoal")
        # A request for a result waits for the end of its goal: it must not block others.
        waiting = ReentrantCallbackGroup()
        return [
            self._node.create_service(
                kind, name, callback, qos_profile=profile, callback_group=chosen
            )
            for kind, name, callback, profile, chosen in (
                (self._type.GetResult, names.get_result, self._on_get_result, qos.result, waiting),
                (cancel, names.cancel_goal, self._on_cancel, qos.cancel, group),
                (self._type.SendGoal, names.send_goal, self._on_send_goal, qos.goal, group),
            )
        ]

    async def _on_send_goal(self, request: MessageValue, response: MessageValue) -> MessageValue:
        goal_id = goal_id_of(request.goal_id)
        if self._goals.find(goal_id) is not None:  # its callback is not asked again
            return self._refused(goal_id, response)
        if await self._decide(self._goal_callback, request.goal) != GoalResponse.ACCEPT:
            return response
        stamp = self._node.get_clock().now().to_msg()
        info = self._goal_info_type(goal_id=request.goal_id, stamp=stamp)
        goal = self._goals.add(
            goal_id, lambda: ServerGoalHandle(self, info, request.goal, stamp_ns(stamp))
        )
        if goal is None:  # it came twice at the same time
            return self._refused(goal_id, response)
        self.publish_status()
        response.accepted, response.stamp = True, stamp
        # After the answer: a client must not learn of the end before it learned of the beginning.
        self._later.add(self._begin(goal))
        return response

    def _refused(self, goal_id: bytes, response: MessageValue) -> MessageValue:
        self._node.get_logger().error(
            f"A goal was refused: one with the id {goal_id.hex()} is known already."
        )
        return response

    async def _on_cancel(self, request: MessageValue, response: MessageValue) -> MessageValue:
        goals = {goal.known.goal_id: goal for goal in self._goals.all()}
        asked = request.goal_info
        meant, code = goals_to_cancel(
            [goal.known for goal in goals.values()],
            goal_id_of(asked.goal_id),
            stamp_ns(asked.stamp),
        )
        for known in meant:
            goal = goals[known.goal_id]
            decided = await self._decide(self._cancel_callback, goal)
            # It may have come to its end while the callback was deciding.
            if decided == CancelResponse.ACCEPT and can_follow(goal.status, GoalEvent.CANCEL_GOAL):
                goal.change(GoalEvent.CANCEL_GOAL)
                response.goals_canceling.append(goal.info)
        if meant and not response.goals_canceling:
            code = CancelCode.ERROR_REJECTED
        response.return_code = int(code)
        return response

    async def _on_get_result(self, request: MessageValue, response: MessageValue) -> MessageValue:
        goal = self._goals.find(goal_id_of(request.goal_id))
        if goal is None:
            response.status = int(GoalStatus.UNKNOWN)
            return response
        response.result = await goal.result
        response.status = int(goal.status)
        return response

    async def _decide(self, callback: Callable[[Any], Any], about: object) -> Any:  # noqa: ANN401
        """Call a callback of the user; one that raises refuses."""
        try:
            return await call_or_await(callback, about)
        except _RAISED as error:
            self._log_raised(callback, error)
            return None

    async def _begin(self, goal: ServerGoalHandle) -> None:
        try:
            await call_or_await(self._accepted_callback, goal)
        except _RAISED as error:
            self._log_raised(self._accepted_callback, error)
            if goal.status is GoalStatus.ACCEPTED:
                goal.change(GoalEvent.EXECUTE)
                self._end(goal, None)

    async def _execute(
        self, goal: ServerGoalHandle, callback: Callable[[ServerGoalHandle], Any]
    ) -> None:
        try:
            result = await call_or_await(callback, goal)
        except _RAISED as error:
            self._log_raised(callback, error, "execute callback")
            if strictness.is_begun():
                self._warn_if_active(goal)
            self._end(goal, None)
            return
        self._warn_if_active(goal)
        if result is None:
            result = goal.given_result
        if strictness.is_begun() and not isinstance(result, self._type.Result):
            given = type(result).__name__
            raise AssertionError(
                f"The 'result' field must be a sub message of type '{self._type.Result.__name__}': "
                f"the execute callback returned {given}, end it with return result"
            )
        self._end(goal, result)

    def _warn_if_active(self, goal: ServerGoalHandle) -> None:
        if goal.is_active:
            self._logger().warning(
                "Goal state not set, assuming aborted: call succeed(), abort() or canceled() "
                "on the goal handle before the result is returned."
            )

    def _logger(self) -> Logger:
        return self._node.get_logger().get_child("action_server")

    def _end(self, goal: ServerGoalHandle, result: object) -> None:
        """Send the result; a goal whose state was not set is aborted."""
        kind = self._type.Result
        if goal.is_active:
            goal.abort()
        try:
            given = kind() if result is None else check_kind(definition_of(kind), result)
        except MessageValueError as error:
            self._node.get_logger().error(f"The result of a goal is left empty: {error}")
            given = kind()
        self._goals.end(goal)
        goal.result.set_result(given)

    def _log_raised(
        self, callback: Callable[..., Any], error: BaseException, word: str = ""
    ) -> None:
        if self._destroyed:  # what it met then is the end of the node
            return
        if strictness.is_begun() and word:
            self._logger().error(f"Error raised in {word}: {error}")
            traceback.print_exception(error)
            return
        name = getattr(callback, "__name__", "a callback")
        text = "".join(traceback.format_exception(error)[-2:]).strip()
        self._logger().error(f"Error raised in {name} of the action: {text}")


class CoroutineQueue(Work):
    """Keeps coroutines until they are started, concurrently and in order.

    Between two `spin_once` nobody spins a node: what is added then must not be lost.
    """

    def __init__(self) -> None:
        super().__init__(ReentrantCallbackGroup())
        self._waiting: deque[Coroutine[Any, Any, Any]] = deque()
        self._destroyed = False

    def add(self, coroutine: Coroutine[Any, Any, Any]) -> None:
        """Run a coroutine; thread-safe. After the end it is closed."""
        self._waiting.append(coroutine)
        if self._destroyed:
            self._close_waiting()
        else:
            self.announce()

    @property
    def is_ready(self) -> bool:
        """Whether one was not begun."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """Return the oldest."""
        coroutine = self._oldest()
        return None if coroutine is None else lambda: coroutine

    def destroy(self) -> None:
        """Close those that were not begun."""
        self._destroyed = True
        self._close_waiting()

    def _close_waiting(self) -> None:
        while (coroutine := self._oldest()) is not None:
            coroutine.close()

    def _oldest(self) -> Coroutine[Any, Any, Any] | None:
        try:
            return self._waiting.popleft()
        except IndexError:
            return None
