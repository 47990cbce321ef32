"""Announcements: tokens by which bridges know a session's ends, one for all ends of a name."""

from __future__ import annotations

import contextlib
import threading
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from studio.ros.wire.zenoh import Declaration, Session, ZError, declare_token

if TYPE_CHECKING:
    from collections.abc import Hashable


@dataclass(slots=True)
class _Shown:
    """A token, and the ends that need it."""

    declared: Declaration
    holders: set[Hashable] = field(default_factory=set["Hashable"])


class Announcements:
    """Shows one token for all ends of a kind and name, as long as there is one of them.

    A bridge notes sessions by kind and name. With the first token that goes it ends what it has
    for the session, whatever others there are.
    """

    def __init__(self, zenoh: Session) -> None:
        self._zenoh = zenoh
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
            if shown is None:
                shown = self._shown[place] = _Shown(declare_token(self._zenoh, token))
            shown.holders.add(holder)

    def release(self, token: str, holder: Hashable) -> None:
        """Hold it no more; again is harmless."""
        place = _place(token)
        with self._lock:
            shown = self._shown.get(place)
            if shown is None:
                return
            shown.holders.discard(holder)
            if shown.holders:
                return
            del self._shown[place]
            if not self._zenoh.is_closed():
                with contextlib.suppress(ZError):
                    shown.declared.undeclare()


def _place(token: str) -> str:
    """Return kind and name, by which a bridge notes what a session announces."""
    return "/".join(token.split("/")[3:5])
