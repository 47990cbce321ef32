"""Robots of other processes in viser's own scene: R2D2 goes its round, the rover drives by walls.

What the engine makes of their topics is proved without a browser in tests/course.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pytest

from studio.course.rover.room import clearance_m
from studio.ros.messages import message
from tests.support.demos import heard, node_at, running, running_demo
from tests.support.scene_nodes import points_below, poses_below
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router
from tests.support.wired_studio import TF

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

    from numpy.typing import NDArray
    from playwright.sync_api import Browser, ViewportSize

    from studio.ros.client import Node
    from tests.support.server import RunningStudio
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(600)]

SMALL: Final[ViewportSize] = {"width": 1000, "height": 600}
"""For the picture is drawn all the time."""
R2D2 = Path(__file__).parents[2] / "models" / "r2d2_description" / "urdf" / "r2d2.urdf.xacro"
TOPIC = "/r2d2/robot_description"
_PATIENCE_S = 120.0
_MAY_DRIVE_OUT = "the robot may drive out of it"


class Scene:
    """What viser's page has in its scene, and what is asked of the studio."""

    def __init__(self, tab: StudioPage, studio: RunningStudio) -> None:
        self._tab, self._studio = tab, studio
        self._added = 0

    def add(self, kind: str, topic: str) -> str:
        """Add a display; the root of what it draws."""
        command = {"type": "add_display", "document": "rover", "kind": kind, "topic": topic}
        with self._studio.client() as client:
            answer = client.post("/api/commands", content=json.dumps(command))
            answer.raise_for_status()
        displays = self._tab.page.get_by_role("treeitem", name=f"{kind}, {topic}")
        wait_until(f"the row of {kind}", lambda: displays.count() == 1, _PATIENCE_S)
        self._added += 1
        return f"/live/d{self._added}"

    def draw_in(self, frame: str) -> None:
        """Choose the fixed frame on the page."""
        box = self._tab.page.get_by_role("textbox", name="Fixed frame")
        box.fill(frame)
        box.press("Enter")

    def poses(self, root: str) -> dict[str, NDArray[np.float64]]:
        """x, y, z in m and w, x, y, z of each node that is seen there, by its name."""
        return poses_below(self._tab.page, root)

    def points(self, root: str) -> NDArray[np.float64]:
        """Shape (N, 3), m."""
        return points_below(self._tab.page, root)

    def different(self, root: str, link: str, count: int) -> list[dict[str, NDArray[np.float64]]]:
        """All poses at several moments, between which one link moved."""
        seen: list[dict[str, NDArray[np.float64]]] = []

        def moved() -> bool:
            poses = self.poses(root)
            if link in poses and (not seen or np.abs(poses[link] - seen[-1][link]).max() > 1e-3):
                seen.append(poses)
            return len(seen) >= count

        wait_until(f"{link} to move", moved, _PATIENCE_S)
        return seen


@pytest.fixture
def endpoint() -> Generator[str]:
    with running_router() as found:
        yield found


@pytest.fixture
def studio(endpoint: str, tmp_path: Path) -> Generator[RunningStudio]:
    """The rover on its way, and a studio that looks at it."""
    words = ["demo", "--connect", endpoint, "--router", "off"]
    with running_studio(words, tmp_path / "data", moving=True) as found:
        yield found


@contextmanager
def r2d2(endpoint: str, folder: Path) -> Generator[None]:
    """Its state publisher and the one that tells of its links, as the course starts them."""
    urdf = folder / "r2d2.urdf"
    line = ["studio", "xacro", str(R2D2), "stands:=false", "-o", str(urdf)]
    subprocess.run([sys.executable, "-m", *line], check=True)
    named = [
        "--ros-args",
        "-r",
        "__node:=r2d2_state_publisher",
        "-r",
        f"robot_description:={TOPIC}",
    ]
    module = "studio.nodes.robot_state_publisher"
    with (
        running([sys.executable, "-m", module, str(urdf), *named], endpoint),
        running_demo(endpoint, "state_publisher"),
    ):
        yield


def published(told: Sequence[Any], pose: NDArray[np.float64]) -> bool:
    """Whether a pose of `axis` in `odom` is one of those that were sent, to 1e-6."""
    for one in [each for sent in tuple(told) for each in sent.transforms]:
        if (one.header.frame_id, one.child_frame_id) == ("odom", "axis"):
            at, turn = one.transform.translation, one.transform.rotation
            sent = np.array([at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z])
            if np.abs(sent - pose).max() <= 1e-6:
                return True
    return False


