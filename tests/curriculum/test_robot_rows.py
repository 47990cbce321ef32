"""The course's rows on robots that move: J1, D7's node, D10, P2 and V3's rover."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.ros.client import DurabilityPolicy, Node, QoSProfile, message, qos_profile_sensor_data
from studio.ros.types.convert import from_yaml
from studio.tf.rotations import compose, matrices_from_poses
from tests.support.demos import call, heard, node_at, running_demo
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.network
KEPT = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TURNED = math.sin(math.pi / 8), math.cos(math.pi / 8)


def speaker(node: Node, type_name: str, topic: str) -> Callable[[str], None]:
    """Publishes YAML on a topic that somebody listens to."""
    kind = message(type_name)
    publisher = node.create_publisher(kind, topic, 10)
    wait_until(f"who listens to {topic}", lambda: bool(node.graph.subscriptions(topic)))
    return lambda text: publisher.publish(from_yaml(kind, text))


def test_j1_jerrys_position_follows_commands_and_the_distance_is_exact(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "jerry_robot") as jerry:
        poses = heard(node, "geometry_msgs/msg/Point", "/jerry/pose", KEPT)
        say = speaker(node, "pkg_with_interfaces/msg/JerryCommand", "/jerry_command")
        place = (0.0, 0.0)
        for direction, steps, moved in (
            ("forward", 5, (5, 0)),
            ("left", 3, (0, 3)),
            ("backward", 2, (-2, 0)),
            ("right", 7, (0, -7)),
        ):
            say(f"{{direction: {direction}, steps: {steps}}}")
            place = (place[0] + moved[0], place[1] + moved[1])
            wait_until(str(place), lambda: bool(poses) and (poses[-1].x, poses[-1].y) == place)  # noqa: B023
        answer = call(node, "pkg_with_interfaces/srv/Distance", "/distance", x=-1.5, y=2.25)
        assert answer.distance == math.hypot(-1.5 - 3.0, 2.25 + 4.0)
        say("{direction: up, steps: 1}")
        jerry.wait_for("I cannot go 1 steps 'up'.")
        assert (poses[-1].x, poses[-1].y) == (3.0, -4.0)


def test_j1_the_commander_and_the_client_keep_jerry_busy(endpoint: str):
    with (
        running_demo(endpoint, "jerry_robot") as jerry,
        running_demo(endpoint, "jerry_command_publisher"),
        running_demo(endpoint, "jerry_client") as client,
    ):
        jerry.wait_for(": at (")
        client.wait_for("m away from Jerry")


def test_d7_r2d2_tells_joints_and_its_place_thirty_times_a_second(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "state_publisher"):
        states = heard(node, "sensor_msgs/msg/JointState", "/joint_states")
        transforms = heard(node, "tf2_msgs/msg/TFMessage", "/tf")

        def rate_hz() -> float:
            if len(states) < 91:
                return 0.0
            first, last = (stamp_s(state.header.stamp) for state in (states[-91], states[-1]))
            return 90 / (last - first)

        wait_until("some seconds of it", lambda: rate_hz() == pytest.approx(30.0, rel=0.1))
        wait_until("its place", lambda: bool(transforms))
        assert states[0].name == ["swivel", "tilt", "periscope"]
        moved = transforms[-1].transforms[0]
        assert (moved.header.frame_id, moved.child_frame_id) == ("odom", "axis")
        place = moved.transform.translation
        assert math.hypot(place.x, place.y) == pytest.approx(2.0)


def test_d10_a_point_of_one_frame_is_told_in_another(endpoint: str):
    tf = "tf2_msgs/msg/TFMessage"
    with node_at(endpoint) as node, running_demo(endpoint, "transform_point"):
        z, w = TURNED
        speaker(node, tf, "/tf")(
            "{transforms: [{header: {frame_id: map}, child_frame_id: base, transform: "
            f"{{translation: {{x: 1.0, y: 2.0}}, rotation: {{z: {z!r}, w: {w!r}}}}}}}]}}"
        )
        speaker(node, tf, "/tf_static")(
            "{transforms: [{header: {frame_id: base}, child_frame_id: laser, transform: "
            "{translation: {x: 0.5, z: 0.3}, rotation: {w: 1.0}}}]}"
        )
        point = message("geometry_msgs/msg/Point")(x=2.0, y=-1.0, z=0.25)

        def asked(source: str, target: str) -> Any:  # noqa: ANN401
            service = "studio_interfaces/srv/TransformPoint"
            return call(
                node,
                service,
                "/transform_point",
                point=point,
                source_frame=source,
                target_frame=target,
            )

        wait_until("both are known", lambda: asked("laser", "map").success)
        result = asked("laser", "map").result
        cosine = math.cos(math.pi / 4)
        wanted = (1.0 + cosine * (2.5 + 1.0), 2.0 + cosine * (2.5 - 1.0), 0.55)
        assert (result.x, result.y, result.z) == pytest.approx(wanted, abs=1e-9)
        missing = asked("laser", "moon")
        assert not missing.success
        assert (
            missing.message == 'No transform tells of the frame "moon": is its publisher running?'
        )


def test_p2_a_speed_below_zero_is_refused_with_the_reason(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "parameter_node") as demo:
        demo.wait_for("Robot name: turtlebot")
        kind = message("rcl_interfaces/msg/Parameter")
        parameter = kind(name="max_velocity")
        parameter.value.type = 3
        results: list[tuple[bool, str]] = []
        for value in (0.5, -1.5):
            parameter.value.double_value = value
            service = "rcl_interfaces/srv/SetParameters"
            answer = call(node, service, "/parameter_node/set_parameters", parameters=[parameter])
            results.append((answer.results[0].successful, answer.results[0].reason))
        assert results == [(True, ""), (False, "max_velocity is below zero")]
        demo.wait_for("Parameter max_velocity changed to 0.5")


def test_the_rover_tells_all_of_itself_and_the_room(endpoint: str):
    topics = {
        "/joint_states": "sensor_msgs/msg/JointState",
        "/odom": "nav_msgs/msg/Odometry",
        "/imu": "sensor_msgs/msg/Imu",
        "/scan": "sensor_msgs/msg/LaserScan",
        "/camera/image_raw": "sensor_msgs/msg/Image",
        "/camera/camera_info": "sensor_msgs/msg/CameraInfo",
        "/plan": "nav_msgs/msg/Path",
        "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    }
    with node_at(endpoint) as node, running_demo(endpoint, "rover"):
        told = {
            name: heard(node, kind, name, qos_profile_sensor_data) for name, kind in topics.items()
        }
        told["/map"] = heard(node, "nav_msgs/msg/OccupancyGrid", "/map", KEPT)
        told["/markers"] = heard(node, "visualization_msgs/msg/MarkerArray", "/markers", KEPT)
        wait_until("all topics", lambda: all(told.values()))
        scan, image, grid = told["/scan"][-1], told["/camera/image_raw"][-1], told["/map"][-1]
        assert len(scan.ranges) == 360
        assert ((scan.ranges > scan.range_min) & (scan.ranges < scan.range_max)).all()
        assert len(image.data) == image.height * image.step
        assert len(grid.data) == grid.info.width * grid.info.height
        assert set(grid.data.tolist()) == {-1, 0, 100}
        assert told["/diagnostics"][-1].status[0].name == "rover: battery"


def test_the_rovers_scan_fits_its_map(endpoint: str):
    """Beams, placed by /tf and the rover's own offsets, end where the map is taken."""
    with node_at(endpoint) as node, running_demo(endpoint, "rover"):
        grids = heard(node, "nav_msgs/msg/OccupancyGrid", "/map", KEPT)
        odometry = heard(node, "nav_msgs/msg/Odometry", "/odom")
        scans = heard(node, "sensor_msgs/msg/LaserScan", "/scan", qos_profile_sensor_data)
        wait_until("all three", lambda: bool(grids and odometry and len(scans) > 3))
        scan, grid = scans[-1], grids[-1]
        wait_until(
            "an odometry as new",
            lambda: stamp_s(odometry[-1].header.stamp) >= stamp_s(scan.header.stamp),
        )
        nearest = min(
            odometry, key=lambda one: abs(stamp_s(one.header.stamp) - stamp_s(scan.header.stamp))
        )
        pose = nearest.pose.pose
        place, turn = pose.position, pose.orientation
        map_from_base = turn.w, turn.x, turn.y, turn.z, place.x, place.y, 0.0
        map_from_laser = compose(map_from_base, (1.0, 0.0, 0.0, 0.0, -0.02, 0.05, 0.0))
        angles = scan.angle_min + np.arange(360) * scan.angle_increment
        ends = np.stack(
            [scan.ranges * np.cos(angles), scan.ranges * np.sin(angles), 0 * angles, 0 * angles + 1]
        )
        x, y = (matrices_from_poses(np.array([map_from_laser]))[0] @ ends)[:2]
        columns = ((x - grid.info.origin.position.x) / grid.info.resolution).astype(int)
        rows = ((y - grid.info.origin.position.y) / grid.info.resolution).astype(int)
        cells = grid.data.reshape(grid.info.height, grid.info.width)
        near = np.max(
            [np.roll(cells, (up, right), (0, 1)) for up in (-1, 0, 1) for right in (-1, 0, 1)],
            axis=0,
        )
        assert np.count_nonzero(near[rows, columns] == 100) > 0.97 * 360


