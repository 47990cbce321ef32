"""Parameters of nodes: read and set from pages, which get events of their changes."""

from __future__ import annotations

import asyncio
import contextlib
from collections import OrderedDict
from typing import TYPE_CHECKING, Final, Protocol

from studio.debounce import Throttle
from studio.live.topics.request import Request
from studio.live.topics.source import decoder
from studio.protocol.commands import Commands, Scope
from studio.protocol.listeners import send
from studio.protocol.parameters import (
    DumpParameters,
    FollowParameters,
    GetParameterNodes,
    GetParameters,
    LoadParameters,
    ParameterDump,
    ParameterNodes,
    Parameters,
    ParametersChanged,
    ParametersLoaded,
    ParameterView,
    SetParameter,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.live.panels.parameter_work import RemoteParameters
    from studio.live.topics.subscription import Subscription
    from studio.protocol.listeners import Listener
    from studio.ros.node.samples import RawSample
    from studio.ros.types.classes import MessageValue

_LIST: Final = "/list_parameters"
_LIST_TYPE: Final = "rcl_interfaces/srv/ListParameters"
_REMOTES_KEPT: Final = 16
_EVENT_TYPE: Final = "rcl_interfaces/msg/ParameterEvent"
_EVENTS: Final = Request("/parameter_events", (_EVENT_TYPE,), depth=1_000, as_known_here=True)
_SUBSCRIBED_WITHIN_S: Final = 2.0
_PAUSE_S: Final = 0.1
_CHANGES_MAX: Final = 2_000
"""Changes of one node in one event."""


class AnswersParameters(Protocol):
    """Parameters that are read and not set."""

    async def nodes(self, command: GetParameterNodes, /) -> ParameterNodes:
        """Return the nodes that have parameters."""
        ...

    async def parameters(self, command: GetParameters, /) -> Parameters:
        """Return all parameters of a node; raises a StudioError."""
        ...


class NodeParameters:
    """Keeps clients of the nodes asked last, and one subscription of all parameter events."""

    def __init__(self, wire: RosConnection) -> None:
        self._wire = wire
        self._remotes: OrderedDict[tuple[int, str], RemoteParameters] = OrderedDict()
        self._turn = asyncio.Lock()
        self._followed: dict[Listener, str] = {}
        self._events: Subscription | None = None
        self._subscribed = asyncio.Event()
        self._changes: dict[str, dict[str, ParameterView | None]] = {}
        self._throttle = Throttle(self._send, pause_s=_PAUSE_S)
        self.recorded_for: Callable[[str], AnswersParameters | None] = lambda _: None
        """Gives those of the recording that a document shows; None: it shows none."""

    async def nodes(self, command: GetParameterNodes) -> ParameterNodes:
        """Return the nodes that have parameters."""
        if (recorded := self.recorded_for(command.document)) is not None:
            return await recorded.nodes(command)
        link = self._wire.current
        found = await asyncio.to_thread(_nodes, link) if link is not None else ()
        return ParameterNodes(request=command.request, nodes=found)

    async def parameters(self, command: GetParameters) -> Parameters:
        """Return all parameters of a node.

        Raises:
            StudioError: The node does not answer.
        """
        if (recorded := self.recorded_for(command.document)) is not None:
            return await recorded.parameters(command)
        remote = await self._remote(command.node)
        views = await remote.views()
        return Parameters(request=command.request, node=remote.node, parameters=views)

    async def set(self, command: SetParameter) -> None:
        """Set a parameter of a node.

        Raises:
            StudioError: It was not set; the sentence says why.
        """
        remote = await self._remote(command.node)
        await remote.set(command.name, command.text, command.value_type)

    async def dump(self, command: DumpParameters) -> ParameterDump:
        """Write all of a node down; errors as for `parameters`."""
        remote = await self._remote(command.node)
        text = await remote.dump()
        return ParameterDump(request=command.request, node=remote.node, text=text)

    async def load(self, command: LoadParameters) -> ParametersLoaded:
        """Set the parameters that a file has for a node.

        Raises:
            StudioError: The file is not valid or has nothing for the node, or the node is silent.
        """
        remote = await self._remote(command.node)
        count, refused = await remote.load(command.text)
        return ParametersLoaded(
            request=command.request, node=remote.node, count=count, refused=refused
        )

    async def follow(self, command: FollowParameters, listener: Listener) -> None:
        """Send a page the changes of a node's parameters; of one node at a time.

        Where a ROS system is connected, changes are received once this is done.
        """
        if command.node:
            self._followed[listener] = f"/{command.node.removeprefix('/')}"
        else:
            self._followed.pop(listener, None)
        self._follow_events()
        if command.node and self._wire.topics.connection == "there":
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(_SUBSCRIBED_WITHIN_S):
                    await self._subscribed.wait()

    def detach(self, listener: Listener) -> None:
        """A page is gone."""
        self._followed.pop(listener, None)
        self._follow_events()

    async def let_go(self) -> None:
        """Need the connection no more."""
        async with self._turn:
            remotes, self._remotes = tuple(self._remotes.values()), OrderedDict()
            await asyncio.to_thread(_close, remotes)

    async def close(self) -> None:
        """End all."""
        self._followed.clear()
        self._follow_events()
        await self.let_go()
        await self._throttle.close()

    async def _remote(self, node: str) -> RemoteParameters:
        from studio.live.panels.parameter_work import RemoteParameters  # noqa: PLC0415 - zenoh

        link = await self._wire.link()
        async with self._turn:
            key = id(link), node
            found = self._remotes.pop(key, None)
            remote = found or await asyncio.to_thread(RemoteParameters, link, node)
            self._remotes[key] = remote
            if len(self._remotes) > _REMOTES_KEPT:
                _, oldest = self._remotes.popitem(last=False)
                await asyncio.to_thread(oldest.close)
            return remote

    def _follow_events(self) -> None:
        """Subscribe to changes while somebody follows a node."""
        if self._followed and self._events is None:
            loop, decode = asyncio.get_running_loop(), decoder(self._wire.topics, _EVENT_TYPE)

            def take(sample: RawSample) -> None:  # in a thread of the source
                event = decode(sample)
                if not loop.is_closed():
                    loop.call_soon_threadsafe(self._take, event)

            def changed() -> None:  # in a thread of the source
                if not loop.is_closed():
                    loop.call_soon_threadsafe(self._note_subscribed)

            self._events = self._wire.topics.subscribe(_EVENTS, take=take, changed=changed)
        elif not self._followed and self._events is not None:
            self._events.close()
            self._events = None
            self._subscribed.clear()

    def _note_subscribed(self) -> None:
        if self._events is not None and self._events.state.fit is not None:
            self._subscribed.set()

    def _take(self, event: MessageValue) -> None:
        from studio.live.panels.parameter_work import changed_view  # noqa: PLC0415 - zenoh

        node = str(event.node)
        if node not in self._followed.values():
            return
        changes = self._changes.setdefault(node, {})
        for one in (*event.new_parameters, *event.changed_parameters):
            changes[str(one.name)] = changed_view(one)
        changes.update(dict.fromkeys(str(one.name) for one in event.deleted_parameters))
        while len(changes) > _CHANGES_MAX:
            del changes[next(iter(changes))]
        self._throttle.trigger()

    async def _send(self) -> None:
        changes, self._changes = self._changes, {}
        for node, found in changes.items():
            event = ParametersChanged(
                node=node,
                parameters=tuple(one for one in found.values() if one is not None),
                gone=tuple(name for name, one in found.items() if one is None),
            )
            for listener, followed in tuple(self._followed.items()):
                if followed == node:
                    send(listener, event)


def _nodes(link: WireLink) -> tuple[str, ...]:
    return tuple(
        name.removesuffix(_LIST)
        for name, types in link.graph.services()
        if name.endswith(_LIST) and _LIST_TYPE in types
    )


def _close(remotes: tuple[RemoteParameters, ...]) -> None:
    for one in remotes:
        one.close()


COMMANDS: Final = Commands[NodeParameters](Scope.ROS)
COMMANDS.viewer(GetParameterNodes, lambda one, c, _: one.nodes(c))
COMMANDS.viewer(GetParameters, lambda one, c, _: one.parameters(c), needs_router=True)
COMMANDS.controller(SetParameter, lambda one, c, _: one.set(c), needs_router=True)
COMMANDS.viewer(DumpParameters, lambda one, c, _: one.dump(c), needs_router=True)
COMMANDS.controller(LoadParameters, lambda one, c, _: one.load(c), needs_router=True)
COMMANDS.viewer(FollowParameters, lambda one, c, who: one.follow(c, who))
