"""The states of all goals of an action, as its server publishes them."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.live.topics.request import Request
from studio.live.topics.source import decoder
from studio.protocol.commands import Commands, Scope
from studio.protocol.goals import GetGoalStatuses, GoalStatuses, GoalStatusView
from studio.ros.names import action_part

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.live.topics.source import TopicSource
    from studio.live.topics.subscription import Subscription
    from studio.ros.types.classes import MessageValue

_ASKED_FOR_S: Final = 10.0
"""So long an action stays subscribed after a request, unless a page follows its changes."""
_FOLLOWED_MAX: Final = 20
"""Limit of the actions subscribed: those that were asked for last."""
_SHOWN: Final = 50


_TYPE: Final = "action_msgs/msg/GoalStatusArray"


@dataclass
class _Statuses:
    """A subscription of an action's status topic, and its newest message."""

    subscription: Subscription
    asked_s: float
    epoch: int
    newest: MessageValue | None = None


class GoalStatusTopics:
    """Subscribes to the status of actions while they are asked for, or a page follows them.

    Args:
        source: The source of topics.
        own_ids: Returns the ids of our own goals.
        changed: Called when a status came, in a thread of the source.
        is_followed: Returns whether a page follows the changes.
    """

    def __init__(
        self,
        source: TopicSource,
        own_ids: Callable[[], frozenset[str]],
        changed: Callable[[], object] | None = None,
        is_followed: Callable[[], bool] = lambda: False,
    ) -> None:
        self._source, self._own_ids = source, own_ids
        self._changed, self._is_followed = changed, is_followed
        self._decode = decoder(source, _TYPE)
        self._of_actions: dict[str, _Statuses] = {}

    def statuses(self, command: GetGoalStatuses) -> GoalStatuses:
        """Return the goals' states; the first answer may come before the first status message.

        Raises:
            RosNameError: No action is named so.
        """
        views: tuple[GoalStatusView, ...] = ()
        if self._source.connection != "none":
            views = _views(self._newest(command.name), self._own_ids())
        return GoalStatuses(request=command.request, name=command.name, goals=views)

    def let_go(self) -> None:
        """End all subscriptions."""
        self._close(tuple(self._of_actions))

    def _newest(self, name: str) -> MessageValue | None:
        from studio.live.panels.requests import wire_name  # noqa: PLC0415 - imports zenoh

        now_s = time.monotonic()
        action = wire_name(name)
        self._forget(action, now_s)
        found = self._of_actions.get(action)
        if found is None:
            found = self._of_actions[action] = self._subscribe(action, now_s)
        if found.epoch != self._source.epoch:
            found.epoch, found.newest = self._source.epoch, None
        found.asked_s = now_s
        for sample in found.subscription.take():
            found.newest = self._decode(sample)
        return found.newest

    def _subscribe(self, action: str, now_s: float) -> _Statuses:
        request = Request(
            action_part(action, "status"),
            (_TYPE,),
            newest_only=True,
            depth=1,
            usually=(True, True),
            as_known_here=True,
        )
        made = self._source.subscribe(request, arrived=self._changed)
        return _Statuses(made, now_s, self._source.epoch)

    def _forget(self, action: str, now_s: float) -> None:
        """Unsubscribe actions that nobody waits for, except the one just asked for."""
        others = {name: one.asked_s for name, one in self._of_actions.items() if name != action}
        if self._is_followed():
            oldest_last = sorted(others, key=lambda name: -others[name])
            self._close(oldest_last[_FOLLOWED_MAX - 1 :])
        else:
            self._close([name for name in others if others[name] < now_s - _ASKED_FOR_S])

    def _close(self, actions: Iterable[str]) -> None:
        for name in actions:
            self._of_actions.pop(name).subscription.close()


def _views(newest: MessageValue | None, own: frozenset[str]) -> tuple[GoalStatusView, ...]:
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
