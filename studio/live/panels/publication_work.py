"""MessageSender: a publisher and its message, made again each time if it holds the time.

It imports Zenoh (through `ros`), so it is imported when it is first used.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final, cast

from studio.live.panels.requests import wire_name
from studio.ros.cdr import codec_of
from studio.ros.names import full_type_name
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.type_lookup import known_message
from studio.ros.types.convert import from_dict, from_yaml
from studio.ros.types.yaml_texts import read_yaml

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.live.connection.link import WireLink
    from studio.protocol.publishing import Publish

_TIME_KEYWORDS: Final = frozenset({"now", "auto"})


class MessageSender:
    """One message on one topic; made and closed in a thread, published in any.

    Raises:
        StudioError: The name of the topic is not valid, its type is not known, or the values do
            not fit it.
    """

    def __init__(self, link: WireLink, asked: Publish) -> None:
        self.name, self.type_name = wire_name(asked.name), full_type_name(asked.message_type)
        why: list[str] = []
        kind = known_message(link.node, self.name, self.type_name, why.append)
        message = from_yaml(kind, asked.text, now_ns=time.time_ns())
        values = read_yaml(asked.text)
        has_time = _has_keyword(values)
        written = codec_of(kind).encode(message)
        self._make = (
            (lambda: from_dict(kind, values, now_ns=time.time_ns()))
            if has_time
            else (lambda: written)
        )
        self._link = link
        self._publisher = link.node.create_publisher(kind, self.name, _profile(asked))
        self._end: Callable[[], object] = lambda: None

    def listeners(self) -> int:
        """Count who subscribes to the topic."""
        return self._publisher.get_subscription_count()

    def send(self) -> None:
        """Send it once."""
        self._publisher.publish(self._make())

    def repeat(self, rate_hz: float, sent: Callable[[], None]) -> None:
        """Send it so often a second from now on, in the thread of the link."""

        def beat() -> None:
            self.send()
            sent()

        node = self._link.node
        timer = node.create_timer(1 / rate_hz, beat)
        self._end = lambda: node.destroy_timer(timer)

    def close(self) -> None:
        """Send nothing any more."""
        self._end()
        self._link.node.destroy_publisher(self._publisher)


def _profile(asked: Publish) -> QoSProfile:
    reliable, best = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
    kept, not_kept = DurabilityPolicy.TRANSIENT_LOCAL, DurabilityPolicy.VOLATILE
    return QoSProfile(
        depth=asked.depth,
        reliability=reliable if asked.reliable else best,
        durability=kept if asked.latched else not_kept,
    )


def _has_keyword(values: object) -> bool:
    """Whether a keyword for the time (`now`, `auto`) is anywhere in the values."""
    if isinstance(values, dict):
        return any(map(_has_keyword, cast("dict[object, object]", values).values()))
    if isinstance(values, list):
        return any(map(_has_keyword, cast("list[object]", values)))
    return isinstance(values, str) and values in _TIME_KEYWORDS
