"""A student's own node, who has pasted the line of their window into its terminal."""

from __future__ import annotations

import time

from studio.ros.messages import message
from studio.ros.node.context import Context
from studio.ros.node.executors import SingleThreadedExecutor
from studio.ros.node.node import Node
from studio.ros.wire.session import open_wire
from studio.ros.wire.settings import wire_settings

STRING = "std_msgs/msg/String"


def variables(line: str) -> dict[str, str]:
    """What a shell makes of the line."""
    assert line.startswith("export ")
    pairs = line.removeprefix("export ").removesuffix("'").split("' ")
    return {name: value for name, _, value in (pair.partition("='") for pair in pairs)}


class OwnNode:
    """A node that has a publisher of /temperature; to be closed."""

    def __init__(self, line: str, name: str) -> None:
        settings = wire_settings(environment=variables(line))
        self.context = Context.over(open_wire(settings, "off"), owns_wire=True)
        self.node = Node(name, context=self.context)
        self.out = self.node.create_publisher(message(STRING), "/temperature", 10)

    def spin(self, duration_s: float) -> None:
        """Carry out the node's work for a while."""
        executor = SingleThreadedExecutor(context=self.context)
        executor.add_node(self.node)
        end_s = time.monotonic() + duration_s
        while (left_s := end_s - time.monotonic()) > 0:
            executor.spin_once(timeout_sec=left_s)
        executor.remove_node(self.node)

    def close(self) -> None:
        self.context.shutdown()
