"""Live displays on the page: added by topic, mended by a click, set in the tree, drawn in 3D."""

from __future__ import annotations

import math
import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import pytest

from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.messages import message
from tests.support.demos import node_at
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, studio_page, wait_until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, ViewportSize

    from studio.ros.client import Node
    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

TF = "tf2_msgs/msg/TFMessage"
POSE = "geometry_msgs/msg/PoseStamped"
SCAN = "sensor_msgs/msg/LaserScan"
SMALL: Final[ViewportSize] = {"width": 1000, "height": 600}
"""For the picture is drawn whenever a message comes."""
SCANS = re.compile(r"LaserScan, .scan · .+ Hz")
DISCONNECT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/ros.js", script))).disconnectRos();
}"""


def goal() -> Any:  # noqa: ANN401
    """A pose in a frame that hangs on another than the robot's."""
    one = message(POSE)()
    one.header.frame_id = "moon"
    one.pose.position.x, one.pose.position.z = 0.4, 0.5
    one.pose.orientation.w = 1.0
    return one


def space() -> Any:  # noqa: ANN401
    """What the frame of the pose hangs on."""
    one = message("geometry_msgs/msg/TransformStamped")(child_frame_id="moon")
    one.header.frame_id = "space"
    one.transform.rotation.w = 1.0
    return message(TF)(transforms=[one])


def scan() -> Any:  # noqa: ANN401
    """A wall all around the robot."""
    one = message(SCAN)(angle_min=-math.pi, angle_max=math.pi, angle_increment=math.pi / 30)
    one.header.frame_id = "base_link"
    one.range_min, one.range_max = 0.1, 10.0
    one.ranges = [0.8] * 60
    return one


@contextmanager
def told(endpoint: str) -> Generator[Node]:
    """A node that tells of a goal and of a wall, again and again."""
    with node_at(endpoint, "teller") as node:
        poses = node.create_publisher(message(POSE), "/goal", 10)
        scans = node.create_publisher(message(SCAN), "/scan", 10)
        node.create_publisher(message(TF), "/tf_static", LATCHED).publish(space())
        pose, wall = goal(), scan()

        def tell() -> None:
            for publisher, one in ((poses, pose), (scans, wall)):
                one.header.stamp = node.get_clock().now().to_msg()
                publisher.publish(one)

        node.create_timer(0.5, tell)
        yield node


@pytest.fixture
def endpoint() -> Generator[str]:
    with router_at(free_endpoint()) as router:
        yield router.endpoint.text


@pytest.fixture
def studio(endpoint: str, tmp_path: Path) -> Generator[RunningStudio]:
    words = ["demo", "--viewer-link", "--connect", endpoint, "--router", "off"]
    with running_studio(words, tmp_path / "data") as running:
        yield running


def add(tab: StudioPage, topic: str) -> None:
    """Add what shows a topic, by keys."""
    tab.page.get_by_role("button", name="Add", exact=True).click()
    window = tab.page.get_by_role("dialog", name="Add a display")
    connect = window.get_by_role("button", name="Connect", exact=True)
    offer = window.get_by_role("option").filter(has_text=topic)
    wait_until("topics, or a way to them", lambda: connect.count() + offer.count() > 0)
    if connect.count():
        connect.click()
    offer.filter(has_text="Hz").wait_for()
    window.get_by_role("searchbox").fill(topic)
    wait_until("one offer", lambda: window.get_by_role("option").count() == 1)
    said = window.get_by_role("option").inner_text()
    assert all(word in said for word in (topic, "/msg/", "Hz"))  # its type and rate
    window.get_by_role("searchbox").press("Enter")
    wait_until("the window to be gone", lambda: window.count() == 0)


def row(tab: StudioPage, name: str | re.Pattern[str]) -> Locator:
    return tab.page.get_by_role("treeitem", name=name)


