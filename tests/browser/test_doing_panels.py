"""What a person does in ROS 2 from the page: calls, goals, parameters, messages; clicks counted."""

from __future__ import annotations

import re
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from studio.ros.messages import service
from tests.support.demos import call, heard, node_at, running_demo
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.ros2_peer import real_node, real_nodes
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from studio.ros.client import Node
    from tests.support.server import RunningStudio
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

CALL = 'ros2 service call /add_two_ints example_interfaces/srv/AddTwoInts "{a: 41, b: 1}"'
WHAT_PLAYS = "ros2 service call /get_now_playing radio_station_interfaces/srv/GetNowPlaying {}"
STATION = (
    "station_name\nRadio Educativa 100.3 FM",
    "song_title\nBohemian Rhapsody",
    "artist_name\nQueen",
)
PUB = (
    "ros2 topic pub --rate 20 /turtle1/cmd_vel geometry_msgs/msg/Twist "
    '"{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"'
)
ADD_POINTS = "pkg_with_interfaces/srv/AddPoints"
REAL_ROBOT = """<robot name="real"><link name="base_link"><visual>
  <geometry><box size="3 3 0.1"/></geometry>
  <material name="red"><color rgba="1 0 0 1"/></material>
</visual></link></robot>"""
_ADD_DISPLAY = """async ([kind, topic]) => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/live-displays.js", script))).addDisplay(kind, topic);
}"""
STEPS = ("--ros-args", "-p", "step_seconds:=2.0")
"""So slow that a busy page sees a song between its beginning and its end."""


@pytest.fixture
def router() -> Iterator[str]:
    with running_router() as endpoint:
        yield endpoint


@pytest.fixture
def studio(router: str, tmp_path: Path) -> Iterator[RunningStudio]:
    place = ["--connect", router, "--router", "off"]
    with running_studio(["demo", *place], tmp_path / "data") as running:
        yield running


class Hand:
    """A person's hand in one panel, which counts clicks and keys."""

    def __init__(self, tab: StudioPage, panel: str, title: str) -> None:
        self.page, self.count = tab.page, 0
        self.page.evaluate(SHOW_PANEL, panel)
        self.panel = self.page.locator(f"section.operations[aria-label='{title}']")

    def click(self, at: Locator) -> None:
        at.click()
        self.count += 1

    def press(self, name: str) -> None:
        self.click(self.panel.get_by_role("button", name=name, exact=True).last)

    def paste(self, text: str) -> None:
        """Into the box over the list, which has the focus after a click."""
        self.click(self.panel.get_by_role("searchbox"))
        self.page.evaluate("(text) => navigator.clipboard.writeText(text)", text)
        self.page.keyboard.press("Control+V")
        self.count += 1

    def see(self, text: str | re.Pattern[str]) -> None:
        self.panel.locator(".operations-chosen").get_by_text(text).first.wait_for()


def call_a_service(tab: StudioPage, line: str, *reply: str) -> None:
    hand = Hand(tab, "services", "Services")
    hand.paste(line)
    hand.press("Call")
    rows = hand.panel.locator(".value-row")
    wait_until("its answer", lambda: tuple(rows.all_inner_texts()) == reply)
    hand.see("Answered in")
    assert hand.count <= 3
    hand.press("Back to the list")


@contextmanager
def slow_points(router: str) -> Generator[None]:
    """A server of sums that takes its time: until it is told to."""
    answer = threading.Event()

    def add(_: object, response: object) -> object:
        answer.wait()
        return response

    with node_at(router, "slow") as server:
        server.create_service(service(ADD_POINTS), "/slow_points", add)
        try:
            yield
        finally:
            answer.set()


def cancel_a_call(tab: StudioPage, router: str) -> None:
    """And the panel goes on to be of use."""
    hand = Hand(tab, "services", "Services")
    with slow_points(router):
        hand.paste(f"ros2 service call /slow_points {ADD_POINTS} {{}}")
        hand.press("Call")
        hand.press("Cancel")
        hand.see("Cancelled after")
        hand.press("Back to the list")
    call_a_service(tab, CALL, "sum\n42")


def send_and_cancel_a_goal(tab: StudioPage) -> None:
    hand = Hand(tab, "actions", "Actions")
    hand.click(hand.panel.get_by_role("button", name="/choose_song"))
    hand.panel.get_by_role("textbox", name="song_name").fill("Clocks")
    hand.press("Send goal")
    hand.see(re.compile(r"^[1-9]\d* %$"))
    hand.press("Cancel")
    hand.see("Cancelled after")
    assert hand.count <= 4
    hand.see("Stopped Clocks")
    hand.panel.get_by_role("textbox", name="song_name").fill("")
    hand.press("Send goal")
    hand.see("Rejected by its server")


