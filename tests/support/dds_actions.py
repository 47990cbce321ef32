"""Actions on DDS: a server of Fibonacci, and a client of any action."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Protocol

from studio.ros.action.protocol import (
    FEEDBACK_QOS,
    ActionNames,
    CancelCode,
    GoalEvent,
    GoalStatus,
    KnownGoal,
    can_follow,
    goal_id_message,
    goal_id_of,
    goals_to_cancel,
    new_goal_id,
    next_status,
)
from studio.ros.cdr import codec_of
from studio.ros.names import full_type_name
from studio.ros.qos import qos_profile_action_status_default
from studio.ros.types.convert import from_dict, to_dict

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue
    from tests.support.dds_node import DdsNode, Reply, Timer

FIBONACCI: Final = "example_interfaces/action/Fibonacci"
_CANCEL: Final = "action_msgs/srv/CancelGoal"
_STATUS: Final = "action_msgs/msg/GoalStatusArray"
_PERIOD_S: Final = 0.05


class Say(Protocol):
    """Writes a line about what happened."""

    def __call__(self, what: str, **values: object) -> None: ...


@dataclass
class _Goal:
    order: int
    info: Any
    accepted_ns: int
    sequence: list[int] = field(default_factory=lambda: [0, 1])
    status: GoalStatus = GoalStatus.ACCEPTED
    timer: Timer | None = None
    waiting: list[Reply] = field(default_factory=list["Reply"])


class FibonacciServer:
    """Serves Fibonacci: a number and feedback every 50 ms; a negative order is refused."""

    def __init__(self, node: DdsNode, action: str, say: Say) -> None:
        self._node, self._say, self._types = node, say, node.types
        self._action, self._name = self._types.action(FIBONACCI), action
        self._goals: dict[bytes, _Goal] = {}
        names = ActionNames.of(node.full_name(action))
        node.create_service(self._action.SendGoal, names.send_goal, self._on_goal)
        node.create_service(self._types.service(_CANCEL), names.cancel_goal, self._on_cancel)
        node.create_late_service(self._action.GetResult, names.get_result, self._on_get_result)
        self._feedback = node.create_publisher(
            self._action.FeedbackMessage, names.feedback, FEEDBACK_QOS
        )
        self._statuses = self._types.message(_STATUS)
        self._status = node.create_publisher(
            self._statuses, names.status, qos_profile_action_status_default
        )

    def _on_goal(self, request: MessageValue, response: MessageValue) -> MessageValue:
        goal_id = goal_id_of(request.goal_id)
        order = int(request.goal.order)
        self._say("goal", action=self._name, goal_id=goal_id.hex(), order=order)
        response.accepted = order >= 0 and goal_id not in self._goals
        response.stamp = self._node.now()
        if response.accepted:
            info = self._types.message("action_msgs/msg/GoalInfo")(
                goal_id=request.goal_id, stamp=response.stamp
            )
            goal = self._goals[goal_id] = _Goal(order, info, time.time_ns())
            goal.timer = self._node.process.every(_PERIOD_S, lambda: self._go_on(goal))
            self._publish_status()
        return response

    def _go_on(self, goal: _Goal) -> None:
        if goal.status is GoalStatus.ACCEPTED:
            self._change(goal, GoalEvent.EXECUTE)
            return
        if goal.status is GoalStatus.CANCELING:
            self._finish(goal, GoalEvent.CANCELED)
            return
        if len(goal.sequence) > goal.order:
            self._finish(goal, GoalEvent.SUCCEED)
            return
        goal.sequence.append(goal.sequence[-1] + goal.sequence[-2])
        feedback = self._action.Feedback(sequence=goal.sequence)
        told = self._action.FeedbackMessage(goal_id=goal.info.goal_id, feedback=feedback)
        self._feedback.publish(told)

    def _on_cancel(self, request: MessageValue, response: MessageValue) -> MessageValue:
        info = request.goal_info
        known = [KnownGoal(key, one.accepted_ns, one.status) for key, one in self._goals.items()]
        stamp_ns = int(info.stamp.sec) * 10**9 + int(info.stamp.nanosec)
        meant, code = goals_to_cancel(known, goal_id_of(info.goal_id), stamp_ns)
        for one in meant:
            self._change(self._goals[one.goal_id], GoalEvent.CANCEL_GOAL)
        response.return_code = int(code)
        response.goals_canceling = [self._goals[one.goal_id].info for one in meant]
        self._say("cancel", action=self._name, goals=[one.goal_id.hex() for one in meant])
        return response

    def _on_get_result(self, request: MessageValue, reply: Reply) -> None:
        goal = self._goals.get(goal_id_of(request.goal_id))
        if goal is None:
            reply(self._action.GetResult.Response(status=int(GoalStatus.UNKNOWN)))
        elif goal.status.is_over:
            reply(self._result(goal))
        else:
            goal.waiting.append(reply)

    def _finish(self, goal: _Goal, event: GoalEvent) -> None:
        if goal.timer is not None:
            goal.timer.cancel()
        self._change(goal, event)
        waiting, goal.waiting = goal.waiting, []
        for reply in waiting:
            reply(self._result(goal))

    def _result(self, goal: _Goal) -> MessageValue:
        result = self._action.Result(sequence=goal.sequence[: max(1, goal.order + 1)])
        return self._action.GetResult.Response(status=int(goal.status), result=result)

    def _change(self, goal: _Goal, event: GoalEvent) -> None:
        if can_follow(goal.status, event):
            goal.status = next_status(goal.status, event)
            self._publish_status()

    def _publish_status(self) -> None:
        kind = self._types.message("action_msgs/msg/GoalStatus")
        self._status.publish(
            self._statuses(
                status_list=[
                    kind(goal_info=one.info, status=int(one.status)) for one in self._goals.values()
                ]
            )
        )


class GoalSender:
    """A client of one action: sends goals, asks for their results, and says what it hears."""

    def __init__(self, node: DdsNode, action: str, type_name: str, say: Say) -> None:
        self._node, self._say, self._name = node, say, action
        self._action = node.types.action(full_type_name(type_name, "action"))
        names = ActionNames.of(node.full_name(action))
        self._send = node.create_client(self._action.SendGoal, names.send_goal)
        self._cancel_type = node.types.service(_CANCEL)
        self._cancel = node.create_client(self._cancel_type, names.cancel_goal)
        self._get_result = node.create_client(self._action.GetResult, names.get_result)
        message, statuses = self._action.FeedbackMessage, node.types.message(_STATUS)
        node.create_subscription(message, names.feedback, self._hear_feedback, FEEDBACK_QOS)
        self._statuses = codec_of(statuses)
        node.create_subscription(
            statuses, names.status, self._hear_status, qos_profile_action_status_default
        )

    def send(self, goal: dict[str, Any]) -> str:
        """Send a goal; returns its id in hexadecimal."""
        goal_id = new_goal_id()
        request = self._action.SendGoal.Request(
            goal_id=goal_id_message(self._node.types, goal_id),
            goal=from_dict(self._action.Goal, goal),
        )
        self._send.call(request, lambda response: self._on_response(goal_id, response))
        return goal_id.hex()

    def cancel(self, goal_id: str) -> None:
        """Ask that a goal ends."""
        request: Any = self._cancel_type.Request()
        request.goal_info.goal_id = goal_id_message(self._node.types, bytes.fromhex(goal_id))
        self._cancel.call(
            request,
            lambda response: self._say(
                "cancel_response",
                action=self._name,
                goal_id=goal_id,
                code=CancelCode(response.return_code).name,
            ),
        )

    def _on_response(self, goal_id: bytes, response: Any) -> None:  # noqa: ANN401
        told = {"action": self._name, "goal_id": goal_id.hex()}
        self._say("goal_response", **told, accepted=bool(response.accepted))
        if not response.accepted:
            return
        request = self._action.GetResult.Request(goal_id=goal_id_message(self._node.types, goal_id))
        self._get_result.call(
            request,
            lambda found: self._say(
                "result",
                **told,
                status=GoalStatus(found.status).name,
                result=to_dict(found.result),
            ),
        )

    def _hear_feedback(self, cdr: bytes) -> None:
        heard = codec_of(self._action.FeedbackMessage).decode(cdr)
        self._say(
            "feedback",
            action=self._name,
            goal_id=goal_id_of(heard.goal_id).hex(),
            feedback=to_dict(heard.feedback),
        )

    def _hear_status(self, cdr: bytes) -> None:
        for one in self._statuses.decode(cdr).status_list:
            self._say(
                "goal_status",
                action=self._name,
                goal_id=goal_id_of(one.goal_info.goal_id).hex(),
                status=GoalStatus(one.status).name,
            )
