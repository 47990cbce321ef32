"""Events of publishers and subscriptions, such as a match, and callbacks on them, as in rclpy."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from studio.errors import UnsupportedEventTypeError
from studio.ros.node.work import Work
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.base import Endpoint
    from studio.ros.node.work import CallbackGroup


class MatchedInfo(NamedTuple):
    """Number of matched endpoints; the changes are since the last callback."""

    total_count: int
    total_count_change: int
    current_count: int
    current_count_change: int


class CountInfo(NamedTuple):
    """Number of occurrences; the change is since the last callback."""

    total_count: int
    total_count_change: int


QoSPublisherMatchedInfo = QoSSubscriptionMatchedInfo = MatchedInfo
QoSMessageLostInfo = IncompatibleTypeInfo = CountInfo


@dataclass(frozen=True, slots=True, kw_only=True)
class _EventCallbacks:
    """Callbacks on events of either end of a topic.

    `incompatible_qos` is never called: Zenoh carries samples between any profiles.

    Raises:
        UnsupportedEventTypeError: A callback is given for an event that Zenoh does not report.
    """

    incompatible_qos: Callable[[object], object] | None = None
    liveliness: Callable[[object], object] | None = None
    deadline: Callable[[object], object] | None = None
    matched: Callable[[MatchedInfo], object] | None = None
    incompatible_type: Callable[[CountInfo], object] | None = None
    use_default_callbacks: bool = True

    def __post_init__(self) -> None:
        _refuse(deadline=self.deadline, liveliness=self.liveliness)


@dataclass(frozen=True, slots=True, kw_only=True)
class PublisherEventCallbacks(_EventCallbacks):
    """Callbacks on events of a publisher."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SubscriptionEventCallbacks(_EventCallbacks):
    """Callbacks on events of a subscription, also on lost messages."""

    message_lost: Callable[[CountInfo], object] | None = None


def _refuse(**callbacks: Callable[[object], object] | None) -> None:
    for event, callback in callbacks.items():
        if callback is not None:
            raise UnsupportedEventTypeError(event)


class CountEvent(Work):
    """Calls back when something was counted; one call covers all that happened meanwhile."""

    def __init__(self, callback: Callable[[Any], object], group: CallbackGroup) -> None:
        super().__init__(group)
        self.callback = callback
        self._lock = threading.Lock()
        self._total = self._reported = 0

    @property
    def is_ready(self) -> bool:
        """Whether there is something to call back with."""
        return self._total != self._reported

    def count(self, more: int) -> None:
        """Add to the count; thread-safe."""
        with self._lock:
            self._total += more
        self.announce()

    def take(self) -> Callable[[], object] | None:
        """Return what calls back."""
        with self._lock:
            total, change = self._total, self._total - self._reported
            self._reported = total
        return partial(self.callback, CountInfo(total, change)) if change else None


class MatchEvent(Work):
    """Calls back when those at the other end of a topic become others.

    For those with the same type it reports how many are there, for others how many there were in
    all.
    """

    def __init__(
        self,
        callback: Callable[[Any], object],
        group: CallbackGroup,
        endpoint: Endpoint,
        *,
        same_type: bool,
    ) -> None:
        super().__init__(group)
        self.callback = callback
        self._token, self._graph = endpoint.token, endpoint.graph()
        self._same_type = same_type
        self._lock = threading.Lock()
        self._there: frozenset[str] = frozenset()
        self._total = self._reported_total = self._reported_current = 0
        self._stop = self._graph.on_change(self._check)
        self._check()

    @property
    def is_ready(self) -> bool:
        """Whether there is something to call back with."""
        came = self._total != self._reported_total
        return came or (self._same_type and len(self._there) != self._reported_current)

    def take(self) -> Callable[[], object] | None:
        """Return what calls back."""
        with self._lock:
            if not self.is_ready:
                return None
            total, current = self._total, len(self._there)
            came, change = total - self._reported_total, current - self._reported_current
            self._reported_total, self._reported_current = total, current
        if self._same_type:
            return partial(self.callback, MatchedInfo(total, came, current, change))
        return partial(self.callback, CountInfo(total, came))

    def destroy(self) -> None:
        """Stop watching the graph."""
        self._stop()

    def _check(self) -> None:
        found = frozenset(one.token for one in self._others() if self._is_meant(one))
        with self._lock:
            self._total += len(found - self._there)
            self._there = found
        if self.is_ready:
            self.announce()

    def _others(self) -> list[GraphEndpoint]:
        if self._token.kind is EndpointKind.PUBLISHER:
            return self._graph.subscriptions(self._token.name)
        return self._graph.publishers(self._token.name)

    def _is_meant(self, other: GraphEndpoint) -> bool:
        return (other.type_name == self._token.type_name) is self._same_type


def events_of(
    callbacks: PublisherEventCallbacks | SubscriptionEventCallbacks | None,
    endpoint: Endpoint,
    group: CallbackGroup,
) -> list[Work]:
    """Make the events that both ends have, where there is a callback."""
    if callbacks is None:
        return []
    pairs = ((callbacks.matched, True), (callbacks.incompatible_type, False))
    return [
        MatchEvent(callback, group, endpoint, same_type=same_type)
        for callback, same_type in pairs
        if callback is not None
    ]
