"""The states of all goals of an action, as its server publishes them."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from studio.protocol.commands import Commands, Scope
from studio.protocol.goals import GetGoalStatuses, GoalStatuses, GoalStatusView

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.desk import WireDesk
    from studio.live.connection.link import WireLink
    from studio.ros.types.classes import MessageValue

_ASKED_FOR_S: Final = 10.0
"""How long an action is subscribed after it was asked for: a panel asks again and again."""
_SHOWN: Final = 50


@dataclass
class _StatusSubscription:
    """A subscription of an action's status topic, and its newest message."""

    end: Callable[[], None]
    asked_s: float
    newest: Any = None
    """A GoalStatusArray; written by the thread of the link."""


class GoalStatusTopics:
    """Subscribes to the status of actions while somebody asks; `own_ids` are our own goals."""

    def __init__(self, wire: WireDesk, own_ids: Callable[[], frozenset[str]]) -> None:
        self._wire, self._own_ids = wire, own_ids
        self._subscriptions: dict[str, _StatusSubscription] = {}
        self._turn = asyncio.Lock()

    async def statuses(self, command: GetGoalStatuses) -> GoalStatuses:
        """Return the goals' states; the first answer may come before the first status message.

        Raises:
            RosNameError: No action is named so.
        """
        link = self._wire.current
        views: tuple[GoalStatusView, ...] = ()
        if link is not None:
            async with self._turn:
                newest = await asyncio.to_thread(self._newest, link, command.name)
            views = _views(newest, self._own_ids())
        return GoalStatuses(request=command.request, name=command.name, goals=views)

    async def let_go(self) -> None:
        """End all subscriptions."""
        async with self._turn:
            await asyncio.to_thread(self._forget, float("inf"))

    def _newest(self, link: WireLink, name: str) -> MessageValue | None:
        from studio.live.panels.requests import wire_name  # noqa: PLC0415 - imports zenoh
        from studio.ros.qos import qos_profile_action_status_default  # noqa: PLC0415

        now_s = time.monotonic()
        self._forget(now_s - _ASKED_FOR_S)
        action = wire_name(name)
        found = self._subscriptions.get(action)
        if found is None:
            found = self._subscriptions[action] = _StatusSubscription(lambda: None, now_s)
            found.end = link.subscribe(
                "action_msgs/msg/GoalStatusArray",
                f"{action}/_action/status",
                lambda message, found=found: setattr(found, "newest", message),
                qos_profile_action_status_default,
            )
        found.asked_s = now_s
        return found.newest

    def _forget(self, before_s: float) -> None:
        for name, found in tuple(self._subscriptions.items()):
            if found.asked_s < before_s:
                del self._subscriptions[name]
                found.end()


def _views(newest: Any, own: frozenset[str]) -> tuple[GoalStatusView, ...]:  # noqa: ANN401 - see _StatusSubscription
    if newest is None:
        return ()
    from studio.ros.action.protocol import GoalStatus  # noqa: PLC0415 - takes its time

    found = [
        GoalStatusView(
            goal_id=(goal_id := bytes(one.goal_info.goal_id.uuid).hex()),
            state=GoalStatus(one.status).name.lower(),
            stamp_s=one.goal_info.stamp.sec + one.goal_info.stamp.nanosec / 1e9,
            is_ours=goal_id in own,
        )
        for one in newest.status_list
    ]
    return tuple(sorted(found, key=lambda one: -one.stamp_s)[:_SHOWN])


COMMANDS: Final = Commands[GoalStatusTopics](Scope.ROS)
COMMANDS.viewer(GetGoalStatuses, lambda one, c, _: one.statuses(c))
