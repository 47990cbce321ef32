"""Announcements: tokens by which bridges know a session's ends, one for all ends of a name."""

from __future__ import annotations

import contextlib
import threading
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.ros.tokens import EndpointKind
from studio.ros.wire.zenoh import Declaration, Session, ZError, declare_token

if TYPE_CHECKING:
    from collections.abc import Hashable

_LINGERS_S: Final = 1.0
"""How long the token of subscriptions is kept after the last of them."""


@dataclass(slots=True)
class _Kept:
    """A token and who needs it; None: nobody could tell it so far."""

    declared: Declaration | None = None
    holders: set[Hashable] = field(default_factory=set["Hashable"])
    ends_s: float | None = None
    """When it is taken back if nobody holds it until then, by the monotonic clock."""


class Announcements:
    """Keeps one token for all ends of a kind and name, as long as there is one of them.

    A bridge notes sessions by topic. With the first token that goes it ends what it has for the
    session, whatever others there are, and reads the topic no more until all subscribers of
    Zenoh have gone. For the same reason a subscription that follows on one that has just ended
    finds its token still there: the bridge might hear of the end after the begin.
    """

    def __init__(self, zenoh: Session) -> None:
        self._zenoh = zenoh
        self._lock = threading.Lock()
        self._kept: dict[tuple[EndpointKind, str], _Kept] = {}
        self._ending: threading.Timer | None = None
        """One for all: when a bridge goes, hundreds of subscriptions are released at once."""

    def hold(self, kind: EndpointKind, topic: str, holder: Hashable, token: str | None) -> None:
        """Announce an end for as long as it holds this; again is harmless.

        Args:
            kind: Of the end.
            topic: Its full name.
            holder: The end.
            token: What to show if nothing is shown yet; None: it needs what others show.

        Raises:
            ZError: The session is closed.
        """
        with self._lock:
            kept = self._kept.setdefault((kind, topic), _Kept())
            kept.holders.add(holder)
            kept.ends_s = None
            if kept.declared is None and token is not None:
                kept.declared = declare_token(self._zenoh, token)

    def release(self, kind: EndpointKind, topic: str, holder: Hashable) -> None:
        """Hold it no more; again is harmless."""
        place = (kind, topic)
        with self._lock:
            kept = self._kept.get(place)
            if kept is None or holder not in kept.holders:
                return
            kept.holders.discard(holder)
            if kept.holders:
                return
            if kind is not EndpointKind.SUBSCRIPTION:
                self._end(place)
                return
            kept.ends_s = time.monotonic() + _LINGERS_S
            if self._ending is None:
                self._end_in(_LINGERS_S)

    def close(self) -> None:
        """Wait for nothing any more, once the session is closed."""
        with self._lock:
            if self._ending is not None:
                self._ending.cancel()
                self._ending = None
            self._kept.clear()

    def _end_in(self, seconds: float) -> None:
        """Look again after a while; with the lock."""
        self._ending = threading.Timer(seconds, self._end_unheld)
        self._ending.daemon = True
        self._ending.start()

    def _end_unheld(self) -> None:
        with self._lock:
            self._ending = None
            now_s = time.monotonic()
            ends = {place: one.ends_s for place, one in self._kept.items() if one.ends_s}
            for place, ends_s in ends.items():
                if ends_s <= now_s:
                    self._end(place)
            if later := [ends_s for ends_s in ends.values() if ends_s > now_s]:
                self._end_in(min(later) - now_s)

    def _end(self, place: tuple[EndpointKind, str]) -> None:
        declared = self._kept.pop(place).declared
        if declared is not None and not self._zenoh.is_closed():
            with contextlib.suppress(ZError):
                declared.undeclare()
