"""The log on the wire: what a node says, published on /rosout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import DestroyedError
from studio.ros.duration import NANOSECONDS
from studio.ros.node.logger import listen_to

if TYPE_CHECKING:
    from studio.ros.node.logger import Entry
    from studio.ros.node.node import Node
    from studio.ros.qos import QoSProfile

ROSOUT = "/rosout"


class RosoutPublisher:
    """Publishes what a node and its parts say, until it is stopped."""

    def __init__(self, node: Node, qos: QoSProfile | int) -> None:
        self._log = node.wire.types.message("rcl_interfaces/msg/Log")
        self._stamp = node.wire.types.message("builtin_interfaces/msg/Time")
        self._publisher = node.create_publisher(self._log, ROSOUT, qos)
        self.stop = listen_to(node.get_logger().name, self._publish)

    def _publish(self, entry: Entry) -> None:
        seconds, rest_ns = divmod(entry.time_ns, NANOSECONDS)
        said = self._log(
            stamp=self._stamp(sec=seconds, nanosec=rest_ns),
            level=int(entry.severity),
            name=entry.name,
            msg=_sendable(entry.text),
            file=entry.file,
            function=entry.function,
            line=entry.line,
        )
        try:
            self._publisher.publish(said)
        except DestroyedError:
            self.stop()


def _sendable(text: str) -> str:
    """Replace what UTF-8 has no bytes for, such as in names of files: a log never fails."""
    return text.encode(errors="replace").decode()
