"""TurtleEndpoints: the topics, services and the action of one turtle."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import studio.ros.client as rclpy
from studio.course.turtlesim.turtles import Pen, Turtle, within_a_turn
from studio.ros.action import ActionServer, CancelResponse
from studio.ros.client import Node, ReentrantCallbackGroup
from studio.ros.messages.geometry_msgs.msg import Twist
from studio.ros.messages.turtlesim.action import RotateAbsolute
from studio.ros.messages.turtlesim.msg import Color, Pose
from studio.ros.messages.turtlesim.srv import SetPen, TeleportAbsolute, TeleportRelative

if TYPE_CHECKING:
    from studio.course.turtlesim.turtles import Flock
    from studio.ros.action import ServerGoalHandle

_FEEDBACK_S = 0.05


class TurtleEndpoints:
    """Publishers, subscription and servers of one turtle; `destroy` removes them all."""

    def __init__(self, node: Node, flock: Flock, turtle: Turtle) -> None:
        self._node, self._flock, self._turtle = node, flock, turtle
        name = turtle.name
        self._pose = node.create_publisher(Pose, f"{name}/pose", 10)
        self._color = node.create_publisher(Color, f"{name}/color_sensor", 10)
        self._twist = node.create_subscription(Twist, f"{name}/cmd_vel", self._on_twist, 10)
        self._services = [
            node.create_service(SetPen, f"{name}/set_pen", self._on_set_pen),
            node.create_service(TeleportAbsolute, f"{name}/teleport_absolute", self._on_absolute),
            node.create_service(TeleportRelative, f"{name}/teleport_relative", self._on_relative),
        ]
        self._rotate = ActionServer(
            node,
            RotateAbsolute,
            f"{name}/rotate_absolute",
            self._on_rotate,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )
        self._rotating: ServerGoalHandle | None = None

    def publish(self, background: tuple[int, int, int]) -> None:
        """Publish the turtle's pose, and the colour below it."""
        turtle = self._turtle
        pose = Pose(x=turtle.x, y=turtle.y, theta=turtle.theta)
        pose.linear_velocity = turtle.forward_m_s
        pose.angular_velocity = turtle.turn_rad_s
        self._pose.publish(pose)
        red, green, blue = self._flock.color_below(turtle, background)
        self._color.publish(Color(r=red, g=green, b=blue))

    def destroy(self) -> None:
        """Remove all endpoints; a rotation that is running ends."""
        self._turtle.goal_theta = None
        self._rotate.destroy()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_subscription(self._twist)
        self._node.destroy_publisher(self._color)
        self._node.destroy_publisher(self._pose)

    def _on_twist(self, msg: Twist) -> None:
        if self._turtle.goal_theta is not None:
            self._node.get_logger().warn(
                "Velocity command received during rotation goal. Aborting goal"
            )
        self._turtle.command(msg.linear.x, msg.linear.y, msg.angular.z)

    def _on_set_pen(self, request: SetPen.Request, response: SetPen.Response) -> SetPen.Response:
        color = (request.r, request.g, request.b)
        self._turtle.pen = Pen(color, request.width, is_down=not request.off)
        return response

    def _on_absolute(
        self, request: TeleportAbsolute.Request, response: TeleportAbsolute.Response
    ) -> TeleportAbsolute.Response:
        start = (self._turtle.x, self._turtle.y)
        self._turtle.teleport(request.x, request.y, request.theta)
        self._draw_from(start)
        return response

    def _on_relative(
        self, request: TeleportRelative.Request, response: TeleportRelative.Response
    ) -> TeleportRelative.Response:
        start = (self._turtle.x, self._turtle.y)
        self._turtle.teleport_ahead(request.linear, request.angular)
        self._draw_from(start)
        return response

    def _draw_from(self, start: tuple[float, float]) -> None:
        self._flock.paper.draw(start, (self._turtle.x, self._turtle.y), self._turtle.pen)

    def _on_rotate(self, goal_handle: ServerGoalHandle) -> RotateAbsolute.Result:
        """Turn until the heading is reached; a command, a cancel or another goal ends it before."""
        turtle, start, log = self._turtle, self._turtle.theta, self._node.get_logger()
        if turtle.goal_theta is not None:
            log.warning(
                "Rotation goal received before a previous goal finished. Aborting previous goal"
            )
        self._rotating = goal_handle
        wanted = turtle.goal_theta = within_a_turn(goal_handle.request.theta)
        while self._is_turning(goal_handle, wanted) and rclpy.ok():
            goal_handle.publish_feedback(RotateAbsolute.Feedback(remaining=turtle.remaining_rad))
            time.sleep(_FEEDBACK_S)
        result = RotateAbsolute.Result(delta=start - turtle.theta)
        if goal_handle.is_cancel_requested:
            if self._rotating is goal_handle:
                turtle.goal_theta, turtle.turn_rad_s = None, 0.0
            log.info("Rotation goal canceled")
            goal_handle.canceled()
        elif turtle.theta == wanted:
            log.info("Rotation goal completed successfully")
            goal_handle.succeed()
        else:
            goal_handle.abort()
        return result

    def _is_turning(self, goal_handle: ServerGoalHandle, wanted: float) -> bool:
        """Whether the turtle still turns for this goal, and nobody asked to cancel it."""
        is_current = self._rotating is goal_handle and self._turtle.goal_theta == wanted
        return is_current and not goal_handle.is_cancel_requested
