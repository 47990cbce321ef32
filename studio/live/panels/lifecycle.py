"""Managed nodes: their states, and transitions that they are asked for."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

from studio.errors import CommandError, StudioError, WireError
from studio.protocol.commands import Commands, Scope
from studio.protocol.graph import (
    MANAGED_MAX,
    ChangeState,
    GetManaged,
    ManagedNodes,
    ManagedNodeView,
    TransitionView,
)

if TYPE_CHECKING:
    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.ros.graph.graph import Graph
    from studio.ros.lifecycle.client import LifecycleClient

_SERVICE: Final = "/get_state"
_TYPE: Final = "lifecycle_msgs/srv/GetState"
_ANSWER_S: Final = 2.0
_CHANGE_S: Final = 30.0
"""A node may drive motors home before it answers."""
_KEPT_S: Final = 20.0
"""So long clients are kept after the last request: users ask every second."""
_AT_ONCE: Final = 8
_LEFT: Final = "Not connected to ROS 2: connect first."


class LifecycleNodes:
    """Asks managed nodes in threads, several at once, each with a time-out."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._clients: dict[str, LifecycleClient] = {}
        self._asking = asyncio.Lock()
        self._leaves = False
        self._ending: asyncio.TimerHandle | None = None
        self._end: asyncio.Task[None] | None = None

    async def managed(self, command: GetManaged) -> ManagedNodes:
        """Return the states of the managed nodes; a silent one has the reason instead."""
        link = self._wire.current
        if link is None:
            return ManagedNodes(request=command.request, nodes=(), more=0)
        names = await asyncio.to_thread(_managed_names, link.graph)
        asked = names[:MANAGED_MAX]
        async with self._asking:
            await self._close_clients(set(self._clients) - set(asked))
            few = asyncio.Semaphore(_AT_ONCE)
            nodes = await asyncio.gather(*(self._view(few, link, name) for name in asked))
        self._stay()
        return ManagedNodes(
            request=command.request, nodes=tuple(nodes), more=len(names[len(asked) :])
        )

    async def change(self, command: ChangeState) -> None:
        """Trigger a transition of a node, and return when it was made.

        Raises:
            CommandError: There is no connection, or the node did not get where it should.
            NotServedError: It is no managed node.
            NoAnswerError: It gives no answer.
        """
        link = self._wire.current
        if link is None:
            raise CommandError(_LEFT)
        await asyncio.to_thread(_change, link, command)

    async def let_go(self) -> None:
        """Take all clients back."""
        if self._ending is not None:
            self._ending.cancel()
        # With many silent nodes, those not asked yet are not waited for.
        self._leaves = True
        async with self._asking:
            await self._close_clients(set(self._clients))
            self._leaves = False

    async def _view(self, few: asyncio.Semaphore, link: WireLink, name: str) -> ManagedNodeView:
        async with few:
            try:
                if self._leaves:
                    raise CommandError(_LEFT)
                client = self._clients.get(name)
                if client is None:
                    client = self._clients[name] = await asyncio.to_thread(_client, link, name)
                return await asyncio.to_thread(_asked, client, name)
            except StudioError as error:
                return ManagedNodeView(
                    name=name, state_id=0, state="", transitions=(), trouble=str(error)
                )

    async def _close_clients(self, names: set[str]) -> None:
        for name in names:
            with suppress(StudioError):  # the connection has ended with them
                await asyncio.to_thread(self._clients.pop(name).close)

    def _stay(self) -> None:
        """Keep the clients for the next question, and not for ever."""
        if self._ending is not None:
            self._ending.cancel()
        self._ending = asyncio.get_running_loop().call_later(_KEPT_S, self._forget)

    def _forget(self) -> None:
        self._end = asyncio.create_task(self.let_go())


def _managed_names(graph: Graph) -> list[str]:
    return [
        name.removesuffix(_SERVICE)
        for name, types in graph.services()
        if name.endswith(_SERVICE) and _TYPE in types
    ]


def _client(link: WireLink, name: str, timeout_s: float = _ANSWER_S) -> LifecycleClient:
    from studio.ros.lifecycle.client import LifecycleClient  # noqa: PLC0415 - imports zenoh

    return LifecycleClient(link.node, name, timeout_s)


def _asked(client: LifecycleClient, name: str) -> ManagedNodeView:
    state = client.state()
    return ManagedNodeView(
        name=name,
        state_id=state.id,
        state=state.label,
        transitions=tuple(map(_transition, client.available_transitions())),
        trouble="",
    )


def _transition(described: Any) -> TransitionView:  # noqa: ANN401  # a TransitionDescription
    return TransitionView(
        id=described.transition.id,
        label=described.transition.label,
        goal=described.goal_state.label,
    )


def _change(link: WireLink, command: ChangeState) -> None:
    with _client(link, command.node, _CHANGE_S) as client:
        succeeded = client.change(command.transition)
        if succeeded:
            return
        try:
            now = client.state().label
        except WireError:
            now = "an unknown state"
    raise CommandError(
        f"{command.node} did not take that transition and is in {now}: its log says why."
    )


COMMANDS: Final = Commands[LifecycleNodes](Scope.ROS)
COMMANDS.viewer(GetManaged, lambda one, c, _: one.managed(c))
COMMANDS.controller(ChangeState, lambda one, c, _: one.change(c), needs_router=True)
