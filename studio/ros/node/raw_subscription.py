"""RawSubscription: a topic's samples as bytes, handed over in the drain's thread as they come."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.errors import AttachmentError
from studio.ros.attachment import unpack
from studio.ros.node.samples import BRIDGED_RING_MIN, Gaps, RawSample, bridged_sample, sender_of
from studio.ros.qos import DEPTH_DEFAULT, DurabilityPolicy, QoSProfile, ReliabilityPolicy
from studio.ros.tokens import EndpointKind
from studio.ros.wire.zenoh import declare_subscription

if TYPE_CHECKING:
    from studio.ros.node.base import Endpoint, NodeBase
    from studio.ros.wire.bridges.side import BridgeSide
    from studio.ros.wire.zenoh import Incoming, Sample

RING: Final = 4_096
"""Samples that Zenoh keeps between two reads, where not only the newest counts."""
_SWAP_PATIENCE_S: Final = 2.0

TakeSamples: TypeAlias = Callable[[list[RawSample], int, int], object]
"""Takes samples that came together, how many came in all, and the bytes of all their payloads."""

_log = logging.getLogger(__name__)


class RawSubscription:
    """Receives a topic from its making until `close`; both may wait, as `deepen` does.

    Its token is shown as that of any subscription: some drivers publish only while one is there.
    It queues nothing: `take` is called in the drain's thread, so it must be quick.

    Args:
        node: Whose subscription it is; it ends with the node.
        topic: In full.
        type_name: Of its messages; it need not be known here.
        type_hash: As a publisher shows it; None is that of the known type.
        qos: How it is subscribed.
        take: Called with what came.

    Raises:
        RosNameError: The topic cannot be named so.
        UnknownTypeError: No hash was given, and the type is not known.
    """

    def __init__(
        self,
        node: NodeBase,
        topic: str,
        type_name: str,
        type_hash: str | None,
        qos: QoSProfile,
        take: TakeSamples,
    ) -> None:
        self._node, self._take, self._qos = node, take, qos
        self._named = (topic, type_name, type_hash)
        self._gaps = Gaps()
        self._refused = False
        self._next: _Swap | None = None
        self._closed = False
        self._turn = threading.Lock()
        """Held while its depth grows, and while it closes."""
        self._swapping = threading.Lock()
        self._newest_only = False
        self._endpoint, self._incoming, self._bridged = self._declared(qos)
        node.context.drain.add(self)
        node.on_destroy(self.close)

    @property
    def lost(self) -> int:
        """Samples that were sent and did not come, by the numbers of their senders."""
        return self._gaps.lost

    def read(self, *, newest_only: bool) -> None:
        """Read only the newest of samples that came together, without counting losses, or all."""
        if self._newest_only and not newest_only:
            self._gaps.begin_anew()
        self._newest_only = newest_only

    def hurry(self, *, wanted: bool) -> None:
        """Hand over what comes as soon as can be, or as all others again."""
        drain = self._node.context.drain
        if wanted:
            drain.wait_for(self)
        else:
            drain.wait_no_more_for(self)

    def deepen(self, depth: int, swapped: Callable[[], object]) -> None:
        """Subscribe again with a greater depth; nothing is lost meanwhile.

        Args:
            depth: The new one; of a transient local topic so many earlier samples come again.
            swapped: Called in the drain's thread between the last of the old samples and the
                first of the new ones, which may repeat some of those.
        """
        qos = QoSProfile(
            depth=depth, reliability=self._qos.reliability, durability=self._qos.durability
        )
        with self._turn:
            if self._closed:
                return
            swap = self._next = _Swap(*self._declared(qos), swapped)
            swap.is_done.wait(_SWAP_PATIENCE_S)
            with self._swapping:
                self._next = None  # the drain has ended, if it is not done yet
            self._qos = qos
            swap.endpoint.hide(swap.incoming)

    def close(self) -> None:
        """Receive nothing more; again is harmless."""
        with self._turn:
            if self._closed:
                return
            self._closed = True
            self._node.forget_destroy(self.close)
            self._node.context.forget_source(self)
            self._endpoint.hide(self._incoming)

    def drain(self) -> int:
        """Hand over what came; of the drain's thread."""
        samples = self._incoming.take(RING)
        if samples:
            self._hand_over(samples)
        count = len(samples)
        bridged = self._bridged.declared
        if bridged is not None and (samples := bridged.take(RING)):
            self._hand_over_bridged(samples)
            count += len(samples)
        if self._next is not None:
            self._swap()
        return count

    def _swap(self) -> None:
        with self._swapping:
            if (swap := self._next) is None:
                return
            self._next = None
            self._endpoint, swap.endpoint = swap.endpoint, self._endpoint
            self._incoming, swap.incoming = swap.incoming, self._incoming
            self._bridged, swap.bridged = swap.bridged, self._bridged
            self._gaps.begin_anew()
            swap.swapped()
            swap.is_done.set()

    def _hand_over(self, samples: list[Sample]) -> None:
        now_ns = time.time_ns()
        count = len(samples)
        if self._newest_only and count > 1:
            size = sum(len(one.payload) for one in samples[:-1])
            samples = samples[-1:]
        else:
            size = 0
        came = [raw for one in samples if (raw := self._received(one, now_ns)) is not None]
        if came:
            self._take(came, count, size + sum(len(one.payload) for one in came))

    def _received(self, sample: Sample, now_ns: int) -> RawSample | None:
        attachment = sample.attachment
        try:
            unpacked = unpack(None if attachment is None else attachment.to_bytes())
        except AttachmentError as error:
            if not self._refused:  # a flood of them is no flood of lines
                self._refused = True
                _log.warning("A sample on %s was dropped. %s", self._named[0], error)
            return None
        if not self._newest_only:
            self._gaps.count(unpacked)
        return RawSample(sample.payload.to_bytes(), unpacked, now_ns)

    def _hand_over_bridged(self, samples: list[Sample]) -> None:
        """Hand over what came from DDS; among it may be what comes by its own key as well."""
        now_ns = time.time_ns()
        passed_over: list[Sample] = []
        bridges, token = self._node.wire.bridges, self._endpoint.token
        if self._newest_only and len(samples) > 1:
            samples = [one for one in samples if sender_of(bridges, token.name, one) is not None]
            passed_over, samples = samples[:-1], samples[-1:]
        read = (bridged_sample(bridges, token, one, now_ns) for one in samples)
        came = [raw for raw in read if raw is not None]
        if came:
            size = sum(len(one.payload) for one in (*passed_over, *came))
            self._take(came, len(passed_over) + len(came), size)

    def _declared(
        self, qos: QoSProfile
    ) -> tuple[Endpoint, Incoming[Sample], BridgeSide[Incoming[Sample]]]:
        topic, type_name, type_hash = self._named
        kind, node = EndpointKind.SUBSCRIPTION, self._node
        endpoint = node.endpoint(kind, type_name, topic, qos, type_hash)
        depth = qos.depth or DEPTH_DEFAULT
        latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL

        def declared(key: str, *, is_of_others: bool = False) -> Incoming[Sample]:
            least = BRIDGED_RING_MIN if is_of_others else 1
            return declare_subscription(
                node.wire.zenoh,
                key,
                least if depth == 1 else max(RING, depth),
                reliable=qos.reliability is not ReliabilityPolicy.BEST_EFFORT,
                wanted=depth if latched else None,
                is_of_others=is_of_others,
            )

        incoming = declared(endpoint.key)
        bridged = endpoint.for_bridges(lambda key: declared(key, is_of_others=True))
        endpoint.show()
        return endpoint, incoming, bridged


class _Swap:
    """The declaration that replaces the present one; after the swap, the one before."""

    def __init__(
        self,
        endpoint: Endpoint,
        incoming: Incoming[Sample],
        bridged: BridgeSide[Incoming[Sample]],
        swapped: Callable[[], object],
    ) -> None:
        self.endpoint, self.incoming, self.swapped = endpoint, incoming, swapped
        self.bridged = bridged
        self.is_done = threading.Event()