def test_cmd_vel_takes_the_wheel_of_the_rover(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "rover") as rover:
        odometry = heard(node, "nav_msgs/msg/Odometry", "/odom")
        wait_until(
            "it drives by itself",
            lambda: bool(odometry) and odometry[-1].twist.twist.linear.x > 0.2,
        )
        drive = speaker(node, "geometry_msgs/msg/Twist", "/cmd_vel")

        def turns_on_the_spot() -> bool:
            drive("{angular: {z: 1.0}}")
            speeds = odometry[-1].twist.twist
            return speeds.angular.z > 0.9 and abs(speeds.linear.x) < 0.01

        wait_until("it turns on the spot", turns_on_the_spot)
        rover.wait_for("Somebody drives.")
        wait_until("the command wears off", lambda: odometry[-1].twist.twist.angular.z == 0.0)
        rover.wait_for("on my way again")


def test_the_rover_tells_its_model_and_its_links_until_somebody_else_does(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "rover") as rover:
        described = heard(node, "std_msgs/msg/String", "/robot_description", KEPT)
        moving = heard(node, "tf2_msgs/msg/TFMessage", "/tf", 100)
        wait_until("the model", lambda: bool(described))
        assert '<robot name="rover">' in described[0].data
        wait_until(
            "a wheel's place",
            lambda: any(
                one.child_frame_id == "front_left_wheel" for msg in moving for one in msg.transforms
            ),
        )
        other = node.create_publisher(message("std_msgs/msg/String"), "/robot_description", KEPT)
        rover.wait_for("Another node publishes the robot's description.")
        wait_until("it has left", lambda: tellers(node) == ["tester"])
        node.destroy_publisher(other)
        wait_until("it is back", lambda: "robot_state_publisher" in tellers(node))


def tellers(node: Node) -> list[str]:
    return [one.node_name for one in node.graph.publishers("/robot_description")]


def stamp_s(stamp: Any) -> float:  # noqa: ANN401
    return stamp.sec + stamp.nanosec / 1e9
