"""The window on ROS 2: robots on DDS behind a bridge, and what to type to have one met."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from tests.support.dds_bridge import DdsNetwork
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from playwright.sync_api import Browser, Locator

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]
DENIED = {"deny": {"publishers": ["/odom", "/scan"]}, "pub_max_frequencies": ["/tf=5"]}


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    with router_at(free_endpoint()) as router:
        yield router.endpoint.text


@pytest.fixture(scope="module")
def network() -> Iterator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


@pytest.fixture(scope="module")
def tab(
    browser: Browser, network: DdsNetwork, endpoint: str, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[StudioPage]:
    words = ["demo", "--connect", endpoint, "--router", "off"]
    with (
        running_studio(words, tmp_path_factory.mktemp("studio") / "data") as studio,
        studio_page(browser, studio, view=False) as made,
    ):
        yield made
        assert made.errors == []


@contextmanager
def window_of(tab: StudioPage) -> Generator[Locator]:
    tab.page.locator(".ros-status").click()
    window = tab.page.get_by_role("dialog", name="ROS 2")
    try:
        yield window
    finally:
        window.get_by_role("button", name="Close").click()


def test_a_bridge_without_nodes_is_said_and_one_with_a_robot_names_it_and_what_it_keeps_back(
    tab: StudioPage, network: DdsNetwork, endpoint: str
):
    bridge = network.bridge(connect=endpoint, namespace="/robot1", config=DENIED)
    with window_of(tab) as window:
        report = window.get_by_role("status", name="Test result")
        report.get_by_text("but no DDS node is seen behind it").wait_for()
        report.get_by_text("start the bridge on the robot itself").wait_for()
        robot = network.robot("classroom")
        window.get_by_role("button", name="Connect", exact=True).click()
        window.get_by_text("/robot1, version 1.10.0: 3 nodes", exact=False).wait_for()
        kept = window.get_by_text("Not let through, by its deny list")
        wait_until("both are named", lambda: "/robot1/odom, /robot1/scan" in kept.inner_text())
        window.get_by_text("/tf (5 Hz)").wait_for()
        node = window.locator(".ros-nodes li", has_text="/robot1/driver")
        assert node.locator(".dds-tag").inner_text() == "DDS · robot1"
        report.get_by_text("3 nodes are running in domain 0").wait_for()
    robot.end()
    bridge.end()


def test_a_bridge_of_another_domain_offers_to_switch_to_it(
    tab: StudioPage, network: DdsNetwork, endpoint: str
):
    bridge, robot = network.bridge(connect=endpoint, domain=5), network.robot("classroom", domain=5)
    with window_of(tab) as window:
        window.get_by_text("It passes on DDS domain 5").first.wait_for()
        window.get_by_role("button", name="Switch to domain 5").first.click()
        window.locator(".ros-nodes li", has_text="/driver").wait_for()
    robot.end()
    bridge.end()


def test_each_situation_of_a_robot_has_its_line(tab: StudioPage):
    with window_of(tab) as window:
        window.get_by_text("How to prepare a robot").click()
        choice = window.get_by_label("Your robot")
        for situation, line in (
            ("there", "zenoh-bridge-ros2dds"),
            ("many", "zenoh-bridge-ros2dds -n /robot1 --ros-localhost-only -e tcp/STUDIO:7447"),
            ("humble", "ROS_DISTRO=humble zenoh-bridge-ros2dds"),
            ("bag", "studio open FOLDER"),
            ("zenoh", "ros2 run rmw_zenoh_cpp rmw_zenohd"),
        ):
            choice.select_option(situation)
            window.locator(".ros-recipes code").get_by_text(line, exact=True).wait_for()
