"""BridgeSide: what an end of ours has declared for bridges to DDS, while one is there."""

from __future__ import annotations

import contextlib
import logging
from typing import TYPE_CHECKING, Generic, TypeVar

from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.dialect import announcement, bridge_key, subscription_announcement
from studio.ros.wire.zenoh import Declaration, Session, ZError

if TYPE_CHECKING:
    from collections.abc import Callable
    from contextlib import AbstractContextManager

    from studio.ros.tokens import EndpointToken
    from studio.ros.wire.bridges.bridge import BridgedEnd
    from studio.ros.wire.bridges.bridges import Bridges

DeclaredT = TypeVar("DeclaredT", bound=Declaration)

_log = logging.getLogger(__name__)


class BridgeSide(Generic[DeclaredT]):
    """The half of an end that bridges meet, beside the one that rmw_zenoh's nodes meet.

    It is announced while a bridge is there: a bridge routes into DDS only what somebody announces.
    A subscriber is declared only where a bridge brings the topic, for publishers of
    rmw_zenoh have a side for bridges, too, and would send to it.

    Args:
        zenoh: The session.
        bridges: Those that it meets.
        token: The end; None: a subscriber of `topic` that is no subscription of a node.
        topic: Its full name.
        declare: Declares what takes or sends samples or requests, at a data key.
        lock: Held by who uses what is declared, and while that changes; None: nobody uses it in
            another thread, or it can be undeclared meanwhile.
    """

    def __init__(
        self,
        zenoh: Session,
        bridges: Bridges,
        token: EndpointToken | None,
        topic: str,
        declare: Callable[[str], DeclaredT],
        lock: AbstractContextManager[object] | None = None,
    ) -> None:
        self._zenoh, self._bridges, self._declare = zenoh, bridges, declare
        self._token = announcement(token) if token else None
        self._subscribes = token is None or token.kind is EndpointKind.SUBSCRIPTION
        self._lock = lock or contextlib.nullcontext()
        self._held: str | None = None
        self.topic = topic
        self.declared: DeclaredT | None = None
        """None while no bridge is there, or none needs it."""
        bridges.join(self)

    def update(self, *, is_used: bool, brought: BridgedEnd | None) -> None:
        """Declare what is needed now, and take back the rest; called by `Bridges` in turn.

        Args:
            is_used: Whether a bridge is there.
            brought: A publisher of the topic that comes through one; None: none does.
        """
        is_needed = is_used and (brought is not None or not self._subscribes)
        try:
            if is_needed and self.declared is None:
                with self._lock:
                    self.declared = self._declare(bridge_key(self.topic))
            self._announce(self._wanted(brought) if is_needed else None)
        except ZError as error:
            if not self._zenoh.is_closed():
                _log.warning("Bridges to DDS do not get %s. %s", self.topic, error)
        if not is_needed:
            with self._lock:
                declared, self.declared = self.declared, None
            self._undeclare(declared)

    def _wanted(self, brought: BridgedEnd | None) -> str | None:
        if not self._subscribes or brought is None:
            return self._token
        told = (brought.name, brought.type_name, brought.type_hash, brought.qos)
        return subscription_announcement(self._bridges.zid, *told)

    def _announce(self, token: str | None) -> None:
        held, self._held = self._held, token
        if token is not None:
            self._bridges.announcements.hold(token, self)
        elif held is not None:
            self._bridges.announcements.release(held, self)

    def close(self) -> None:
        """Take everything back; again is harmless."""
        self._bridges.leave(self)

    def _undeclare(self, declared: Declaration | None) -> None:
        if declared is not None and not self._zenoh.is_closed():
            with contextlib.suppress(ZError):
                declared.undeclare()