def test_topics_are_added_mended_by_a_click_set_in_the_tree_and_seen_in_3d(
    browser: Browser, studio: RunningStudio, endpoint: str
):
    with told(endpoint), studio_page(browser, studio) as tab:
        tab.page.set_viewport_size(SMALL)
        alone = tab.plain_picture()
        add(tab, "/scan")
        wait_until("the rate of the scan", lambda: row(tab, SCANS).count() == 1)
        walled = tab.show_other_than(alone)
        hidden = row(tab, "LaserScan").get_by_role("button", name="Show LaserScan")
        hidden.click()
        plain = tab.show_other_than(walled)  # with the timeline below, so smaller than alone
        hidden.click()
        tab.show_again(walled)
        row(tab, "LaserScan").click()
        style = tab.page.get_by_role("combobox", name="LaserScan: Style")
        style.select_option("Spheres")
        size = tab.page.get_by_role("textbox", name="LaserScan: Size (m)")
        size.fill("0.2")
        size.press("Enter")
        thick = tab.show_other_than(walled)
        add(tab, "/goal")
        mend = tab.page.get_by_role("button", name="Draw everything in space")
        mend.click()
        frame = tab.page.get_by_role("textbox", name="Fixed frame")
        wait_until("the frame is shown", lambda: frame.input_value() == "space")
        tab.page.locator(".frame-trouble").wait_for()  # the robot has no place in it
        wait_until("the pose is drawn", lambda: row(tab, "Pose, /goal").count() == 1)
        tab.show_other_than(thick)
        row(tab, "LaserScan").click()  # its settings would stand between the two
        wait_until("settings are folded", lambda: style.count() == 0)
        drag_to_the_top(tab, "Pose, /goal")
        wait_until("the pose stands first", lambda: first_display(tab).startswith("Pose"))
        row(tab, "Pose, /goal").focus()
        tab.page.keyboard.press("Delete")
        wait_until("the row is gone", lambda: row(tab, "Pose, /goal").count() == 0)
        frame.fill("")
        frame.press("Enter")
        hidden.click()
        tab.show_again(plain)
        hidden.click()
        tab.show_other_than(plain)
        disconnected_and_back(tab, alone)
        assert tab.errors == []
        viewer_sees(browser, studio)


def drag_to_the_top(tab: StudioPage, name: str) -> None:
    """Drag a row by the mouse, as slowly as a hand does, above the first display."""
    mouse, first = tab.page.mouse, tab.page.locator("[id^='row-display:']").first
    first.scroll_into_view_if_needed()
    row(tab, name).scroll_into_view_if_needed()  # right below it, perhaps out of sight
    grip, goal = row(tab, name).bounding_box(), first.bounding_box()
    assert grip is not None
    assert goal is not None
    mouse.move(grip["x"] + 60, grip["y"] + grip["height"] / 2)
    mouse.down()
    for step in range(4, -1, -1):
        mouse.move(goal["x"] + 60 - step, goal["y"] + 3 + step)
    tab.page.locator(".drop-before").wait_for()
    mouse.up()


def first_display(tab: StudioPage) -> str:
    """What the first row of a live display says."""
    return tab.page.locator("[id^='row-display:']").first.get_attribute("aria-label") or ""


def disconnected_and_back(tab: StudioPage, plain: bytes) -> None:
    """What was drawn leaves the screen, and comes back by the one click that the row offers."""
    tab.page.evaluate(DISCONNECT)
    tab.show_again(plain)
    wait_until("the row says so", lambda: row(tab, "LaserScan, no connection").count() == 1)
    tab.page.locator(".live-remark").get_by_role("button", name="Connect", exact=True).click()
    tab.show_other_than(plain)


def viewer_sees(browser: Browser, studio: RunningStudio) -> None:
    """Whoever has no control sees the rows, and changes nothing."""
    assert studio.process.stdout is not None
    address = studio.process.stdout.readline().removeprefix("Viewer: ").strip()
    context = studio_context(browser)
    other = StudioPage(context.new_page())
    other.open(address, view=False)
    row(other, "LaserScan").click()
    style = other.page.get_by_role("combobox", name="LaserScan: Style")
    assert style.input_value() == "Spheres"
    assert style.is_disabled()
    assert other.page.get_by_role("button", name="Add", exact=True).is_disabled()
    assert other.page.get_by_role("button", name="Show LaserScan").is_disabled()
    assert other.page.get_by_role("textbox", name="Fixed frame").is_disabled()
    context.close()
