"""Topics whose type nobody knows: their bytes come as they are, to be counted and shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.node.endpoint import Endpoint
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


def listen_unread(
    node: Node, other: GraphEndpoint, callback: Callable[..., object], qos: QoSProfile
) -> Subscription:
    """Take the bytes of a topic in the form that another's token tells, whatever that is."""
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
    kind = make_class(Message(other.type_name), _no_part)
    subscription = Subscription(endpoint, kind, callback, node.default_callback_group, raw=True)
    node.add_work(subscription)
    return subscription


def _no_part(name: str) -> type[MessageValue]:
    raise KeyError(name)
