"""ParameterChanges: which parameters of nodes have other values than they were declared with."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from studio.errors import StudioError
from studio.live.doctor.seen import ChangedParameter, HeardParameters, short

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.types.library import TypeLibrary

EVENT_TYPE: Final = "rcl_interfaces/msg/ParameterEvent"
_WAITING_BYTES_MAX: Final = 1_000_000
"""So many bytes of events wait to be read; more are left out."""
_VALUE_LETTERS_MAX: Final = 80
_NAMES_OF_NODE_MAX: Final = 1_000
_NAMES_MAX: Final = 5_000
"""Of all nodes; beyond that, those that spoke first are forgotten."""
_TOLD_MAX: Final = 200


@dataclass(slots=True)
class _Node:
    """One life of a node; another publisher of its events is another life."""

    gid: bytes
    started: dict[str, str] = field(default_factory=dict[str, str])
    """Values with which parameters were declared."""
    now: dict[str, str] = field(default_factory=dict[str, str])
    """Values of those that were changed later."""

    def size(self) -> int:
        return len(self.started) + len(self.now)


class ParameterChanges:
    """Keeps the newest values of parameters, and those that they began with where that was heard.

    Events are kept as they come and read when somebody asks, or `read` is called: to read a large
    one takes its time. Thread-safe.

    Args:
        types: Returns the message types that are known.
        since: From when on it listens, as the end of "since ...".
        clock: Seconds that never go back.
    """

    def __init__(
        self,
        types: Callable[[], TypeLibrary],
        since: str,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._types, self._since, self._clock = types, since, clock
        self._lock, self._reading = threading.Lock(), threading.Lock()
        self._nodes: dict[str, _Node] = {}
        self._waiting: list[tuple[bytes, bytes]] = []
        self._waiting_bytes = 0
        self._is_elsewhere = False
        self._began_s = clock()

    def take(self, payload: bytes, gid: bytes) -> None:
        """Keep an event of the publisher with this GID, to be read later."""
        with self._lock:
            size = len(payload) + len(gid)  # an empty one takes room, too
            if self._waiting_bytes + size <= _WAITING_BYTES_MAX:
                self._waiting.append((payload, gid))
                self._waiting_bytes += size

    def read(self) -> None:
        """Read what came; in a thread, for it may take its time."""
        with self._reading:
            with self._lock:
                waiting, self._waiting, self._waiting_bytes = self._waiting, [], 0
                if self._is_elsewhere:
                    self._nodes, self._is_elsewhere = {}, False
            for payload, gid in waiting:
                self._read(payload, gid)
            self._forget_the_first()

    def heard(self) -> HeardParameters:
        """Read what came, and return all that have another value than before."""
        self.read()
        with self._reading:
            changed = [
                ChangedParameter(node, name, value, one.started.get(name), one.gid)
                for node, one in self._nodes.items()
                for name, value in one.now.items()
                if value != one.started.get(name)
            ]
        return HeardParameters(
            tuple(changed[-_TOLD_MAX:]), self._clock() - self._began_s, self._since
        )

    def forget(self) -> None:
        """Know nothing: another system is listened to."""
        with self._lock:
            self._waiting, self._waiting_bytes, self._is_elsewhere = [], 0, True
            self._began_s = self._clock()

    def _read(self, payload: bytes, gid: bytes) -> None:
        from studio.ros.cdr import codec_of  # noqa: PLC0415 - takes its time

        try:
            event = codec_of(self._types().message(EVENT_TYPE)).decode(payload)
        except StudioError:
            return
        node = self._node(short(event.node), gid)
        for one in event.new_parameters:
            _put(node, node.started, one)
            node.now.pop(short(one.name), None)
        for one in event.changed_parameters:
            _put(node, node.now, one)
        for one in event.deleted_parameters:
            node.started.pop(short(one.name), None)
            node.now.pop(short(one.name), None)

    def _node(self, path: str, gid: bytes) -> _Node:
        """Return the node, the last of all then; what it was in an earlier life is gone."""
        found = self._nodes.pop(path, None)
        node = found if found is not None and found.gid == gid else _Node(gid)
        self._nodes[path] = node
        return node

    def _forget_the_first(self) -> None:
        # A node counts as a name, too, for its last parameter may be gone.
        size = sum(1 + one.size() for one in self._nodes.values())
        while size > _NAMES_MAX and len(self._nodes) > 1:
            size -= 1 + self._nodes.pop(next(iter(self._nodes))).size()


def _put(node: _Node, values: dict[str, str], parameter: Any) -> None:  # noqa: ANN401 - a message
    from studio.ros.parameters.parameter import value_of  # noqa: PLC0415 - takes its time

    name = short(parameter.name)
    try:
        value = str(value_of(name, parameter.value)[1])
    except StudioError:
        value = "?"
    if name in values or node.size() < _NAMES_OF_NODE_MAX:
        values[name] = short(value, _VALUE_LETTERS_MAX)
