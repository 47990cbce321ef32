"""Bridges: the bridges to DDS that a session meets, followed while the session is open."""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Any, Final, Literal

from studio.errors import TokenError
from studio.ros.condition import Condition
from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.admin import Bounds, admin_key, read_answers
from studio.ros.wire.bridges.announcements import Announcements
from studio.ros.wire.bridges.bridge import (
    Bridge,
    BridgedEnd,
    Met,
    Sender,
    bridges_of,
    sender_gid,
    senders_of,
)
from studio.ros.wire.bridges.dialect import BRIDGES, TOKENS, Route, parse_bridge_token
from studio.ros.wire.zenoh import (
    ReadingThread,
    Sample,
    all_admin_answers,
    live_tokens,
    token_change,
    wait_for_thread,
    watch_tokens,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.wire.bridges.side import BridgeSide
    from studio.ros.wire.zenoh import Session

BRIDGES_MAX: Final = 64
ROUTES_MAX: Final = 100_000
"""Of all sessions; of those beyond none is known."""
ANSWER_TIMEOUT_S: Final = 3.0
_OTHERS_MAX: Final = 1_000
_SENDERS_MAX: Final = 100_000
_SETTLE_S: Final = 0.15
"""A robot that starts announces its ends one by one."""
_ASK_EVERY_S: Final = 5.0
"""Nodes that join or leave a topic which others have change no token."""
_SWEEP_EVERY_S: Final = 1.0
"""While tokens stand that nobody needs."""
_REST: Final = 5
"""So many times the processor that the last answers took is waited before the next question."""
_LATE_S: Final = 1.0

_log = logging.getLogger(__name__)


class Bridges:
    """Follows bridges: their tokens as they come, and what they tell when asked.

    While one of the session's domain is there, ends of the session have a side for it. Bridges of
    other domains are shown and not used, as nodes of other domains are.
    """

    def __init__(self, zenoh: Session, domain: int) -> None:
        self._zenoh, self._domain = zenoh, domain
        self.zid = str(zenoh.info.zid())
        self._changed = Condition()
        self._met: dict[str, Met] = {}
        self._others: dict[str, None] = {}
        """More than can be met, in their order: one is met when another goes."""
        self._dirty: set[str] = set()
        """Bridges of which something changed since they were asked."""
        self._routes: dict[str, dict[str, Route]] = {}
        """By session and token; a bridge's may come before it shows that it is one."""
        self._route_count = 0
        self._is_stale = False
        """Whether one went since `current` was made."""
        self._rests_until_s = 0.0
        self._has_failed = False
        self._current: tuple[Bridge, ...] = ()
        self._senders: dict[tuple[str, str], Sender | None] = {}
        self._unused: frozenset[str] = frozenset()
        self._brought: dict[str, BridgedEnd] = {}
        """A publisher of each topic that a bridge brings."""
        self._listeners: tuple[Callable[[], None], ...] = ()
        self.malformed = 0
        """How many tokens were none of a bridge."""
        self.last_malformed = ""
        self._turn = threading.RLock()
        """Held while sides are begun and ended."""
        self._sides: dict[str, dict[BridgeSide[Any], None]] = {}
        """By topic."""
        self.is_used = False
        """Whether a bridge of the session's domain is there."""
        self.announcements = Announcements(zenoh)
        """What bridges are told of the session's ends."""
        self._due = threading.Event()
        self._closed = threading.Event()
        self._asking: threading.Thread | None = None
        self._reader = ReadingThread("ros-bridges", watch_tokens(zenoh, TOKENS), self._take)

    def close(self) -> None:
        """Stop following, once the session is closed; again is harmless."""
        self._closed.set()
        self._due.set()
        self._reader.close()
        asking = self._asking
        if asking is not None and asking is not threading.current_thread():
            wait_for_thread(asking)

    @property
    def current(self) -> tuple[Bridge, ...]:
        """Return the bridges that are there and were asked, those that came first in front.

        Whoever does not answer comes last: of two with the same nodes the other one counts.
        """
        return self._current

    @property
    def announcing(self) -> frozenset[str]:
        """Return the sessions that announce their ends to bridges, with this one itself.

        Those of this library do; nodes of rmw_zenoh_cpp and nodes on DDS do not meet.
        """
        with self._changed:
            return frozenset(self._routes.keys() - self._met.keys()) | {self.zid}

    def on_change(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Call a listener, which must be quick, after each change; return what ends that."""
        with self._changed:
            self._listeners = (*self._listeners, listener)
        return lambda: self._forget(listener)

    def sender(self, zid: str, topic: str) -> Sender | None:
        """Return who sends a topic through a bridge; None: it is not to be taken.

        It is not where another bridge brings it as well, and of a bridge of another domain.

        Where several nodes behind the bridge publish it, nobody knows which of them sent a sample.
        """
        if zid in self._unused:
            return None
        try:
            return self._senders[zid, topic]
        except KeyError:
            found = Sender(sender_gid(zid, topic), "")
            if len(self._senders) < _SENDERS_MAX:
                self._senders[zid, topic] = found
            return found

    def settle(self, timeout_s: float = ANSWER_TIMEOUT_S) -> bool:
        """Wait until all bridges that are alive now were asked; False when that takes too long."""
        end_s = time.monotonic() + timeout_s
        tokens = live_tokens(self._zenoh, BRIDGES, timeout_s)
        alive = {one for token in tokens if (one := _bridge_of(token))}
        with self._changed:
            return self._changed.wait_for(
                lambda: (
                    (alive - self._others.keys()) | self._met.keys()
                    <= {one.zid for one in self._current}
                ),
                max(0.0, end_s - time.monotonic()),
            )

    def join(self, side: BridgeSide[Any]) -> None:
        """Begin a side whenever a bridge is there, and end it when none is, until it leaves."""
        with self._turn:
            self._sides.setdefault(side.topic, {})[side] = None
            self._update(side)

    def leave(self, side: BridgeSide[Any]) -> None:
        """End a side; again is harmless."""
        with self._turn:
            same_topic = self._sides.get(side.topic, {})
            same_topic.pop(side, None)
            if not same_topic:
                self._sides.pop(side.topic, None)
            side.update(is_used=False, brought=None)

    def _update(self, side: BridgeSide[Any]) -> None:
        side.update(is_used=self.is_used, brought=self._brought.get(side.topic))

    def _forget(self, listener: Callable[[], None]) -> None:
        with self._changed:
            self._listeners = tuple(one for one in self._listeners if one != listener)

    def _take(self, samples: list[Sample]) -> None:
        with self._changed:
            changes = [self._take_one(*token_change(sample)) for sample in samples]
        if "gone" in changes:
            self._is_stale = True
            if time.monotonic() >= self._rests_until_s:  # else whoever flaps would keep us busy
                self._make_current()
        if "new" in changes or "gone" in changes:
            self._ask_soon()

    def _take_one(self, token: str, is_alive: bool) -> Literal["new", "gone", ""]:  # noqa: FBT001
        """Take in a token; what became of what is known. With the lock."""
        try:
            found = parse_bridge_token(token)
        except TokenError as error:
            self.malformed += 1
            self.last_malformed = str(error)
            return ""
        if isinstance(found, Route):
            return self._take_route(token, found, is_alive=is_alive)
        if found == self.zid:
            return ""
        return self._meet(found) if is_alive else self._lose(found)

    def _meet(self, zid: str) -> Literal["new", ""]:
        if zid in self._met:
            return ""
        if len(self._met) >= BRIDGES_MAX:
            if len(self._others) < _OTHERS_MAX:
                self._others[zid] = None
            return ""
        self._met[zid] = Met(zid, self._routes.setdefault(zid, {}))
        self._dirty.add(zid)
        return "new"

    def _lose(self, zid: str) -> Literal["gone", ""]:
        self._others.pop(zid, None)
        if self._met.pop(zid, None) is None:
            return ""
        if not self._routes[zid]:
            del self._routes[zid]
        if self._others:
            first = next(iter(self._others))
            del self._others[first]
            self._meet(first)
        return "gone"

    def _take_route(
        self, token: str, route: Route, *, is_alive: bool
    ) -> Literal["new", "gone", ""]:
        """Take in a route; sessions that are no bridge announce theirs, too."""
        of_session = self._routes.get(route.zid, {})
        if is_alive and token not in of_session and self._route_count < ROUTES_MAX:
            of_session = self._routes.setdefault(route.zid, of_session)
            of_session[token] = route
            self._route_count += 1
        elif not is_alive and of_session.pop(token, None) is not None:
            self._route_count -= 1
            if not of_session and route.zid not in self._met:
                del self._routes[route.zid]
        else:
            return ""
        if route.zid not in self._met:
            return ""
        self._dirty.add(route.zid)
        return "new" if is_alive else "gone"

    def _ask_soon(self) -> None:
        with self._changed:
            if self._asking is None and self._met and not self._closed.is_set():
                self._asking = threading.Thread(
                    target=self._ask_on, name="ros-bridges-ask", daemon=True
                )
                self._asking.start()
        self._due.set()

    def _ask_on(self) -> None:
        """Ask bridges whenever something changed, and now and then, until the end."""
        while not self._closed.wait(_SETTLE_S):
            self._due.clear()
            began_s = time.thread_time()
            try:
                self._ask()
            except Exception:  # noqa: BLE001 - what a bridge tells must not end the asking
                if not (self._zenoh.is_closed() or self._has_failed):
                    self._has_failed = True  # again and again would be a flood of lines
                    _log.exception("Bridges could not be asked")
                self._due.set()
            if self._closed.wait(_REST * (time.thread_time() - began_s)):
                return
            pause_s = _SWEEP_EVERY_S if self.announcements.sweep() else _ASK_EVERY_S
            if not self._due.wait(pause_s if self._met else None):
                with self._changed:
                    self._dirty.update(self._met)

    def _ask(self) -> None:
        """Ask those of which something changed, and make values of the answers.

        Those that were slow before come last, and after one that is slow the rest waits for the
        next turn, so that news of the others come soon.
        """
        with self._changed:
            self._dirty &= self._met.keys()
            asked = sorted((self._met[zid] for zid in self._dirty), key=lambda one: one.is_late)
            bounds = Bounds.of_each(len(self._met))
        for one in asked:
            if one.is_late and one is not asked[0]:
                self._make_current()
            with self._changed:
                self._dirty.discard(one.zid)
            began_s = time.monotonic()
            one.is_late = True  # also where reading what it tells fails: then the others come first
            self._ask_one(one, bounds)
            one.is_late = time.monotonic() - began_s > _LATE_S
            if one.is_late:
                if self._dirty:
                    self._due.set()
                break
        if asked or self._is_stale:
            self._make_current()

    def _ask_one(self, one: Met, bounds: Bounds) -> None:
        answers, is_whole = all_admin_answers(
            self._zenoh,
            admin_key(one.zid),
            ANSWER_TIMEOUT_S,
            most=bounds.answers,
            most_bytes=bounds.bytes,
        )
        told = read_answers(answers, one.zid, bounds.ends)
        with self._changed:
            one.hear(told, is_whole=is_whole)

    def _make_current(self) -> None:
        """Make values of what is known, update sides, and call listeners."""
        began_s = time.thread_time()
        with self._turn:
            with self._changed:
                self._is_stale = False
                asked = [one for one in self._met.values() if one.asked]
                asked.sort(key=lambda one: one.is_silent)
                current, doubles = bridges_of(asked, self._domain)
                is_same = current == self._current
                self._current = current
                self._senders = senders_of(current, doubles)
                self._unused = frozenset(one.zid for one in current if not one.is_used)
                self._changed.notify_all()
                listeners = self._listeners
            try:
                self._use(current)
            finally:
                if not is_same:
                    for listener in listeners:
                        listener()
        self._rests_until_s = time.monotonic() + _REST * (time.thread_time() - began_s)

    def _use(self, current: tuple[Bridge, ...]) -> None:
        if self._closed.is_set():
            return
        used = [one for one in current if one.is_used]
        brought = {
            end.name: end for one in used for end in one.ends if end.kind is EndpointKind.PUBLISHER
        }
        is_switched = bool(used) is not self.is_used
        changed = self._sides.keys() if is_switched else _differing(brought, self._brought)
        self.is_used, self._brought = bool(used), brought
        for topic in tuple(changed):
            for side in tuple(self._sides.get(topic, ())):
                self._update(side)
        if not used:
            self.announcements.sweep(at_once=True)


def _bridge_of(token: str) -> str:
    """Return the session of a bridge; empty for a token of anything else."""
    try:
        found = parse_bridge_token(token)
    except TokenError:
        return ""
    return found if isinstance(found, str) else ""


def _differing(one: dict[str, BridgedEnd], other: dict[str, BridgedEnd]) -> set[str]:
    """Return the topics that only one has, or that they have with another type or QoS."""
    both = one.keys() & other.keys()
    changed = {
        topic
        for topic in both
        if one[topic] is not other[topic]
        and (one[topic].type_name, one[topic].type_hash, one[topic].qos)
        != (other[topic].type_name, other[topic].type_hash, other[topic].qos)
    }
    return (one.keys() ^ other.keys()) | changed
