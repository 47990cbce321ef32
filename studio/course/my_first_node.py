"""The smallest node: it is there, and does nothing.

Try: `studio run my_py_pkg test_node`, then `studio node list` and `studio node info /my_node_name`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node


class MyFirstNode(Node):
    """Has a name, and what every node has."""

    def __init__(self) -> None:
        super().__init__("my_node_name")


def main(args: list[str] | None = None) -> None:
    """Run until stopped."""
    with until_stopped(args):
        rclpy.spin(MyFirstNode())


if __name__ == "__main__":
    main()
