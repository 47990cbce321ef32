"""Question: a request to a server, of rmw_zenoh or behind a bridge to DDS, to see if it answers."""

from __future__ import annotations

import secrets
import time
from typing import TYPE_CHECKING

from studio.ros.attachment import GID_BYTES, packed
from studio.ros.tokens import DataKey
from studio.ros.wire.bridges.dialect import bridge_key
from studio.ros.wire.zenoh import Replies, ZError, declare_querier

if TYPE_CHECKING:
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Querier


class Question:
    """A request of no client, on its way from when it is made until `close`.

    Args:
        wire: The session.
        server: Who is asked.
        request: As CDR.
        timeout_s: So long it may take to answer.
    """

    def __init__(
        self, wire: WireSession, server: GraphEndpoint, request: bytes, timeout_s: float
    ) -> None:
        is_bridged = bool(server.node.bridge)
        key = DataKey(wire.domain, server.name, server.type_name, server.type_hash)
        name = bridge_key(server.name) if is_bridged else str(key)
        number = packed(1, time.time_ns(), secrets.token_bytes(GID_BYTES))
        attachment = None if is_bridged else number  # bridges take their own or none
        self._answered = False
        self._querier: Querier = declare_querier(
            wire.zenoh, name, timeout_s, is_for_bridge=is_bridged
        )
        self._replies = Replies(self._querier, request, attachment)

    def is_answered(self) -> bool:
        """Whether an answer came; asked again and again."""
        if not self._answered:
            try:
                reply = self._replies.try_recv()
            except ZError:  # the time is over
                return False
            self._answered = reply is not None and reply.ok is not None
        return self._answered

    def close(self) -> None:
        """Wait no more."""
        self._replies.cancel()
        self._querier.undeclare()
