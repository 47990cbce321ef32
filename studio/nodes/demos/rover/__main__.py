"""`python -m studio.nodes.demos.rover`: the rover, until it is stopped."""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.nodes.demos.rover.node import RoverNode
from studio.nodes.demos.running import until_stopped


def main(args: list[str] | None = None) -> None:
    """Drive until stopped."""
    with until_stopped(args):
        rclpy.spin(RoverNode())


if __name__ == "__main__":
    main()
