"""The course's rows on RViz: V1, with the rover and R2D2 in processes of their own."""

from __future__ import annotations

import asyncio
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.course.rover.room import clearance_m
from studio.displays.catalogue import DISPLAYS
from studio.displays.drawing import Points
from studio.protocol.displays import AddDisplay, GetTf, SetDisplayProperty, SetFixedFrame
from studio.ros.messages import message
from tests.support.demos import heard, node_at, running_demo
from tests.support.display_samples import BASE, SAMPLES
from tests.support.open_documents import until
from tests.support.told_samples import told
from tests.support.wired_studio import TF, Studio, studio

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from tests.support.display_samples import Sample

pytestmark = pytest.mark.network

OF_THE_ROVER = {"DisplayTrajectory", "JointTrajectory"}
"""Their samples move joints that the robot of these tests has not."""
TOPICS = {
    "LaserScan": "/scan",
    "Path": "/plan",
    "Map": "/map",
    "Odometry": "/odom",
    "Imu": "/imu",
    "MarkerArray": "/markers",
    "Image": "/camera/image_raw",
    "RobotModel": "/robot_description",
    "TF": "",
    "Axes": "",
    "Grid": "",
}


async def add(one: Studio, kind: str, topic: str = "") -> str:
    await one.do(AddDisplay(kind=kind, topic=topic))
    return one.ear.last("live_displays")["displays"][-1]["id"]


def shapes_of(one: Studio, display: str) -> int:
    shown = one.document.live.shown(display)
    return sum(len(placed.shapes) for path, placed in shown.drawing.items() if shown.poses[path])


def remarks_of(one: Studio, display: str) -> list[str]:
    told = [event for event in one.ear.events if event["type"] == "display_states"]
    states: list[dict[str, Any]] = told[-1]["states"] if told else []
    return [
        said["sentence"] for each in states if each["id"] == display for said in each["remarks"]
    ]


def points_in_fixed(one: Studio, display: str) -> NDArray[np.floating]:
    """All points of a display, shape (N, 3), m."""
    shown = one.document.live.shown(display)
    found = [np.empty((0, 3))]
    for path, placed in shown.drawing.items():
        if pose := shown.poses[path]:
            (w, x, y, z), at = pose
            turn = np.array([x, y, z])
            for shape in placed.shapes.values():
                if isinstance(shape, Points):
                    points = shape.positions.astype(float)
                    across = 2 * np.cross(turn, points)
                    found.append(points + w * across + np.cross(turn, across) + at)
    return np.concatenate(found)


def test_v1_each_display_draws_its_topic_of_the_moving_graph(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            displays = {kind: await add(one, kind, topic) for kind, topic in TOPICS.items()}
            await one.do(SetFixedFrame(frame="map"))
            await all_drawn(one, displays)

    with running_demo(endpoint, "rover"):
        asyncio.run(run())


def test_v1_every_display_draws_its_sample_that_a_node_tells(endpoint: str, tmp_path: Path):
    async def run() -> None:
        async with studio(endpoint, tmp_path) as one:
            displays = {sample.name: await show(one, sample) for sample in samples}
            await one.do(SetFixedFrame(frame=BASE))
            await all_drawn(one, displays)

    all_kinds = {one.kind: one for one in reversed(SAMPLES)}
    assert all_kinds.keys() == {one.KIND for one in DISPLAYS}
    samples = [one for one in all_kinds.values() if one.kind not in OF_THE_ROVER]
    with told(endpoint, samples):
        asyncio.run(run())


async def show(one: Studio, sample: Sample) -> str:
    display = await add(one, sample.kind, sample.topic)
    for name, value in sample.values.items():
        await one.do(SetDisplayProperty(display=display, name=name, value=value))
    return display


async def all_drawn(one: Studio, displays: dict[str, str]) -> None:
    for name, display in displays.items():
        try:
            await until(lambda display=display: shapes_of(one, display) > 0)
        except TimeoutError:
            pytest.fail(f"{name}: {remarks_of(one, display)}")


def test_v1_the_scan_lies_on_the_walls_of_the_room_while_the_rover_is_driven(
    endpoint: str, tmp_path: Path
):
    async def run(cart: Any) -> None:  # noqa: ANN401
        async with studio(endpoint, tmp_path) as one:
            scan = await add(one, "LaserScan", "/scan")
            await one.do(SetFixedFrame(frame="map"))
            await until(lambda: shapes_of(one, scan) > 0)
            before = await place(one)
            command = message("geometry_msgs/msg/Twist")()
            command.linear.x, command.angular.z = 0.3, 0.5
            seen = 0
            while seen < 5 or math.dist(before, await place(one)) < 0.3:
                cart.publish(command)
                await asyncio.sleep(0.1)
                points = points_in_fixed(one, scan)
                off_m = [clearance_m(x, y) for x, y, _ in points[:: max(1, len(points) // 60)]]
                assert len(off_m) > 20
                assert np.quantile(off_m, 0.9) < 0.1
                seen += 1

    async def place(one: Studio) -> list[float]:
        await one.do(GetTf(frame="base_footprint", seen_from="map"))
        pose = one.ear.last("tf_frames")["pose"]
        return pose["xyz"]

    with running_demo(endpoint, "rover"), node_at(endpoint) as tester:
        cart = tester.create_publisher(message("geometry_msgs/msg/Twist"), "/cmd_vel", 10)
        asyncio.run(run(cart))


def test_v1_r2d2_goes_round_in_odom_as_it_publishes_and_stands_still_in_axis(
    endpoint: str, tmp_path: Path
):
    async def run(told: list[Any]) -> None:
        async with studio(endpoint, tmp_path) as one:
            await one.do(SetFixedFrame(frame="odom"))
            places: set[tuple[float, ...]] = set()
            while len(places) < 5:
                await one.do(GetTf(frame="axis", seen_from="odom"))
                if pose := one.ear.last("tf_frames")["pose"]:
                    await until(lambda pose=pose: is_published(pose, told))
                    places.add(tuple(pose["xyz"]))
                await asyncio.sleep(0.05)
            await one.do(SetFixedFrame(frame="axis"))
            await one.do(GetTf(frame="axis", seen_from="axis"))
            assert one.ear.last("tf_frames")["pose"]["xyz"] == [0.0, 0.0, 0.0]

    with running_demo(endpoint, "state_publisher"), node_at(endpoint) as tester:
        asyncio.run(run(heard(tester, TF, "/tf", 1000)))


def is_published(pose: dict[str, Any], told: list[Any]) -> bool:
    """Whether a pose is one of those that were published, to 1e-6."""
    for each in [transform for one in tuple(told) for transform in one.transforms]:
        if each.child_frame_id == "axis":
            at, turn = each.transform.translation, each.transform.rotation
            sent = (at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z)
            if np.allclose(sent, (*pose["xyz"], *pose["wxyz"]), rtol=0, atol=1e-6):
                return True
    return False
