"""Publisher: sends the messages of a topic, numbered and stamped as rmw_zenoh does."""

from __future__ import annotations

import threading
import time
from collections import deque
from typing import TYPE_CHECKING, TypeAlias

from studio.errors import DestroyedError
from studio.ros.attachment import packed
from studio.ros.cdr import check_kind, codec_of
from studio.ros.qos import DEPTH_DEFAULT, DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from studio.ros.types.classes import definition_of
from studio.ros.wire.zenoh import declare_publisher

if TYPE_CHECKING:
    from studio.ros.duration import Duration
    from studio.ros.node.base import Endpoint
    from studio.ros.node.work import Work
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue
    from studio.ros.wire.zenoh import Outgoing


_Sent: TypeAlias = "tuple[bytes | bytearray, bytes]"
"""A message as CDR, and what is attached to it."""


class RawPublisher:
    """Publishes bytes on one topic, of a type that need not be known here; thread-safe."""

    def __init__(self, endpoint: Endpoint) -> None:
        self.endpoint = endpoint
        self._lock = threading.Lock()
        self._sequence = 0
        self._gid = endpoint.gid
        self._outgoing: Outgoing | None = _declared(endpoint, endpoint.key)
        qos = endpoint.token.qos
        is_latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._kept = deque[_Sent](maxlen=(qos.depth or DEPTH_DEFAULT) if is_latched else 0)
        """What a bridge that comes later gets, too."""
        self._for_bridges = endpoint.for_bridges(self._declared_for_bridges, self._lock)
        endpoint.show()

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self.endpoint.token.name

    topic = topic_name

    @property
    def qos_profile(self) -> QoSProfile:
        """The profile asked for."""
        return self.endpoint.token.qos

    def send(self, payload: bytes | bytearray) -> None:
        """Send a message that is written as CDR.

        Raises:
            DestroyedError: The publisher was destroyed.
        """
        with self._lock:
            outgoing = self._outgoing
            if outgoing is None:
                raise DestroyedError(f"publisher of {self.topic_name}")
            self._sequence = number = self._sequence + 1
            attachment = packed(number, time.time_ns(), self._gid)
            outgoing.put(payload, attachment=attachment)
            if self._kept.maxlen:
                self._kept.append((payload, attachment))
            bridged = self._for_bridges.declared
            if bridged is not None:
                # Nodes of rmw_zenoh know by the attachment that it came to them already.
                bridged.put(payload, attachment=attachment)

    def _declared_for_bridges(self, key: str) -> Outgoing:
        """Declare what sends to bridges, and send what is kept; with the lock."""
        outgoing = _declared(self.endpoint, key, is_for_others=True)
        for payload, attachment in self._kept:
            outgoing.put(payload, attachment=attachment)
        return outgoing

    def get_subscription_count(self) -> int:
        """Count the subscriptions of the topic that have its type."""
        own = self.endpoint.token
        there = self.endpoint.graph().subscriptions(own.name)
        return sum(
            one.type_name == own.type_name
            and (one.type_hash == own.type_hash or bool(one.node.bridge))  # DDS knows names only
            for one in there
        )

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """Whether all was received: Zenoh tells nobody, so what was sent counts as received."""
        del timeout
        return True

    def assert_liveliness(self) -> None:
        """Do nothing: a publisher is alive for as long as it is there."""

    def destroy(self) -> None:
        """Take it back; again is harmless."""
        with self._lock:
            outgoing, self._outgoing = self._outgoing, None
        if outgoing is not None:
            self.endpoint.hide(outgoing)


class Publisher(RawPublisher):
    """Publishes on one topic; thread-safe.

    Attributes:
        events: Handlers that call back on its events, work of its node.
    """

    def __init__(self, endpoint: Endpoint, msg_type: type[MessageValue]) -> None:
        self.msg_type = msg_type
        self._definition = definition_of(msg_type)
        self._codec = codec_of(msg_type)
        self.events: list[Work] = []
        super().__init__(endpoint)

    def publish(self, msg: MessageValue | bytes | bytearray) -> None:
        """Send a message, or one that is written as CDR already.

        Raises:
            MessageValueError: It is of another type, or a field holds what it does not take.
            DestroyedError: The publisher was destroyed.
        """
        self.send(self._written(msg))

    def _written(self, msg: MessageValue | bytes | bytearray) -> bytes | bytearray:
        if isinstance(msg, self.msg_type):  # the usual case comes first
            return self._codec.encode(msg)
        if isinstance(msg, bytes | bytearray):
            return msg
        return self._codec.encode(check_kind(self._definition, msg))


def _declared(endpoint: Endpoint, key: str, *, is_for_others: bool = False) -> Outgoing:
    qos = endpoint.token.qos
    reliable = qos.reliability is not ReliabilityPolicy.BEST_EFFORT
    latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    return declare_publisher(
        endpoint.wire.zenoh,
        key,
        blocking=reliable and qos.history is HistoryPolicy.KEEP_ALL,
        reliable=reliable,
        kept=(qos.depth or DEPTH_DEFAULT) if latched else None,
        is_for_others=is_for_others,
    )
