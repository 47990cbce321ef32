"""Context: what the nodes of a process share: the session, the drain, and whether to go on."""

from __future__ import annotations

import contextlib
import threading
from typing import TYPE_CHECKING

from studio.errors import AlreadyJoinedError, NotJoinedError
from studio.ros.graph.graph import Graph
from studio.ros.messages import shared_types, types_of
from studio.ros.node.arguments import RosArguments, parse_arguments
from studio.ros.node.drain import Drain, Source
from studio.ros.wire.session import open_wire
from studio.ros.wire.settings import wire_settings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.ros.node.arguments import NodeArguments
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.settings import WireSettings


class Context:
    """Opened by `init`, or made `over` an open session; `shutdown` ends it.

    `ok` turns false at once when a signal asks the process to end, while the session stays open
    until `shutdown`, so that a node can still publish.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._wire: WireSession | None = None
        self._drain: Drain | None = None
        self._graph: Graph | None = None
        self._owns_wire = True
        self.arguments = RosArguments()
        self._ok = self._was_ended = False
        self._closed = threading.Event()
        self._ending: list[Callable[[], None]] = []
        self._closing: list[Callable[[], None]] = []

    @classmethod
    def over(cls, wire: WireSession, *, owns_wire: bool = False) -> Context:
        """Make a joined one over an open session, which `shutdown` closes if it owns it."""
        context = cls()
        context._join(wire, owns_wire=owns_wire)
        return context

    def init(self, settings: WireSettings | None = None, router: str = "auto") -> None:
        """Join the wire.

        Args:
            settings: Which router and domain; those of the environment without.
            router: `auto` starts a router where none answers, `off` starts none.

        Raises:
            AlreadyJoinedError: It is joined.
            WireError: The router cannot be joined, or none may be started.
        """
        with self._lock:
            if self._wire is not None:
                raise AlreadyJoinedError
            given = settings or wire_settings()
            types = shared_types() if settings is None else types_of(given.profile.distro)
            self._join(open_wire(given, router, types), owns_wire=True)

    @property
    def wire(self) -> WireSession:
        """The session that all share.

        Raises:
            NotJoinedError: It is not joined.
        """
        if self._wire is None:
            raise NotJoinedError
        return self._wire

    @property
    def is_joined(self) -> bool:
        """Whether there is a session, even if it was asked to end."""
        return self._wire is not None

    @property
    def drain(self) -> Drain:
        """The thread that takes in what comes.

        Raises:
            NotJoinedError: It is not joined.
        """
        if self._drain is None:
            raise NotJoinedError
        return self._drain

    @property
    def graph(self) -> Graph:
        """The graph, which is watched from the first time that somebody asks for it.

        Raises:
            NotJoinedError: It is not joined.
        """
        with self._lock:
            if self._graph is None:
                self._graph = Graph(self.wire)
            return self._graph

    def forget_source(self, source: Source) -> None:
        """Take in no more of what comes to a source; harmless after the end."""
        drain = self._drain
        if drain is not None:
            drain.remove(source)

    def arguments_of(
        self, node_name: str, arguments: Sequence[str] | None, *, use_global: bool
    ) -> NodeArguments:
        """Return the arguments of a node: its own, then those of the process.

        Raises:
            RosArgumentError: One of them is no argument of ROS.
        """
        own = parse_arguments(arguments or ())
        if not use_global:
            return own.of_node(node_name)
        return own.before(self.arguments).of_node(node_name)

    def ok(self) -> bool:
        """Whether it is joined and was not asked to end."""
        return self._ok

    def on_end(self, callback: Callable[[], None]) -> None:
        """Call back once when it is asked to end, at once if it was; the callback must not wait."""
        with self._lock:
            if self._ok:
                self._ending.append(callback)
                return
        callback()

    def forget_end(self, callback: Callable[[], None]) -> None:
        """Do not call back; harmless when it was not to be, or was already."""
        with contextlib.suppress(ValueError):
            self._ending.remove(callback)

    def on_close(self, callback: Callable[[], None]) -> None:
        """Call back once before the session is closed."""
        with self._lock:
            self._closing.append(callback)

    def forget_close(self, callback: Callable[[], None]) -> None:
        """Do not call back; harmless when it was not to be."""
        with self._lock:
            if callback in self._closing:
                self._closing.remove(callback)

    def end(self) -> None:
        """End all spinning; the session stays open. Safe in a handler of signals."""
        self._was_ended = True
        self._ok = False
        while self._ending:
            with contextlib.suppress(IndexError):
                self._ending.pop()()

    def shutdown(self) -> None:
        """End, and close the session; again is harmless."""
        self.end()
        with self._lock:
            closing, self._closing = self._closing, []
            drain, self._drain = self._drain, None
        for callback in closing:
            callback()
        if drain is not None:
            # What takes in data may ask who is there: it stops before the session is given up.
            drain.stop()
            self._leave()
        self._was_ended = False
        self._closed.set()

    def wait_closed(self, timeout_s: float) -> bool:
        """Wait until it is shut down, or that long; whether it is."""
        return self._closed.wait(timeout_s)

    def _leave(self) -> None:
        with self._lock:
            wire, self._wire = self._wire, None
            graph, self._graph = self._graph, None
        if graph is not None:
            graph.close()
        if wire is not None and self._owns_wire:
            wire.close()

    def _join(self, wire: WireSession, *, owns_wire: bool) -> None:
        self._wire, self._owns_wire = wire, owns_wire
        self._drain = Drain()
        self._closed.clear()
        self._ok = not self._was_ended


_default = Context()


def default_context() -> Context:
    """Return the context of what is given none."""
    return _default
