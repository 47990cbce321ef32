"""The Time panel: ROS time of /clock, pause and reset, with messages of a node."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.messages import message
from tests.support.demos import node_at
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

CLOCK = "rosgraph_msgs/msg/Clock"
POSE = "geometry_msgs/msg/PoseStamped"
ADD_POSE = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/live-displays.js", script))).addDisplay("Pose", "/aim");
}"""


class Teller:
    """Tells a time and a pose, again and again."""

    def __init__(self, node: Any) -> None:  # noqa: ANN401
        self.second = 500
        self._clock = node.create_publisher(message(CLOCK), "/clock", 10)
        self._poses = node.create_publisher(message(POSE), "/aim", 10)
        node.create_timer(0.05, self._tell)

    def _tell(self) -> None:
        tick, pose = message(CLOCK)(), message(POSE)()
        tick.clock.sec = self.second
        pose.header.frame_id = "base_link"
        pose.pose.orientation.w = 1.0
        self._clock.publish(tick)
        self._poses.publish(pose)


@contextmanager
def telling(endpoint: str) -> Generator[Teller]:
    with node_at(endpoint, "teller") as node:
        yield Teller(node)


def shows(tab: StudioPage, clock: str, text: str) -> Callable[[], bool]:
    return lambda: tab.page.locator(f"[data-clock={clock}]").inner_text() == text


def received(tab: StudioPage) -> int:
    """Messages that the row of the display's topic tells of."""
    text = tab.page.get_by_role("treeitem", name="messages received").get_attribute("aria-label")
    return int((text or "").split(", ")[1].split()[0].replace(",", ""))


def test_time_follows_the_clock_stands_in_a_pause_and_begins_anew_with_a_reset(
    browser: Browser, tmp_path: Path
):
    with (
        router_at(free_endpoint()) as router,
        telling(router.endpoint.text) as teller,
        running_studio(
            ["demo", "--connect", router.endpoint.text, "--router", "off"], tmp_path / "data"
        ) as studio,
    ):
        context = studio_context(browser)
        tab = StudioPage(context.new_page())
        tab.open(studio.url, view=False)
        tab.page.get_by_role("treeitem", name="Robot model").click()
        tab.page.evaluate(ADD_POSE)
        tab.page.get_by_role("treeitem", name=re.compile("^Pose,")).click()
        tab.page.get_by_role("treeitem", name="Status: Warn").wait_for()  # no stamp
        wait_until("messages", lambda: received(tab) > 20)
        tab.page.evaluate(SHOW_PANEL, "time")
        tab.page.keyboard.press("Control+Shift+Enter")  # so that both panels are seen
        tab.page.evaluate(SHOW_PANEL, "displays")
        wait_until("the clock's time", shows(tab, "ros", "500.00"))
        teller.second = 512
        wait_until("it has run", shows(tab, "ros_elapsed", "12.00"))
        pause_and_go_on(tab, teller)
        before = received(tab)
        tab.page.get_by_role("button", name="Reset", exact=True).click()
        wait_until("messages are counted anew", lambda: received(tab) < before)
        wait_until("so is the time", shows(tab, "ros_elapsed", "0.00"))
        assert tab.errors == []
        context.close()


def pause_and_go_on(tab: StudioPage, teller: Teller) -> None:
    """The time stands, messages come on, and the 3D view says so and ends it."""
    tab.page.get_by_role("button", name="Pause", exact=True).click()
    notice = tab.page.locator(".scene-hint.paused")
    notice.wait_for()
    teller.second = 530
    before = received(tab)
    wait_until("messages of the pause", lambda: received(tab) > before + 5)
    assert shows(tab, "ros", "512.00")()
    notice.get_by_role("button", name="Continue").wait_for()
    tab.page.locator(".time-panel").get_by_role("button", name="Continue").click()
    wait_until("the time of now", shows(tab, "ros", "530.00"))
