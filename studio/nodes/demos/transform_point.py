"""Frames: the service /transform_point tells a point of one frame in another, out of /tf.

Try: `studio demos transform_point rover`, then `studio service call /transform_point
studio_interfaces/srv/TransformPoint "{point: {x: 1.0}, source_frame: laser_frame,
target_frame: map}"`, twice while the rover drives.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.errors import FrameError, TransformError
from studio.nodes.demos.running import until_stopped
from studio.ros.client import DurabilityPolicy, Node, QoSProfile
from studio.ros.messages.studio_interfaces.srv import TransformPoint
from studio.ros.messages.tf2_msgs.msg import TFMessage
from studio.tf.tree import TransformTree


class TransformPointNode(Node):
    """Keeps the newest transform of each frame, and answers out of them."""

    def __init__(self) -> None:
        super().__init__("transform_point")
        self.tree = TransformTree()
        kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(TFMessage, "/tf_static", self.tf_callback, kept)
        self.create_subscription(TFMessage, "/tf", self.tf_callback, 100)
        self.create_service(TransformPoint, "transform_point", self.transform_callback)

    def tf_callback(self, msg: TFMessage) -> None:
        """Take up transforms; what is none is said once in ten seconds."""
        for one in msg.transforms:
            place, turn = one.transform.translation, one.transform.rotation
            xyz, xyzw = (place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w)
            try:
                self.tree.put(one.header.frame_id, one.child_frame_id, xyz, xyzw)
            except TransformError as error:
                self.get_logger().warn(str(error), throttle_duration_sec=10.0)

    def transform_callback(
        self, request: TransformPoint.Request, response: TransformPoint.Response
    ) -> TransformPoint.Response:
        """Tell the point in the target frame, or what is missing for it."""
        point = request.point
        try:
            matrix = self.tree.target_from_source(request.target_frame, request.source_frame)
        except FrameError as error:
            response.success, response.message = False, str(error)
            return response
        moved = matrix @ (point.x, point.y, point.z, 1.0)
        response.success = True
        response.result.x, response.result.y, response.result.z = (float(v) for v in moved[:3])
        return response


def main(args: list[str] | None = None) -> None:
    """Serve until stopped."""
    with until_stopped(args):
        rclpy.spin(TransformPointNode())


if __name__ == "__main__":
    main()
