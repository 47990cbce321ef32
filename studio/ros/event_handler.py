"""Callbacks on events of publishers and subscriptions, and what they are given, as in rclpy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from studio.errors import UnsupportedEventTypeError

if TYPE_CHECKING:
    from collections.abc import Callable


class MatchedInfo(NamedTuple):
    """How many are at the other end; the changes are those since the callback before."""

    total_count: int
    total_count_change: int
    current_count: int
    current_count_change: int


class CountInfo(NamedTuple):
    """How often it happened; the change is that since the callback before."""

    total_count: int
    total_count_change: int


QoSPublisherMatchedInfo = QoSSubscriptionMatchedInfo = MatchedInfo
QoSMessageLostInfo = IncompatibleTypeInfo = CountInfo


@dataclass(frozen=True, slots=True, kw_only=True)
class _EventCallbacks:
    """What either end of a topic tells.

    `incompatible_qos` is never called: Zenoh carries samples between any profiles.

    Raises:
        UnsupportedEventTypeError: A callback is given for what Zenoh does not tell.
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
    """What a publisher tells."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SubscriptionEventCallbacks(_EventCallbacks):
    """What a subscription tells: also that messages were lost."""

    message_lost: Callable[[CountInfo], object] | None = None


def _refuse(**callbacks: Callable[[object], object] | None) -> None:
    for event, callback in callbacks.items():
        if callback is not None:
            raise UnsupportedEventTypeError(event)
