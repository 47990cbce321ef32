"""Frames: the service /transform_point transforms a point from one frame to another, by /tf.

Try: `studio demos transform_point rover`, then `studio service call /transform_point
studio_interfaces/srv/TransformPoint "{point: {x: 1.0}, source_frame: laser_frame,
target_frame: map}"`, twice while the rover drives.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.errors import CdrError, FrameError
from studio.ros.client import DurabilityPolicy, Node, QoSProfile
from studio.ros.columns.transforms import TransformCodec
from studio.ros.messages.studio_interfaces.srv import TransformPoint
from studio.ros.messages.tf2_msgs.msg import TFMessage
from studio.tf.buffer import TransformBuffer
from studio.tf.rotations import compose


class TransformPointNode(Node):
    """Keeps the transforms of the last ten seconds, and answers out of the newest."""

    def __init__(self) -> None:
        super().__init__("transform_point")
        self.buffer, self.codec = TransformBuffer(), TransformCodec()
        kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(TFMessage, "/tf_static", self.static_callback, kept, raw=True)
        self.create_subscription(TFMessage, "/tf", self.tf_callback, 100, raw=True)
        self.create_service(TransformPoint, "transform_point", self.transform_callback)

    def static_callback(self, data: bytes) -> None:
        """Take up transforms that hold at all times."""
        self.tf_callback(data, static=True)

    def tf_callback(self, data: bytes, *, static: bool = False) -> None:
        """Take up transforms; an invalid one is logged, at most every ten seconds."""
        try:
            notices = self.buffer.put(self.codec.decode(data), static=static)
        except CdrError as error:
            self.get_logger().warn(str(error), throttle_duration_sec=10.0)
            return
        for notice in notices:
            self.get_logger().warn(notice.sentence, throttle_duration_sec=10.0)

    def transform_callback(
        self, request: TransformPoint.Request, response: TransformPoint.Response
    ) -> TransformPoint.Response:
        """Return the point in the target frame, or what is missing for it."""
        point, result = request.point, response.result
        try:
            wxyz, xyz, _ = self.buffer.fixed_from(request.target_frame, request.source_frame)
        except FrameError as error:
            response.success, response.message = False, str(error)
            return response
        moved = compose((*wxyz, *xyz), (1.0, 0.0, 0.0, 0.0, point.x, point.y, point.z))
        response.success = True
        result.x, result.y, result.z = moved[4:]
        return response


def main(args: list[str] | None = None) -> None:
    """Serve until stopped."""
    with until_stopped(args):
        rclpy.spin(TransformPointNode())


if __name__ == "__main__":
    main()