def set_parameters(tab: StudioPage, node: Node) -> None:
    def red() -> int:
        kind = "rcl_interfaces/srv/GetParameters"
        answer = call(node, kind, "/turtlesim/get_parameters", names=["background_r"])
        return answer.values[0].integer_value

    hand = Hand(tab, "parameters", "Parameters")
    hand.press("/turtlesim")
    box = hand.panel.get_by_role("textbox", name="background_r")
    box.fill("200")
    box.press("Enter")
    wait_until("turtlesim has it", lambda: red() == 200)
    box.fill("900")
    box.press("Enter")
    hand.see("Parameter background_r out of range. Min: 0, Max: 255, value: 900")
    wait_until("the box shows what is", lambda: box.input_value() == "200")


def publish_as_pasted(tab: StudioPage, node: Node) -> None:
    twists = heard(node, "geometry_msgs/msg/Twist", "/turtle1/cmd_vel")
    hand = Hand(tab, "publish", "Publish")
    hand.paste(PUB)
    hand.press("20 times a second")
    wait_until("twists", lambda: len(twists) > 3)
    tab.page.evaluate(SHOW_PANEL, "services")  # what is published is seen from any panel
    tab.page.get_by_role("button", name="Publishing /turtle1/cmd_vel at 20 Hz").click()
    hand.press("Stop publishing (20 Hz)")
    hand.see("stopped after")
    hand.panel.get_by_role("button", name="20 times a second").wait_for()
    assert {(one.linear.x, one.angular.z) for one in twists} == {(2.0, 1.8)}


def send_a_goal(tab: StudioPage) -> None:
    hand = Hand(tab, "actions", "Actions")
    hand.panel.get_by_role("textbox", name="song_name").fill("Yellow")
    hand.press("Send goal")
    hand.see("Playing Yellow")


def test_sv1_sv2_sv3_a1_a2_p1_p2_t2_what_is_done_from_the_page_and_what_is_in_the_way(
    browser: Browser, studio: RunningStudio, router: str
):
    with (
        running_demo(router, "service_server_node"),
        running_demo(router, "now_playing_server"),
        running_demo(router, "turtlesim_node"),
        node_at(router) as node,
        studio_page(browser, studio, view=False) as tab,
    ):
        tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        tab.page.evaluate(SHOW_PANEL, "services")
        tab.page.get_by_role("button", name="Connect", exact=True).click()
        with running_demo(router, "radio_dj", *STEPS):
            call_a_service(tab, CALL, "sum\n42")
            call_a_service(tab, WHAT_PLAYS, *STATION)
            cancel_a_call(tab, router)
            send_and_cancel_a_goal(tab)
            set_parameters(tab, node)
            publish_as_pasted(tab, node)
            send_a_goal(tab)
        Hand(tab, "actions", "Actions").see("ended before the goal did")
        assert tab.errors == []


def test_panels_and_displays_show_what_real_nodes_do(
    browser: Browser, studio: RunningStudio, router: str
):
    with (
        real_node(router, "server", "--step", "0.1") as server,
        real_nodes(router) as real,
        studio_page(browser, studio) as tab,
    ):
        server.wait_said("ready")
        tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        tab.page.evaluate(SHOW_PANEL, "services")
        tab.page.get_by_role("button", name="Connect", exact=True).click()
        call_a_service(tab, CALL, "sum\n42")
        have_a_goal_of_a_real_server_cancelled(tab)
        refuse_a_parameter_of_a_real_node(tab)
        tab.page.evaluate(SHOW_PANEL, "log")
        tab.page.locator("section.log").get_by_text("add 41 + 1").first.wait_for()
        plain = tab.plain_picture()
        real.ask("publish", topic="/real_robot", qos="reliable transient_local", data=[REAL_ROBOT])
        tab.page.evaluate(_ADD_DISPLAY, ["RobotModel", "/real_robot"])
        tab.show_other_than(plain)
        assert tab.errors == []
        server.kill()


def have_a_goal_of_a_real_server_cancelled(tab: StudioPage) -> None:
    hand = Hand(tab, "actions", "Actions")
    hand.click(hand.panel.get_by_role("button", name="/fibonacci"))
    order = hand.panel.get_by_role("textbox", name="order")
    order.fill("4")
    hand.press("Send goal")
    hand.see("Succeeded")
    order.fill("45")
    hand.press("Send goal")
    hand.see(re.compile("0, 1, 1"))
    hand.press("Cancel")
    hand.see("Cancelled after")


def refuse_a_parameter_of_a_real_node(tab: StudioPage) -> None:
    hand = Hand(tab, "parameters", "Parameters")
    hand.press("/peer_server")
    box = hand.panel.get_by_role("textbox", name="ranged")
    box.fill("50")
    box.press("Enter")
    hand.see("Parameter ranged out of range. Min: 1, Max: 10, value: 50")
    wait_until("the box shows what is", lambda: box.input_value() == "5")
