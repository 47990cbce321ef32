"""Overheard: a topic heard as bytes, for whoever hands them on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.ros.node.subscription import Subscription
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.base import NodeBase
    from studio.ros.node.inbox import RawSample
    from studio.ros.qos import QoSProfile

_NEVER_READ: Final = "std_msgs/msg/Empty"


class Overheard:
    """Hears until `close`; making and closing it may wait, so do it in a thread.

    Its token is shown as that of any subscription: some drivers publish only while one is there.

    Args:
        node: Whose subscription it is.
        topic: In full.
        type_name: Of its messages; it need not be known here.
        type_hash: As a publisher shows it; None is that of the known type.
        qos: How it is heard.

    Raises:
        RosNameError: The topic cannot be named so.
        UnknownTypeError: No hash was given, and the type is not known.
    """

    def __init__(
        self, node: NodeBase, topic: str, type_name: str, type_hash: str | None, qos: QoSProfile
    ) -> None:
        self._node = node
        kind = EndpointKind.SUBSCRIPTION
        endpoint = node.endpoint(kind, type_name, topic, qos, type_hash)
        never_read = node.wire.types.message(_NEVER_READ)
        group = node.default_callback_group
        self._subscription = Subscription(endpoint, never_read, None, group, raw=True)
        node.add_work(self._subscription)

    @property
    def lost(self) -> int:
        """Messages that were sent and did not come here, or not in time."""
        losses = self._subscription.losses
        return losses.lost + losses.overwritten

    def wait_for(self, on_arrival: Callable[[], object]) -> None:
        """Have what comes be told at once, in another thread: `on_arrival` must be quick."""
        self._subscription.on_arrival = on_arrival
        self._node.context.drain.wait_for(self._subscription)

    def take(self) -> list[RawSample]:
        """Take what came since it was asked for last."""
        return self._subscription.take_all()

    def close(self) -> None:
        """Hear it no more."""
        self._node.remove_work(self._subscription)
