"""Announcements: tokens by which bridges know a session's ends, one for all ends of a name."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Hashable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.ros.qos import DurabilityPolicy, HistoryPolicy
from studio.ros.wire.bridges.dialect import Route, RouteKind, parse_bridge_token
from studio.ros.wire.zenoh import Declaration, Session, ZError, declare_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.qos import QoSProfile

_LINGERS_S: Final = 1.0
_MANY: Final = 2**31


@dataclass(slots=True)
class _Shown:
    """A token, the ends that need it, and since when none does."""

    token: str
    declared: Declaration
    holders: set[Hashable]
    idle_since_s: float = 0.0


class Announcements:
    """Shows one token for all ends of a kind and name, as long as there is one of them.

    A bridge notes sessions by kind and name. With the first token that goes it ends what it has
    for the session, whatever others there are. So the token of subscriptions also outlives the
    last of them for a second: a bridge might hear of the end after the next has begun. It makes
    a route with the QoS of the first token: of publishers, the one that offers most is shown.
    """

    def __init__(self, zenoh: Session, clock: Callable[[], float] = time.monotonic) -> None:
        self._zenoh, self._clock = zenoh, clock
        self._lock = threading.Lock()
        self._shown: dict[str, _Shown] = {}
        """By what the token says before type and QoS."""

    def hold(self, token: str, holder: Hashable) -> None:
        """Announce an end for as long as it holds this; again is harmless.

        Raises:
            ZError: The session is closed.
        """
        place = _place(token)
        with self._lock:
            shown = self._shown.get(place)
            holders = set[Hashable]() if shown is None else shown.holders
            if shown is not None and _replaces(token, shown.token):
                self._end(place)
                shown = None
            if shown is None:
                self._shown[place] = _Shown(token, declare_token(self._zenoh, token), holders)
            holders.add(holder)

    def release(self, token: str, holder: Hashable) -> None:
        """Hold it no more; again is harmless."""
        place = _place(token)
        with self._lock:
            shown = self._shown.get(place)
            if shown is None or holder not in shown.holders:
                return
            shown.holders.discard(holder)
            if shown.holders:
                return
            shown.idle_since_s = self._clock()
            if not place.startswith(RouteKind.SUBSCRIPTION):
                self._end(place)

    def sweep(self, *, at_once: bool = False) -> bool:
        """End tokens that nobody holds any more; whether some are left for later.

        Args:
            at_once: Whether also those that were let go just now, as when no bridge is left.
        """
        with self._lock:
            idle = {place: one for place, one in self._shown.items() if not one.holders}
            due_s = self._clock() - (0.0 if at_once else _LINGERS_S)
            ended = [place for place, one in idle.items() if one.idle_since_s <= due_s]
            for place in ended:
                self._end(place)
        return len(ended) < len(idle)

    def _end(self, place: str) -> None:
        declared = self._shown.pop(place).declared
        if not self._zenoh.is_closed():
            with contextlib.suppress(ZError):
                declared.undeclare()


def _place(token: str) -> str:
    """Return kind and name, by which a bridge notes what a session announces."""
    return "/".join(token.split("/")[3:5])


def _replaces(token: str, shown: str) -> bool:
    """Whether a token is shown in the place of another of its kind and name."""
    if token == shown:
        return False
    new, old = parse_bridge_token(token), parse_bridge_token(shown)
    if not (isinstance(new, Route) and isinstance(old, Route) and new.qos and old.qos):
        return False
    return new.kind is RouteKind.SUBSCRIPTION or _offer(new.qos) > _offer(old.qos)


def _offer(qos: QoSProfile) -> tuple[bool, int]:
    """Return how many earlier messages it offers, nearly all where all are kept."""
    if qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
        return False, 0
    return True, _MANY if qos.history is HistoryPolicy.KEEP_ALL else qos.depth
