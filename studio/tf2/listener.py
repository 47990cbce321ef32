"""TransformListener: fills a buffer with what comes on /tf and /tf_static."""

from __future__ import annotations

import threading
from functools import partial
from typing import TYPE_CHECKING, Any

from studio.errors import CdrError, ExternalShutdownException
from studio.ros.duration import Duration
from studio.ros.node.clock import JumpThreshold
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.work import ReentrantCallbackGroup
from studio.ros.qos import DurabilityPolicy, QoSProfile

if TYPE_CHECKING:
    from studio.ros.node.clock import TimeJump
    from studio.ros.node.node import Node
    from studio.tf2.buffer import Buffer

_DEPTH = 100
_PAUSE_S = 10.0


class TransformListener:
    """Subscribes by a node; with `spin_thread`, a thread of its own spins that node.

    When the node's clock goes back, as with a bag that begins again, what is newer is forgotten.
    """

    def __init__(  # noqa: PLR0913  # as in tf2_ros
        self,
        buffer: Buffer,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = "/tf",
        static_topic: str = "/tf_static",
        static_only: bool = False,
    ) -> None:
        self.buffer, self.node = buffer, node
        self.group = ReentrantCallbackGroup()
        kind: Any = node.context.wire.types.message("tf2_msgs/msg/TFMessage")
        latched = QoSProfile(depth=_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)

        def listen(topic: str, profile: QoSProfile | int, *, static: bool) -> Any:  # noqa: ANN401
            take = partial(self._take, static=static)
            return node.create_subscription(
                kind, topic, take, profile, callback_group=self.group, raw=True
            )

        self.tf_sub = (
            None if static_only else listen(tf_topic, _DEPTH if qos is None else qos, static=False)
        )
        self.tf_static_sub = listen(
            static_topic, latched if static_qos is None else static_qos, static=True
        )
        back = JumpThreshold(min_backward=Duration(nanoseconds=-1), on_clock_change=False)
        self._jumps = node.get_clock().create_jump_callback(back, post_callback=self._jumped)
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(node)
            self.dedicated_listener_thread = threading.Thread(
                target=self._spin, name="tf2 listener", daemon=True
            )
            self.dedicated_listener_thread.start()

    def unregister(self) -> None:
        """Listen no more."""
        self._jumps.unregister()
        for one in (self.tf_sub, self.tf_static_sub):
            if one is not None:
                self.node.destroy_subscription(one)

    def _spin(self) -> None:
        try:
            self.executor.spin()
        except ExternalShutdownException:
            return

    def _jumped(self, jump: TimeJump) -> None:
        """Forget what is told of times to come, as tf2 does when a simulation or bag goes back."""
        now_ns = self.node.get_clock().now_ns()
        self.node.get_logger().warning("Detected jump back in time. Clearing TF buffer.")
        self.buffer.jump_back(now_ns, now_ns - jump.delta.nanoseconds)

    def _take(self, data: bytes, *, static: bool) -> None:
        try:
            notices = self.buffer.take_message(data, static=static)
        except CdrError as error:
            notices = (str(error),)
        for sentence in notices:
            self.node.get_logger().warning(sentence, throttle_duration_sec=_PAUSE_S)
