"""Tokens of a node with many publishers, as fast as they can be declared."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.zenoh import declare_token

if TYPE_CHECKING:
    from studio.ros.wire.session import WireSession


def topic_named(number: int) -> str:
    """The name of one of the topics."""
    return f"/group_{number % 100}/topic_{number}"


def announce_topics(wire: WireSession, count: int) -> list[object]:
    """Show a node and its publishers; they stand as long as the session."""
    node = NodeToken(wire.domain, wire.zid, wire.next_id(), "/", "busy")
    type_name = "std_msgs/msg/String"
    known, qos = wire.types.hash_of(type_name), QoSProfile(depth=10)
    kind = EndpointKind.PUBLISHER
    tokens = [
        EndpointToken(node, wire.next_id(), kind, topic_named(number), type_name, known, qos)
        for number in range(count)
    ]
    return [declare_token(wire.zenoh, str(token)) for token in (node, *tokens)]
