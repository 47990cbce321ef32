"""RosConnection: the one connection with a ROS 2 system, opened when it is first used."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.debounce import Throttle
from studio.errors import CommandError, StudioError
from studio.live.connection.bridges import bridge_views
from studio.live.connection.nearby import Nearby
from studio.live.connection.plan import planned_wire
from studio.live.time.keeping import Keeping
from studio.live.time.past import LivePast
from studio.live.topics.zenoh_source import ZenohSource
from studio.protocol.connection import WireState
from studio.protocol.listeners import Audience, LastSent, send

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink
    from studio.protocol.listeners import Listener
    from studio.ros.qos import QoSProfile
    from studio.settings import WireChoice


_NODES_SHOWN: Final = 200
_PAUSE_S: Final = 0.25
"""Between two checks of the graph."""

_CLOSING: Final = "The studio is closing: nothing is connected any more."
_OPENING_PATIENCE_S: Final = 0.5
"""At the end, for a connection that is being made."""

_Phase: TypeAlias = Literal["off", "connecting", "failed"]


class RosConnection:
    """Holds the connection for all documents, and sends every page its state.

    Zenoh is imported with the first `link` only: users without ROS do not pay for it.

    Args:
        choice: How ROS 2 is joined.
        rewind_bytes: Memory for the last minutes of its topics; 0: they are not kept.
    """

    def __init__(self, choice: WireChoice, rewind_bytes: int = 0) -> None:
        self._choice = choice
        self._audience = Audience()
        self._link: WireLink | None = None
        self._opening: asyncio.Task[WireLink] | None = None
        self._phase: _Phase = "off"
        self._trouble = ""
        self._sent = LastSent[WireState](self._audience)
        self._throttle = Throttle(self._refresh, pause_s=_PAUSE_S)
        self._nearby = Nearby(lambda: self._choice, self._is_alone, self._send)
        self._closed = False
        self.topics = ZenohSource()
        """The topics of whatever system it is connected with."""
        self.past = LivePast(rewind_bytes, lambda: self.topics.types, self._offered)
        """The last minutes of them."""
        self._keeping = Keeping(self.past, self.topics)
        if rewind_bytes:
            self.topics.past = self.past
        self.on_link: Callable[[WireLink | None], None] = _nobody
        """Called with each connection that is made, and with None when one was ended on demand."""
        self.on_change: Callable[[], None] = _nothing
        """Called whenever the connection or the graph may have changed."""
        self._turn = asyncio.Lock()
        """A connection is made once the one before is ended: their router has one place."""

    def attach(self, listener: Listener) -> None:
        """Send a page the state, now and whenever it changes."""
        self._audience.add(listener)
        self._keeping.check(len(self._audience))
        send(listener, self._state())
        self._nearby.check()

    def detach(self, listener: Listener) -> None:
        """Forget a page; it need not be there."""
        self._audience.remove(listener)
        self._keeping.check(len(self._audience))

    @property
    def current(self) -> WireLink | None:
        """The connection, if there is one."""
        return self._link

    @property
    def choice(self) -> WireChoice:
        """The connection to make."""
        return self._choice

    def choose(self, choice: WireChoice) -> None:
        """Choose the router of the next connection."""
        self._choice = choice
        self._send()

    async def link(self) -> WireLink:
        """Return the connection; the first call opens it.

        Raises:
            StudioError: There is no router, and none may be started; or the settings are wrong.
        """
        if self._closed:
            raise CommandError(_CLOSING)
        if self._link is not None:
            return self._link
        if self._opening is None or self._opening.done():
            self._opening = asyncio.create_task(self._open())
        return await asyncio.shield(self._opening)

    async def disconnect(self) -> None:
        """End the connection, and the router if it is ours, until somebody asks for it again.

        Whoever uses it has let go of it before.
        """
        async with self._turn:
            link, self._link = self._link, None
            self._phase, self._trouble = "off", ""
            self.on_link(None)
            if link is not None:
                await asyncio.to_thread(self._end, link)
            self._send()

    async def close(self) -> None:
        """End the connection, and the router if it is ours."""
        self._closed = True
        await asyncio.gather(self._throttle.close(), self._nearby.close())
        if self._opening is not None:
            await asyncio.wait({self._opening}, timeout=_OPENING_PATIENCE_S)
        link, self._link = self._link, None
        await asyncio.to_thread(self._keeping.close)
        await asyncio.to_thread(self.topics.close)
        if link is not None:
            await asyncio.to_thread(link.close)

    def _end(self, link: WireLink) -> None:
        self.topics.detach()
        link.close()

    async def _open(self) -> WireLink:
        async with self._turn:
            return await self._open_in_turn()

    async def _open_in_turn(self) -> WireLink:
        self._phase, self._trouble = "connecting", ""
        self._send()
        try:
            link = await asyncio.to_thread(self._open_link, asyncio.get_running_loop())
        except Exception as error:
            trouble = str(error) if isinstance(error, StudioError) else "The terminal says why."
            self._phase, self._trouble = "failed", trouble
            self._send()
            raise
        if self._closed:
            await asyncio.to_thread(link.close)
            raise CommandError(_CLOSING)
        self._link = link
        self.topics.attach(link)
        self._keeping.check(len(self._audience))
        self.on_link(link)
        self._send()
        return link

    def _open_link(self, loop: asyncio.AbstractEventLoop) -> WireLink:
        from studio.live.connection.link import WireLink  # noqa: PLC0415 - imports zenoh

        def changed() -> None:
            self.topics.refit()
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._trigger)

        return WireLink(self._choice, changed)

    def _offered(self, topic: str) -> list[QoSProfile]:
        return [one.qos for one in self.topics.publishers(topic)]

    def _is_alone(self) -> bool:
        """Whether there is a page but no connection."""
        is_idle = self._link is None and self._phase != "connecting"
        return is_idle and not self._closed and len(self._audience) > 0

    def _trigger(self) -> None:
        if not self._closed:
            self._throttle.trigger()

    async def _refresh(self) -> None:
        link = self._link
        if link is not None:
            # With thousands of nodes this takes a while.
            seen = await asyncio.to_thread(_state_with, link)
            if link is self._link:  # else the state is of an earlier connection
                self._send(seen)

    def _send(self, seen: WireState | None = None) -> None:
        self._sent.send(seen or self._state())
        self.on_change()
        self._nearby.check()

    def _state(self) -> WireState:
        return self._state_without() if self._link is None else _state_with(self._link)

    def _state_without(self) -> WireState:
        """Return the state while there is no connection; the environment may be invalid."""
        trouble, endpoint, domain, distro = self._trouble, "", 0, ""
        try:
            planned = planned_wire(self._choice)
            endpoint, domain = ", ".join(planned.connect), planned.domain
            distro = planned.profile.distro
        except StudioError as error:
            trouble = str(error)
        return WireState(
            state=self._phase,
            router="",
            endpoint=endpoint,
            domain=domain,
            distro=distro,
            nodes=(),
            node_count=0,
            behind={},
            bridges=(),
            nearby_count=self._nearby.node_count,
            trouble=trouble,
        )


def _nothing() -> None:
    """Do nothing: the default of `on_change`."""


def _nobody(_link: WireLink | None) -> None:
    """Do nothing: the default of `on_link`."""


def _state_with(link: WireLink) -> WireState:
    """Return the state of a connection; thread-safe."""
    is_connected = link.is_connected
    nodes = link.other_nodes() if is_connected else []
    shown = nodes[:_NODES_SHOWN]
    return WireState(
        state="connected" if is_connected else "lost",
        router="own" if link.has_own_router else "joined",
        endpoint=link.endpoint,
        domain=link.domain,
        distro=link.distro,
        nodes=tuple(one.path for one in shown),
        node_count=len(nodes),
        behind={one.path: one.bridge for one in shown if one.bridge},
        bridges=bridge_views(link.graph.bridges) if is_connected else (),
        nearby_count=0,
        trouble="",
    )