def cosine_between(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Of half the angle between two turns; 1: they are the same."""
    return abs(float(one[3:] @ other[3:]))


def is_on_walls(points: NDArray[np.float64]) -> bool:
    """Whether nine of ten are nearer than 10 cm to a wall or post."""
    off_m = [clearance_m(x, y) for x, y, _ in points[:: max(1, len(points) // 60)]]
    return len(off_m) > 20 and float(np.quantile(off_m, 0.9)) < 0.1


def driven(node: Node) -> Callable[[], None]:
    """Drives the rover once in a while, until what is given back is called."""
    wheel = node.create_publisher(message("geometry_msgs/msg/Twist"), "/cmd_vel", 10)
    twist = message("geometry_msgs/msg/Twist")()
    twist.linear.x, twist.angular.z = 0.3, 0.5
    timer = node.create_timer(0.1, lambda: wheel.publish(twist))
    return timer.cancel


@pytest.mark.sweep
def test_r2d2_goes_its_round_and_the_scan_of_the_rover_lies_on_the_walls(
    browser: Browser, studio: RunningStudio, endpoint: str, tmp_path: Path
):
    with (
        r2d2(endpoint, tmp_path),
        node_at(endpoint) as node,
        studio_page(browser, studio) as tab,
    ):
        tab.page.set_viewport_size(SMALL)
        told, scene = heard(node, TF, "/tf", 1000), Scene(tab, studio)
        robot = scene.add("RobotModel", TOPIC)
        goes_round_in_odom(scene, robot, told)
        offers_to_follow(tab, "odom", "Dismiss")
        stands_still_in_axis(scene, robot)
        scan_lies_on_the_walls(scene, node)
        offers_to_follow(tab, "map", "Follow base_footprint")
        tab.page.get_by_role("button", name="The camera follows base_footprint").wait_for()
        scene.draw_in("odom")
        wait_until("the robot in odom", lambda: "robot" in scene.poses(""), _PATIENCE_S)
        assert not tab.page.get_by_text(_MAY_DRIVE_OUT).is_visible()
        assert tab.errors == []


def offers_to_follow(tab: StudioPage, frame: str, answer: str) -> None:
    """Once, where the fixed frame is none of the robot's."""
    offer = tab.page.locator(".scene-hint", has_text=f"The view is fixed to {frame}")
    offer.get_by_role("button", name=answer).click(timeout=1000 * _PATIENCE_S)
    wait_until("the offer to go", lambda: offer.count() == 0)


def is_on_its_round(poses: dict[str, NDArray[np.float64]]) -> bool:
    return "axis" in poses and abs(math.hypot(*poses["axis"][:2]) - 2.0) < 1e-3


def goes_round_in_odom(scene: Scene, robot: str, told: Sequence[Any]) -> None:
    scene.draw_in("odom")
    wait_until("the robot to be seen from odom", lambda: is_on_its_round(scene.poses(robot)))
    seen = scene.different(robot, "axis", 5)
    for poses in seen:
        x, y, z = poses["axis"][:3]
        assert (math.hypot(x, y), z) == pytest.approx((2.0, 0.7))
        pose = poses["axis"]
        wait_until("the pose that was sent", lambda pose=pose: published(told, pose))


def stands_still_in_axis(scene: Scene, robot: str) -> None:
    """The robot as a whole stands still, and each of its joints moves."""
    scene.draw_in("axis")
    still = np.array([0, 0, 0, 1, 0, 0, 0])
    wait_until(
        "axis to be where all is seen from",
        lambda: np.array_equal(scene.poses(robot).get("axis", np.zeros(7)), still),
        _PATIENCE_S,
    )
    seen = scene.different(robot, "head", 5)
    assert all(np.array_equal(poses["axis"], still) for poses in seen)
    assert all(
        np.allclose(poses["left_leg"], seen[0]["left_leg"], rtol=0, atol=1e-6) for poses in seen
    )
    for poses, later in pairwise(seen):
        assert cosine_between(poses["head"], later["head"]) < 1 - 1e-6
    scene.different(robot, "body", 3)  # tilts
    lengths = [
        float(np.linalg.norm(poses["periscope_tube"][:3] - poses["head"][:3]))
        for poses in scene.different(robot, "periscope_tube", 5)
    ]
    assert max(lengths) - min(lengths) > 1e-3


def scan_lies_on_the_walls(scene: Scene, node: Node) -> None:
    """At several moments of a drive, as the page has its points.

    viser's page takes a pose at once and points a moment later, so that a look may fall between.
    """
    scan = scene.add("LaserScan", "/scan")
    scene.draw_in("map")
    wait_until("the robot in the map", lambda: "robot" in scene.poses(""), _PATIENCE_S)
    stop, begin = driven(node), scene.poses("")["robot"]
    for driven_m in (0.0, 0.1, 0.2, 0.3):
        wait_until(
            f"the rover to have driven {driven_m} m",
            lambda far=driven_m: math.dist(begin[:2], scene.poses("")["robot"][:2]) >= far,
            _PATIENCE_S,
        )
        wait_until("the scan on the walls", lambda: is_on_walls(scene.points(scan)), _PATIENCE_S)
    stop()
