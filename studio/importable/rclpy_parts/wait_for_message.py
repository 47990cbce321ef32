"""Waiting for one message of a topic."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

from studio.ros.node.base import NodeBase
from studio.ros.node.subscription import Subscription
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.tokens import EndpointKind
from studio.ros.types.classes import MessageValue
from studio.ros.types.library import check_is_type, check_same_type

if TYPE_CHECKING:
    from studio.ros.node.node import Node
    from studio.ros.qos import QoSProfile

_CHECK_S = 0.005


def wait_for_message(
    msg_type: type[MessageValue],
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[bool, Any]:
    """Wait for the next message of a topic.

    Args:
        msg_type: The class of its messages.
        node: The node that subscribes meanwhile.
        topic: Its name.
        qos_profile: A profile or a depth.
        time_to_wait: Seconds; below zero as long as it takes.

    Returns:
        Whether one came, and the message or None.
    """
    check_is_type(msg_type, MessageValue, "message")
    type_name = check_same_type(node.context.wire.types, msg_type)
    endpoint = NodeBase.endpoint(node, EndpointKind.SUBSCRIPTION, type_name, topic, qos_profile)
    # Without a callback it is no work for an executor: this may be called within a callback, and
    # of a node that nothing spins.
    subscription = Subscription(endpoint, msg_type, None, ReentrantCallbackGroup())
    node.add_work(subscription)
    end_s = math.inf if time_to_wait < 0 else time.monotonic() + time_to_wait
    try:
        while (message := subscription.take_message()) is None:
            left_s = end_s - time.monotonic()
            if left_s <= 0 or not node.context.ok():
                return False, None
            time.sleep(min(left_s, _CHECK_S))
        return True, message
    finally:
        node.remove_work(subscription)
