"""The connections of each person and their limits: few and brief for strangers, more for viewers.

A connection is a stranger's until the guard has recognised a cookie or a token on it. The presenter
always has room: strangers and viewers have a share of the descriptors each, the rest is kept back.
"""

from __future__ import annotations

import logging
import sys
import time
from typing import TYPE_CHECKING, Final, Protocol

from uvicorn.server import ServerState

from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.protocol.roles import Person

STRANGER_S: Final = 10.0
"""From the connection to a whole request that carries a cookie or a token."""
VIEWER_CONNECTIONS_MAX: Final = 64
"""For one viewer: a browser holds three websockets per tab, and six requests at a time."""
_STRANGERS_MAX: Final = 512
"""So many may open the form to join at once."""
_DESCRIPTORS_WITHOUT_LIMIT: Final = 4096
_LOG_EVERY_S: Final = 60.0
_log = logging.getLogger(__name__)


class Connection(Protocol):
    """An HTTP connection or a websocket."""

    def abort(self) -> None:
        """End it at once."""
        ...


class Allowance:
    """Rate limit of a person: units per second, and how many at once after a rest.

    A unit is one websocket frame, or one KiB of it. A faster sender is read later, not refused.
    """

    def __init__(self, units_per_s: float, at_once: float) -> None:
        self._units_per_s, self._at_once = units_per_s, at_once
        self._left, self._counted_s = at_once, 0.0

    def spend(self, units: float, now_s: float) -> float:
        """Take units off; answers for how many seconds nothing more may be read."""
        earned = (now_s - self._counted_s) * self._units_per_s
        self._left = min(self._at_once, self._left + earned) - units
        self._counted_s = now_s
        return max(0.0, -self._left / self._units_per_s)


class Account:
    """One browser, or one script: all connections with the same cookie or token."""

    def __init__(self, role: Role) -> None:
        self.connections = 0
        presents = role is Role.PRESENTER
        self._own = Allowance(4_000, 8_000) if presents else Allowance(500, 1_000)

    def spend(self, units: float, now_s: float) -> float:
        """Take units off its own allowance."""
        return self._own.spend(units, now_s)


class Crowd:
    """All connections of one server; used on the loop's thread only."""

    def __init__(self, descriptors: int | None = None) -> None:
        limit = descriptors or descriptor_limit()
        self.strangers_max = min(_STRANGERS_MAX, limit // 8)
        self.viewers_max = limit * 5 // 8
        self._strangers: dict[Connection, None] = {}
        self._known: dict[Connection, Person] = {}
        self._people: dict[Person, Account] = {}
        self._viewer_connections = 0
        self._viewers = Allowance(10_000, 4_000)
        self.sent_bytes = 0
        """Of frames that were written to websockets."""
        self._refused, self._logged_s = 0, -_LOG_EVERY_S

    def arrive(self, connection: Connection) -> None:
        """Hold a stranger's connection; when there are too many, close the oldest."""
        self._strangers[connection] = None
        if len(self._strangers) > self.strangers_max:
            oldest = next(iter(self._strangers))
            del self._strangers[oldest]
            oldest.abort()
            self.refuse("too many connections without a request")

    def recognise(self, connection: Connection, visitor: Person) -> bool:
        """Assign a connection to a person; False when they have too many."""
        if self._known.get(connection) == visitor:
            return True
        self.leave(connection)
        person = self._people.get(visitor) or Account(visitor.role)
        if visitor.role is not Role.PRESENTER:
            if person.connections >= VIEWER_CONNECTIONS_MAX:
                return False
            if self._viewer_connections >= self.viewers_max:
                return False
            self._viewer_connections += 1
        person.connections += 1
        self._people[visitor] = person
        self._known[connection] = visitor
        return True

    def leave(self, connection: Connection) -> None:
        """Forget a connection that ended or was replaced."""
        self._strangers.pop(connection, None)
        visitor = self._known.pop(connection, None)
        if visitor is None:
            return
        person = self._people[visitor]
        person.connections -= 1
        if not person.connections:
            del self._people[visitor]
        if visitor.role is not Role.PRESENTER:
            self._viewer_connections -= 1

    def spend(self, connection: Connection, units: float) -> float:
        """Count what came; answers for how many seconds nothing more may be read from it."""
        visitor = self._known.get(connection)
        if visitor is None:
            return 0.0
        now_s = time.monotonic()
        pause_s = self._people[visitor].spend(units, now_s)
        if visitor.role is Role.PRESENTER:
            return pause_s
        return max(pause_s, self._viewers.spend(units, now_s))

    def end_person(self, person: str) -> None:
        """End the connections of one person."""
        self.end(lambda visitor: visitor.person == person)

    def end(self, are_meant: Callable[[Person], bool]) -> None:
        """End the connections of some people."""
        for connection, visitor in tuple(self._known.items()):
            if are_meant(visitor):
                connection.abort()

    def end_all(self) -> None:
        """End the connections of all who were recognised: their cookies are no longer valid."""
        for connection in tuple(self._known):
            connection.abort()

    def refuse(self, why: str) -> None:
        """Note that a stranger was refused: a line a minute at most, however many there are."""
        self._refused += 1
        now_s = time.monotonic()
        if now_s - self._logged_s < _LOG_EVERY_S:
            return
        count, self._refused, self._logged_s = self._refused, 0, now_s
        before = f" ({count - 1} others since the last such line)" if count > 1 else ""
        _log.warning("A connection without a key was refused: %s%s.", why, before)


class CrowdedState(ServerState):
    """State that the connections of one server share."""

    def __init__(self) -> None:
        super().__init__()
        self.crowd = Crowd()


def descriptor_limit() -> int:
    """Return how many files and sockets this process may hold open."""
    if sys.platform == "win32":
        return _DESCRIPTORS_WITHOUT_LIMIT
    import resource  # noqa: PLC0415 - Unix only

    limit, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    unlimited = limit == resource.RLIM_INFINITY
    return _DESCRIPTORS_WITHOUT_LIMIT if unlimited else limit
