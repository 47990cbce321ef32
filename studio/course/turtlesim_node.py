"""turtlesim: turtles that walk by Twist messages and draw where they go.

Try: `studio demos turtlesim_node`, then `studio run turtlesim turtle_teleop_key`, or
`studio topic pub --rate 1 /turtle1/cmd_vel geometry_msgs/msg/Twist
"{linear: {x: 2.0}, angular: {z: 1.8}}"`, `studio topic echo /turtle1/pose`,
`studio service call /spawn turtlesim/srv/Spawn "{x: 2, y: 2, theta: 0.2, name: ''}"`,
`studio param set /turtlesim background_r 150`, `studio action send_goal --feedback
/turtle1/rotate_absolute turtlesim/action/RotateAbsolute "{theta: 1.57}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.course.turtlesim.endpoints import TurtleEndpoints
from studio.course.turtlesim.turtles import MIDDLE_M, STEP_S, Flock
from studio.ros.client import MultiThreadedExecutor, Node
from studio.ros.messages.rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from studio.ros.messages.std_srvs.srv import Empty
from studio.ros.messages.turtlesim.srv import Kill, Spawn

THREADS = 32
"""Each turtle that rotates takes one."""
BACKGROUND = {"background_r": 69, "background_g": 86, "background_b": 255}


class TurtleSim(Node):
    """The ground and its turtles."""

    def __init__(self) -> None:
        super().__init__("turtlesim")
        for name, value in BACKGROUND.items():
            byte = IntegerRange(from_value=0, to_value=255, step=1)
            self.declare_parameter(name, value, ParameterDescriptor(integer_range=[byte]))
        self.flock = Flock()
        self.endpoints: dict[str, TurtleEndpoints] = {}
        self.create_service(Empty, "clear", self.on_clear)
        self.create_service(Empty, "reset", self.on_reset)
        self.create_service(Spawn, "spawn", self.on_spawn)
        self.create_service(Kill, "kill", self.on_kill)
        self.create_timer(STEP_S, self.on_step)
        self.spawn(MIDDLE_M, MIDDLE_M, 0.0)

    def spawn(self, x: float, y: float, theta: float, name: str = "") -> str:
        """Put one more turtle on the ground; an empty name where that cannot be."""
        turtle = self.flock.spawn(x, y, theta, name)
        if turtle is None:
            self.get_logger().error(f"There is a turtle {name!r}, or no room for one more.")
            return ""
        self.endpoints[turtle.name] = TurtleEndpoints(self, self.flock, turtle)
        place = f"x=[{turtle.x:.6f}], y=[{turtle.y:.6f}], theta=[{turtle.theta:.6f}]"
        self.get_logger().info(f"Spawning turtle [{turtle.name}] at {place}")
        return turtle.name

    def on_step(self) -> None:
        """Walk on, and publish the poses."""
        for turtle in self.flock.step():
            where = f"[x={turtle.x:.6f}, y={turtle.y:.6f}]"
            self.get_logger().warn(f"Oh no! I hit the wall! {where}", throttle_duration_sec=1.0)
        red, green, blue = (self.get_parameter(name).value for name in BACKGROUND)
        for endpoints in self.endpoints.values():
            endpoints.publish((red, green, blue))

    def on_clear(self, request: Empty.Request, response: Empty.Response) -> Empty.Response:
        """Wipe the lines; the turtles stay."""
        self.flock.paper.clear()
        return response

    def on_reset(self, request: Empty.Request, response: Empty.Response) -> Empty.Response:
        """Begin again, with one turtle in the middle."""
        for name in list(self.endpoints):
            self.endpoints.pop(name).destroy()
        self.flock.clear()
        self.spawn(MIDDLE_M, MIDDLE_M, 0.0)
        return response

    def on_spawn(self, request: Spawn.Request, response: Spawn.Response) -> Spawn.Response:
        """Answer with the name that the turtle got."""
        response.name = self.spawn(request.x, request.y, request.theta, request.name)
        return response

    def on_kill(self, request: Kill.Request, response: Kill.Response) -> Kill.Response:
        """Take a turtle off the ground; what it drew stays."""
        if request.name not in self.endpoints:
            self.get_logger().error(f"There is no turtle {request.name!r}.")
            return response
        self.flock.turtles.pop(request.name)
        self.endpoints.pop(request.name).destroy()
        return response


def main(args: list[str] | None = None) -> None:
    """Run until stopped; rotations take threads of their own."""
    with until_stopped(args):
        rclpy.spin(TurtleSim(), executor=MultiThreadedExecutor(THREADS))


if __name__ == "__main__":
    main()
