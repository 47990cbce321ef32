"""SplitEvents: tells other nodes when playing goes from one file of a bag to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.bags.recording import Split
    from studio.ros.client import Node

_TOPIC: Final = "events/read_split"
_TYPE: Final = "rosbag2_interfaces/msg/ReadSplitEvent"


class SplitEvents:
    """Publishes the splits of a bag, named and typed as rosbag2's player does.

    rosbag2 tells as soon as it reads a file, ahead of what it plays; here each comes just before
    the first message that is played of that file or a later one.
    """

    def __init__(self, node: Node, splits: Sequence[Split]) -> None:
        self._node, self._splits = node, splits
        self._kind = node.wire.types.message(_TYPE)
        self._publisher = node.create_publisher(self._kind, _TOPIC, 1)
        self._told = 0

    def restart(self) -> None:
        """Begin again with the first file."""
        self._told = 0

    def tell_until(self, at_ns: int) -> None:
        """Tell the splits up to a time, since the Unix epoch, that were not told yet."""
        while self._told < len(self._splits) and self._splits[self._told].begin_ns <= at_ns:
            _, closed, opened = self._splits[self._told]
            event = self._kind(closed_file=str(closed), opened_file=str(opened))
            if hasattr(event, "node_name"):  # since Jazzy
                event.node_name = self._node.get_fully_qualified_name()
            self._told += 1
            self._publisher.publish(event)

    def close(self) -> None:
        """Publish no more."""
        self._node.destroy_publisher(self._publisher)
