"""Points adder: the service /add_points.

Try: `studio demos add_points_server add_points_client`, or
`studio service call /add_points pkg_with_interfaces/srv/AddPoints "{a: {x: 1.0}, b: {x: 2.0}}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.pkg_with_interfaces.srv import AddPoints


class AddPointsServiceServerNode(Node):
    """Serves sums of points."""

    def __init__(self) -> None:
        super().__init__("add_points_service_server")
        self.service_server = self.create_service(
            srv_type=AddPoints, srv_name="/add_points", callback=self.add_points_service_callback
        )
        self.service_server_call_count: int = 0

    def add_points_service_callback(
        self, request: AddPoints.Request, response: AddPoints.Response
    ) -> AddPoints.Response:
        """Add two points, coordinate by coordinate."""
        response.result.x = request.a.x + request.b.x
        response.result.y = request.a.y + request.b.y
        response.result.z = request.a.z + request.b.z
        self.service_server_call_count += 1
        return response


def main(args: list[str] | None = None) -> None:
    """Serve until stopped."""
    with until_stopped(args):
        rclpy.spin(AddPointsServiceServerNode())


if __name__ == "__main__":
    main()
