"""GoalRequest: one goal, from sending it to its result; clients of actions are shared.

It imports Zenoh (through `ros`), so it is imported when it is first used.
"""

from __future__ import annotations

import asyncio
import threading
import time
from typing import TYPE_CHECKING, Any, Final

from studio.errors import CallError, CommandError, NoAnswerError
from studio.live.panels.requests import (
    SERVER_PATIENCE_S,
    SHOWN_CHARACTERS,
    came_true,
    known_in_time,
    not_served,
    why_ended,
    wire_name,
)
from studio.ros.action.client import ActionClient
from studio.ros.action.protocol import GoalStatus
from studio.ros.names import full_type_name
from studio.ros.type_lookup import known_action
from studio.ros.types.convert import from_yaml, to_json

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink
    from studio.protocol.goals import SendGoal
    from studio.ros.action.client import ClientGoalHandle
    from studio.ros.types.library import ActionType

FOREVER_S: Final = 365 * 24 * 3600.0
_CANCEL_S: Final = 5.0
_REFUSALS: Final = {
    1: "its server does not let it end",
    2: "its server does not know it any more",
    3: "it has its end already",
}
"""By the return codes of action_msgs/srv/CancelGoal."""


class ActionClients:
    """Clients of actions, one for all running goals of an action; thread-safe."""

    def __init__(self, link: WireLink) -> None:
        self._link = link
        self._turn = threading.Lock()
        self._clients: dict[tuple[str, str], tuple[ActionClient, int]] = {}

    def take(self, kind: ActionType, name: str) -> ActionClient:
        """Return the client of an action, to be given back."""
        with self._turn:
            client, users = self._clients.get((name, kind.name), (None, 0))
            made = client or ActionClient(self._link.node, kind, name)
            self._clients[name, kind.name] = made, users + 1
            return made

    def give_back(self, client: ActionClient) -> None:
        """Need it no more; the last who does ends it."""
        key = client.action_name, client.action_type.name
        with self._turn:
            _, users = self._clients[key]
            self._clients[key] = client, users - 1
            if users == 1:
                del self._clients[key]
                client.destroy()


class GoalRequest:
    """A goal, ready to be sent; made and closed in a thread.

    Raises:
        StudioError: The action cannot be named so, its type is not known, or the values do not
            fit it.
    """

    def __init__(self, link: WireLink, clients: ActionClients, asked: SendGoal) -> None:
        self.name, self.type_name = (
            wire_name(asked.name),
            full_type_name(asked.action_type, "action"),
        )
        why: list[str] = []
        kind = known_action(link.node, self.name, self.type_name, why.append)
        self._link = link
        self._goal = from_yaml(kind.Goal, asked.text, now_ns=time.time_ns())
        self._clients, self._client = clients, clients.take(kind, self.name)
        self._handle: ClientGoalHandle | None = None

    @property
    def status(self) -> GoalStatus:
        """The status that the server reported last."""
        return GoalStatus.UNKNOWN if self._handle is None else self._handle.status

    @property
    def servers(self) -> tuple[str, ...]:
        """Paths of the nodes that serve the action."""
        return tuple(one.path for one in self._link.graph.action_servers(self.name))

    @property
    def goal_id(self) -> str:
        """The id in hex; empty before the goal is accepted."""
        return "" if self._handle is None else bytes(self._handle.goal_id.uuid).hex()

    async def accepted(self, timeout_s: float, on_feedback: Callable[[Any], None]) -> bool:
        """Send it, and return whether its server accepts it.

        Raises:
            NotServedError: Nobody serves the action.
            ServedOtherwiseError: Somebody does, with another type.
            RouterGoneError: The router ended meanwhile.
            NoAnswerError: The server does not answer in time.
        """
        is_ready = self._client.server_is_ready
        if not await came_true(is_ready, min(timeout_s, SERVER_PATIENCE_S)):
            types = dict(self._link.graph.actions()).get(self.name, ())
            raise not_served("action", self.name, self.type_name, types)
        sent = self._client.send_goal_async(
            self._goal, lambda message: on_feedback(message.feedback)
        )
        try:
            handle: ClientGoalHandle = await known_in_time(sent, timeout_s)
        except TimeoutError:
            raise NoAnswerError("action", self.name, timeout_s) from None
        except CallError as error:
            raise await why_ended(self._link, error) from None
        if handle.accepted:
            self._handle = handle
        return handle.accepted

    async def result(self) -> tuple[GoalStatus, str]:
        """Wait for its end, however long that takes; return its status and the result as JSON.

        Raises:
            ActionServerGoneError: The server ended before.
        """
        assert self._handle is not None
        answer = await known_in_time(self._handle.get_result_async(), FOREVER_S)
        written = await asyncio.to_thread(to_json, answer.result, SHOWN_CHARACTERS)
        return GoalStatus(answer.status), written

    async def cancel(self) -> None:
        """Ask the server to cancel it.

        Raises:
            CommandError: The server refuses.
            NoAnswerError: The server does not answer.
        """
        if self._handle is None:
            raise CommandError("It is not accepted yet: wait for its server.")
        try:
            answer = await known_in_time(self._handle.cancel_goal_async(), _CANCEL_S)
        except TimeoutError:
            raise NoAnswerError("action", self.name, _CANCEL_S) from None
        except CallError as error:
            raise await why_ended(self._link, error) from None
        if answer.return_code:
            why = _REFUSALS.get(answer.return_code, "its server says no")
            raise CommandError(f"The goal of {self.name} goes on: {why}.")

    def close(self) -> None:
        """Need its client no more."""
        self._clients.give_back(self._client)
