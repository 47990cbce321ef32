"""ActionClient: sends goals and follows them, by rclpy's names."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from typing import TYPE_CHECKING, Any

from studio.errors import ActionServerGoneError, DroppedError, NotServedError, WireError
from studio.ros.action.protocol import (
    FEEDBACK_QOS,
    ActionNames,
    ActionQos,
    GoalStatus,
    goal_id_message,
    goal_id_of,
    new_goal_id,
)
from studio.ros.cdr import check_kind
from studio.ros.node.service_client import SERVICE_TIMEOUT_S
from studio.ros.node.task import Future
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from studio.ros.types.classes import definition_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.node import Node
    from studio.ros.node.service_client import Client
    from studio.ros.node.subscription import Subscription
    from studio.ros.node.timer import Timer
    from studio.ros.node.work import CallbackGroup
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ActionType

CHECK_EVERY_S = 0.5
RETURNS_WITHIN_S = 10.0
"""A server whose router is back shows itself again before long."""
TRIES_MAX = 20
RESULT_TIMEOUT_S = 365 * 24 * 3600.0
"""A goal may take as long as it likes: the end of its server ends the wait."""
GOALS_KEPT_MAX = 1_000
"""The last goals sent: of these feedback and status are received."""


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
        """Its state, as the server reported last."""
        return self._status

    def update_status(self, status: GoalStatus) -> None:
        """Set its status, which never goes back; called by the client."""
        self._status = max(self._status, status) if not self._status.is_over else self._status

    def cancel_goal_async(self) -> Future[Any]:
        """Ask the server to cancel it; becomes an action_msgs/srv/CancelGoal response.

        The future has an error when the server is gone.
        """
        return self._client.cancel_goal(self)

    def cancel_goal(self) -> Any:  # noqa: ANN401  # a CancelGoal response
        """Ask that it end and wait for the answer; never within a callback.

        Raises:
            ActionServerGoneError: The server ended.
        """
        return wait_for_future(self.cancel_goal_async())

    def get_result_async(self) -> Future[Any]:
        """Ask for its result; becomes a response with `status` and `result`.

        The future has an error when the server is gone.
        """
        return self._client.get_result(self)

    def get_result(self) -> Any:  # noqa: ANN401  # a GetResult response
        """Wait for its result; never within a callback.

        Raises:
            ActionServerGoneError: The server ended.
        """
        return wait_for_future(self.get_result_async())

    def __repr__(self) -> str:
        return (
            f"ClientGoalHandle(id={bytes(self._goal_id.uuid).hex()}, accepted={self.accepted}, "
            f"status={self._status.name})"
        )


class ActionClient:
    """Sends the goals of one action.

    Where rclpy would wait for ever, because the node of the server ended, futures end with
    ActionServerGoneError.
    """

    def __init__(  # noqa: PLR0913  # as in rclpy
        self,
        node: Node,
        action_type: ActionType,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = FEEDBACK_QOS,
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        self._node = node
        self._type = action_type
        self._name = node.resolve_service_name(action_name)
        self._lock = threading.Lock()
        self._listening: OrderedDict[bytes, Callable[[Any], object]] = OrderedDict()
        self._goals: OrderedDict[bytes, ClientGoalHandle] = OrderedDict()
        self._statuses: dict[bytes, int] = {}
        self._goal_info_type = node.context.wire.types.message("action_msgs/msg/GoalInfo")
        names = ActionNames.of(self._name)
        qos = ActionQos(
            goal_service_qos_profile,
            result_service_qos_profile,
            cancel_service_qos_profile,
            feedback_sub_qos_profile,
            status_sub_qos_profile,
        )
        # First, for rings are emptied in this order: the last feedback comes before the result.
        self._subscriptions = self._subscribe(names, qos, callback_group)
        self._send, self._cancel, self._result = self._clients(names, qos, callback_group)

    @property
    def action_type(self) -> ActionType:
        """The type of the action."""
        return self._type

    @property
    def action_name(self) -> str:
        """The full name of the action."""
        return self._name

    def server_is_ready(self) -> bool:
        """Whether a node serves all parts of the action."""
        return all(one.service_is_ready() for one in (self._send, self._cancel, self._result))

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node serves the action; False when none does in time."""
        end_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        for client in (self._send, self._cancel, self._result):
            left_s = None if end_s is None else max(0.0, end_s - time.monotonic())
            if not client.wait_for_service(timeout_sec=left_s):
                return False
        return True

    def send_goal_async(
        self,
        goal: MessageValue,
        feedback_callback: Callable[[Any], object] | None = None,
        goal_uuid: MessageValue | None = None,
    ) -> Future[ClientGoalHandle]:
        """Send a goal; becomes its handle, with whether it was accepted.

        The callback receives messages with `goal_id` and `feedback`.

        Raises:
            MessageValueError: It is no goal of this action.
        """
        check_kind(definition_of(self._type.Goal), goal)
        goal_id = goal_uuid or goal_id_message(self._node.context.wire.types, new_goal_id())
        if feedback_callback is not None:
            # Before it is sent: the first feedback may come before the answer.
            self._keep(self._listening, goal_id, feedback_callback)
        return self._ask(
            self._send,
            self._type.SendGoal.Request(goal_id=goal_id, goal=goal),
            lambda reply: self._answered(goal_id, reply),
        )

    def send_goal(self, goal: MessageValue, **options: Any) -> Any:  # noqa: ANN401
        """Send a goal and wait for its result; never within a callback.

        Gives a response with `status` and `result`, None when the goal was refused.

        Raises:
            ActionServerGoneError: The server ended.
        """
        handle: ClientGoalHandle = wait_for_future(self.send_goal_async(goal, **options))
        return handle.get_result() if handle.accepted else None

    def cancel_goal(self, goal: ClientGoalHandle) -> Future[Any]:
        """Ask that a goal end; called by goals."""
        info = self._goal_info_type(goal_id=goal.goal_id)
        request = self._cancel.srv_type.Request(goal_info=info)
        return self._ask(self._cancel, request)

    def get_result(self, goal: ClientGoalHandle) -> Future[Any]:
        """Ask for the result of a goal; called by goals."""
        request = self._type.GetResult.Request(goal_id=goal.goal_id)
        return ResultWait(
            self._node, self._result, request, lambda reply: self._ended(goal, reply), self._name
        ).answer

    def destroy(self) -> None:
        """Take it back; futures that wait are cancelled."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        for client in (self._send, self._cancel, self._result):
            self._node.destroy_client(client)

    def _clients(
        self, names: ActionNames, qos: ActionQos, group: CallbackGroup | None
    ) -> tuple[Client, Client, Client]:
        cancel = self._node.context.wire.types.service("action_msgs/srv/CancelGoal")
        send, cancel, result = (
            self._node.create_client(
                kind, name, qos_profile=profile, callback_group=group, timeout_s=timeout_s
            )
            for kind, name, profile, timeout_s in (
                (self._type.SendGoal, names.send_goal, qos.goal, SERVICE_TIMEOUT_S),
                (cancel, names.cancel_goal, qos.cancel, SERVICE_TIMEOUT_S),
                (self._type.GetResult, names.get_result, qos.result, RESULT_TIMEOUT_S),
            )
        )
        return send, cancel, result

    def _subscribe(
        self, names: ActionNames, qos: ActionQos, group: CallbackGroup | None
    ) -> list[Subscription]:
        status = self._node.context.wire.types.message("action_msgs/msg/GoalStatusArray")
        return [
            self._node.create_subscription(kind, name, callback, profile, callback_group=group)
            for kind, name, callback, profile in (
                (self._type.FeedbackMessage, names.feedback, self._on_feedback, qos.feedback),
                (status, names.status, self._on_status, qos.status),
            )
        ]

    def _ask(
        self,
        client: Client,
        request: MessageValue,
        follow: Callable[[Any], Any] = lambda reply: reply,
    ) -> Future[Any]:
        """Call a service of the server; the future becomes what `follow` returns for the reply."""
        asked = client.call_async(request)
        answer: Future[Any] = Future(executor=self._node.executor)

        def settle() -> None:
            error = asked.exception()
            if asked.cancelled():
                answer.cancel()
            elif error is not None:
                answer.set_exception(self._in_terms_of_action(client, error))
            else:
                answer.set_result(follow(asked.result()))

        asked.listen(settle)
        answer.listen(asked.cancel)
        return answer

    def _in_terms_of_action(self, client: Client, error: BaseException) -> BaseException:
        """Return an error in terms of the action."""
        if not isinstance(error, NotServedError):
            return error
        if client.service_is_ready():
            return DroppedError("action", self._name)
        if client is self._send:
            return NotServedError("action", self._name)
        return ActionServerGoneError(self._name)

    def _answered(self, goal_id: MessageValue, reply: MessageValue) -> ClientGoalHandle:
        goal = ClientGoalHandle(self, goal_id, reply)
        if goal.accepted:
            self._keep(self._goals, goal_id, goal)
            goal.update_status(
                GoalStatus(self._statuses.get(goal_id_of(goal_id), GoalStatus.UNKNOWN))
            )
        return goal

    def _ended(self, goal: ClientGoalHandle, reply: MessageValue) -> MessageValue:
        # Its feedback is still received: the last of it may come after the result.
        goal.update_status(GoalStatus(reply.status))
        return reply

    def _keep(self, kept: OrderedDict[bytes, Any], goal_id: MessageValue, what: object) -> None:
        with self._lock:
            kept[goal_id_of(goal_id)] = what
            if len(kept) > GOALS_KEPT_MAX:
                kept.popitem(last=False)

    def _on_feedback(self, message: MessageValue) -> object:
        with self._lock:
            callback = self._listening.get(goal_id_of(message.goal_id))
        # What it returns goes to the executor, which carries out coroutines too.
        return callback(message) if callback is not None else None

    def _on_status(self, message: MessageValue) -> None:
        statuses = {goal_id_of(one.goal_info.goal_id): one.status for one in message.status_list}
        with self._lock:
            # Of a goal whose acceptance is not taken in yet, too.
            self._statuses = statuses
            goals = [(self._goals.get(goal_id), status) for goal_id, status in statuses.items()]
        for goal, status in goals:
            if goal is not None:
                goal.update_status(GoalStatus(status))


class ResultWait:
    """Waits as long as the goal takes, or until its server is gone.

    A question ends without an answer when the server ends, and when the router does: then it is
    asked again once router and server are there again, since the goal went on meanwhile.
    """

    def __init__(
        self,
        node: Node,
        client: Client,
        request: MessageValue,
        follow: Callable[[Any], Any],
        action_name: str,
    ) -> None:
        self._node = node
        self._client = client
        self._request = request
        self._follow = follow
        self._gone = ActionServerGoneError(action_name)
        self._asked: Future[Any] | None = None
        self._timer: Timer | None = None
        self._router_was_away = False
        self._patience_until_s = 0.0
        self._tries_left = TRIES_MAX
        self.answer: Future[Any] = Future(executor=node.executor)
        self._ask()
        self.answer.listen(self._end)

    def _ask(self) -> None:
        try:
            asked = self._asked = self._client.call_async(self._request)
        except WireError as error:
            self.answer.set_exception(error)
            return
        asked.listen(lambda: self._settle(asked))

    def _settle(self, asked: Future[Any]) -> None:
        error = asked.exception()
        if self.answer.done():
            return
        if asked.cancelled():
            self.answer.cancel()
        elif isinstance(error, NotServedError):
            self._wait_for_server()
        elif error is not None:
            self.answer.set_exception(error)
        else:
            self.answer.set_result(self._follow(asked.result()))

    def _wait_for_server(self) -> None:
        self._tries_left -= 1
        if self._tries_left <= 0:
            self.answer.set_exception(self._gone)
            return
        self._stay_patient()
        self._timer = self._node.create_timer(
            CHECK_EVERY_S, self._check_server, callback_group=ReentrantCallbackGroup()
        )

    def _check_server(self) -> None:
        if self.answer.done():  # it was given up before this check
            self._stop_waiting()
        if self.answer.done() or not self._stay_patient():
            return
        if self._client.service_is_ready():
            self._stop_waiting()
            self._ask()
        elif not self._router_was_away or time.monotonic() > self._patience_until_s:
            self._stop_waiting()
            self.answer.set_exception(self._gone)

    def _stay_patient(self) -> bool:
        """Take note of a router that is away; whether one is there."""
        is_there = self._node.context.wire.is_connected
        if not is_there:
            self._router_was_away = True
            self._patience_until_s = time.monotonic() + RETURNS_WITHIN_S
        return is_there

    def _stop_waiting(self) -> None:
        timer, self._timer = self._timer, None
        if timer is not None:
            self._node.destroy_timer(timer)

    def _end(self) -> None:
        self._stop_waiting()
        if self._asked is not None:
            self._asked.cancel()


def wait_for_future(future: Future[Any]) -> Any:  # noqa: ANN401
    """Block until a future is done, while somebody else spins the node."""
    future.wait()
    return future.result()
