"""Topics in a form of their publishers' own: messages if they told it, else the bytes alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.node.base import Endpoint
from studio.ros.node.subscription import Subscription
from studio.ros.tokens import EndpointKind, EndpointToken
from studio.ros.types.classes import make_class
from studio.ros.types.definitions import Message

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.node import Node
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue


def listen_as(
    node: Node,
    other: GraphEndpoint,
    kind: type[MessageValue] | None,
    callback: Callable[..., object],
    qos: QoSProfile,
    *,
    raw: bool,
) -> Subscription:
    """Listen to a topic in the form that another's token tells; without a class, to its bytes."""
    token = EndpointToken(
        node.token,
        node.wire.next_id(),
        EndpointKind.SUBSCRIPTION,
        other.name,
        other.type_name,
        other.type_hash,
        qos,
    )
    endpoint = Endpoint(node.wire, token, lambda: node.graph)
    raw = raw or kind is None
    kind = kind or make_class(Message(other.type_name), _no_part)
    subscription = Subscription(endpoint, kind, callback, node.default_callback_group, raw=raw)
    node.add_work(subscription)
    return subscription


def _no_part(name: str) -> type[MessageValue]:
    raise KeyError(name)
