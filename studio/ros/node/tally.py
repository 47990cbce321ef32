"""Tally: counts what comes on a topic, whatever its type, and reads none of it."""

from __future__ import annotations

import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from studio.errors import AttachmentError
from studio.ros.attachment import unpack
from studio.ros.names import check_full_name
from studio.ros.node.arrivals import Arrivals, Flow
from studio.ros.node.sequences import Gaps
from studio.ros.tokens import whatever_type_key
from studio.ros.wire.zenoh import declare_subscription

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.node.context import Context
    from studio.ros.wire.zenoh import Sample

RING: Final = 64
"""Samples that Zenoh keeps between two looks; what falls out is counted by its numbers."""
_MISSED_MAX: Final = 10_000
"""A peer may write any number."""


class Tally:
    """Hears a topic until nobody asked for `kept_s`: then it ends by itself.

    It shows no token, so that nobody sees one more subscription; payloads are never copied.

    Raises:
        RosNameError: No topic is named so.
    """

    def __init__(self, context: Context, topic: str, kept_s: float) -> None:
        self._context, self._kept_s = context, kept_s
        self._asked_s = time.monotonic()
        self._arrivals = Arrivals(time.monotonic_ns())
        self._gaps = Gaps()
        key = whatever_type_key(context.wire.domain, check_full_name(topic))
        self._incoming = declare_subscription(context.wire.zenoh, key, RING, reliable=False)
        self.is_open = True
        context.drain.add(self)

    def flow(self) -> Flow:
        """How it comes; it goes on being heard for a while."""
        self._asked_s = time.monotonic()
        return self._arrivals.flow(time.monotonic_ns())

    def close(self) -> None:
        """Hear it no more; again is harmless."""
        self.is_open = False
        self._context.forget_source(self)
        self._incoming.undeclare()

    def drain(self) -> int:
        """Count what came; of the drain's thread."""
        if samples := self._incoming.take(RING):
            sizes, missed = [len(one.payload) for one in samples], self._missed(samples)
            bytes_missed = missed * sum(sizes) // len(sizes)
            now_ns = time.monotonic_ns()
            self._arrivals.count(now_ns, len(sizes) + missed, sum(sizes) + bytes_missed)
        if time.monotonic() - self._asked_s > self._kept_s:
            self.close()
        return len(samples)

    def _missed(self, samples: Sequence[Sample]) -> int:
        """How many fell out of the ring; none are known of senders that do not number them."""
        missed = 0
        for sample in samples:
            attachment = sample.attachment
            with suppress(AttachmentError):
                numbered = unpack(None if attachment is None else attachment.to_bytes())
                missed += self._gaps.count(numbered)
        return min(missed, _MISSED_MAX) if len(samples) == RING else 0
