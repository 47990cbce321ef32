"""ROS 2 on the page: what goes out is switched at the joints, and a router that goes is said."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.messages import message
from tests.support.demos import heard, node_at
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, studio_page, wait_until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Locator

    from studio.ros.client import Node
    from studio.ros.wire.router import EmbeddedRouter
    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

JOINT = "mast_pan_joint"
STATES = "sensor_msgs/msg/JointState"
DISCONNECT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/ros.js", script))).disconnectRos();
}"""


@pytest.fixture
def router(place: str) -> Iterator[EmbeddedRouter]:
    with router_at(place) as made:
        yield made


@pytest.fixture(scope="module")
def place() -> str:
    return free_endpoint()


@pytest.fixture(scope="module")
def studio(place: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    words = ["demo", "--viewer-link", "--connect", place, "--router", "off"]
    with running_studio(words, tmp_path_factory.mktemp("studio") / "data") as running:
        yield running


@pytest.fixture(scope="module")
def opened(browser: Browser, studio: RunningStudio) -> Iterator[StudioPage]:
    with studio_page(browser, studio, view=False) as tab:
        yield tab


@pytest.fixture
def tab(opened: StudioPage) -> Iterator[StudioPage]:
    """A tab that is not connected, with the joints in front."""
    opened.page.get_by_role("tab", name="Joints").click()
    wait_until("nothing is connected", lambda: "not connected" in status(opened))
    yield opened
    opened.page.evaluate(DISCONNECT)
    assert opened.errors == []


def switch(tab: StudioPage, name: str) -> Locator:
    return tab.page.get_by_role("switch", name=name)


def source(tab: StudioPage) -> Locator:
    return tab.page.get_by_label("Joints are moved by")


def status(tab: StudioPage) -> str:
    return tab.page.locator(".ros-status").inner_text()


def position(tab: StudioPage) -> float:
    return float(tab.row(JOINT).get_by_role("textbox").input_value())


def teller(node: Node, position_rad: float) -> None:
    """Tell where a joint is, as long as the node lives."""
    kind = message(STATES)
    out = node.create_publisher(kind, "/joint_states", 10)
    node.create_timer(0.05, lambda: out.publish(kind(name=[JOINT], position=[position_rad])))


def test_the_robot_goes_out_joints_come_in_and_a_router_that_was_away_is_found_again(
    tab: StudioPage, router: EmbeddedRouter
):
    endpoint = router.endpoint.text
    with node_at(endpoint) as peer:
        descriptions = heard(peer, "std_msgs/msg/String", "/robot_description", LATCHED)
        switch(tab, "Publish the robot").click()
        wait_until("the description", lambda: bool(descriptions))
        wait_until("the peer is counted", lambda: "connected, 1 other node" in status(tab))
        on = switch(tab, "Publish the robot")
        wait_until("the switch is on", lambda: on.get_attribute("aria-checked") == "true")
        teller(peer, 0.75)
        source(tab).select_option("joint_states")
        wait_until("the joint follows", lambda: position(tab) == 0.75)
        wait_until("it is not ours", lambda: tab.row(JOINT).get_by_role("slider").is_disabled())
    router.close()
    wait_until("the page says so", lambda: "router gone" in status(tab))
    assert tab.page.get_by_role("alert").filter(has_text="The router was stopped").count() == 1
    with router_at(endpoint), node_at(endpoint) as peer:
        descriptions = heard(peer, "std_msgs/msg/String", "/robot_description", LATCHED)
        teller(peer, -0.5)
        wait_until("the joint follows again", lambda: position(tab) == -0.5)
        wait_until("the description is there again", lambda: bool(descriptions))
        wait_until("the page says so", lambda: "connected, 1 other node" in status(tab))
        source(tab).select_option("sliders")
        wait_until("it moves", lambda: tab.row(JOINT).get_by_role("slider").is_enabled())


def test_the_window_on_ros_says_where_and_a_viewer_sees_it_and_changes_nothing(
    browser: Browser, studio: RunningStudio, tab: StudioPage, router: EmbeddedRouter
):
    with node_at(router.endpoint.text, "somebody"):
        tab.page.locator(".ros-status").click()
        window = tab.page.get_by_role("dialog", name="ROS 2")
        connect = window.get_by_role("button", name="Connect", exact=True)
        disconnect = window.get_by_role("button", name="Disconnect")
        connect.click()
        window.get_by_text("/somebody").wait_for()
        disconnect.click()
        wait_until("it is left", lambda: "not connected" in status(tab))
        connect.click()
        window.get_by_text("/somebody").wait_for()
        assert router.endpoint.text in window.inner_text()
        tab.page.keyboard.press("Escape")
        assert studio.process.stdout is not None
        address = studio.process.stdout.readline().removeprefix("Viewer: ").strip()
        context = studio_context(browser)
        other = StudioPage(context.new_page())
        other.open(address, view=False)
        other.page.get_by_role("tab", name="Joints").click()
        wait_until("the viewer is told", lambda: "connected, 1 other node" in status(other))
        switches = (switch(other, "Publish the robot"), switch(other, "Publish the joints"))
        other.page.locator(".ros-status").click()
        theirs = other.page.get_by_role("button", name="Disconnect")
        assert all(one.is_disabled() for one in (*switches, source(other), theirs))
        context.close()
