"""turtlesim and Jerry in panels of their own: drawn, driven, coloured, commanded and measured."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.messages import message
from studio.ros.types.convert import from_dict
from tests.support.demos import call, heard, node_at, running_demo
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from studio.ros.client import Node
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(600)]
FIELD_M = 11.088889
MINUS = "\N{MINUS SIGN}"
PEN = (179, 184, 255)
GROUND = (200, 120, 60)
PUB = (
    "ros2 topic pub --rate 10 /turtle1/cmd_vel geometry_msgs/msg/Twist "
    '"{linear: {x: 0.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}"'
)
_PIXEL = """(canvas, [across, down]) => {
  const copy = new OffscreenCanvas(1, 1).getContext("2d");
  const { width, height } = canvas;
  copy.drawImage(canvas, Math.floor(width * across), Math.floor(height * down), 1, 1, 0, 0, 1, 1);
  return [...copy.getImageData(0, 0, 1, 1).data].slice(0, 3);
}"""

_FOCUSED_WITH_HINT = """(button) => new Promise((resolve) => {
  const panel = button.closest(".panel-body");
  new MutationObserver((_, watch) => {
    if (!panel.querySelector(".turtle-hint")) return;
    watch.disconnect();
    resolve(document.activeElement.getAttribute("role"));
  }).observe(panel, { childList: true, subtree: true });
  button.focus();
  button.click();
})"""


class Turtles:
    """The panel, and what the turtle tells meanwhile to a node of its own."""

    def __init__(self, tab: StudioPage, node: Node) -> None:
        self.tab, self.page, self.node = tab, tab.page, node
        self.poses = heard(node, "turtlesim/msg/Pose", "/turtle1/pose")
        self.colors = heard(node, "turtlesim/msg/Color", "/turtle1/color_sensor")
        self.panel = shown(tab, "turtlesim")
        self.field = self.panel.get_by_role("application")

    @property
    def pose(self) -> Any:  # noqa: ANN401
        return self.poses[-1]

    def stand_on(self, color: tuple[int, int, int]) -> bool:
        """Whether it stood at one place for the last third of a second, and saw this there."""
        poses, colors = self.poses[-20:], self.colors[-20:]
        places = {(pose.x, pose.y) for pose in poses}
        return len(places) == 1 and all(is_near(colour_of(seen), color) for seen in colors)

    def pixel(self, x_m: float, y_m: float) -> tuple[int, ...]:
        """The colour that the page shows at a place of the field."""
        place = [x_m / FIELD_M, 1 - y_m / FIELD_M]
        return tuple(self.panel.locator("canvas").evaluate(_PIXEL, place))


def shown(tab: StudioPage, name: str) -> Locator:
    tab.page.evaluate(SHOW_PANEL, name)
    found = tab.page.locator(f"section.panel-body[aria-label='{name.title()}']")
    found.wait_for()
    return found


def is_near(found: tuple[int, ...], wanted: tuple[int, ...]) -> bool:
    return all(abs(one - other) < 24 for one, other in zip(found, wanted, strict=True))


def p1_the_ground_takes_the_colour_of_the_parameters(turtles: Turtles) -> None:
    turtles.panel.get_by_label("Background").fill("#c81e3c")
    wait_until("the node has it", lambda: turtles.colors[-1].r == 200)
    wait_until("the ground shows it", lambda: turtles.pixel(1, 1) == (200, 30, 60))
    values = {"name": "background_g", "value": {"type": 2, "integer_value": 120}}
    parameter = from_dict(message("rcl_interfaces/msg/Parameter"), values)
    kind = "rcl_interfaces/srv/SetParameters"
    call(turtles.node, kind, "/turtlesim/set_parameters", parameters=[parameter])
    wait_until("that of another, too", lambda: turtles.pixel(1, 1) == GROUND)


def n10_the_arrow_keys_drive_it_and_it_draws(turtles: Turtles) -> None:
    start_m = turtles.pose.x
    turtles.field.focus()
    turtles.page.keyboard.down("ArrowUp")
    wait_until("it drives", lambda: turtles.pose.x > start_m + 1.5)
    turtles.page.keyboard.up("ArrowUp")
    wait_until("it stands", lambda: turtles.pose.linear_velocity == 0.0)
    y_m = turtles.pose.y
    wait_until("its line", lambda: is_near(turtles.pixel(start_m + 0.4, y_m), PEN))
    assert turtles.pixel(start_m - 1.2, y_m) == GROUND
    # Nobody tells of it: the turtle stands on bare ground where it stood, for a while, on its line.
    wait_until("it has stood on its line", lambda: turtles.stand_on(PEN))
    call(turtles.node, "std_srvs/srv/Empty", "/clear")
    wait_until("the line is gone", lambda: turtles.pixel(start_m + 0.4, y_m) == GROUND)


def it_is_dragged_to_another_place(turtles: Turtles) -> None:
    box = turtles.field.bounding_box()
    assert box is not None
    metre = box["width"] / FIELD_M

    def pointer_to(x_m: float, y_m: float) -> None:
        x, y = box["x"] + x_m * metre, box["y"] + (FIELD_M - y_m) * metre
        turtles.page.mouse.move(x, y, steps=4)

    pointer_to(turtles.pose.x, turtles.pose.y)
    turtles.page.mouse.down()
    pointer_to(2.0, 9.0)
    turtles.page.mouse.up()
    wait_until("it is there", lambda: math.dist((turtles.pose.x, turtles.pose.y), (2, 9)) < 0.1)


def colour_of(color: Any) -> tuple[int, int, int]:  # noqa: ANN401
    return color.r, color.g, color.b


def t2_the_slides_yaml_turns_it(turtles: Turtles) -> None:
    before_rad = turtles.pose.theta
    publish = shown(turtles.tab, "publish")
    publish.get_by_role("searchbox").fill(PUB)
    publish.get_by_role("button", name="10 times a second").click()
    wait_until("it turns", lambda: abs(turtles.pose.theta - before_rad) > 0.5)
    publish.get_by_role("button", name="Stop", exact=True).last.click()


def sv4_a_second_turtle_appears(turtles: Turtles) -> None:
    shown(turtles.tab, "turtlesim")
    button = turtles.panel.get_by_role("button", name="New turtle")
    wait_until("it is served", button.is_enabled)
    assert button.evaluate(_FOCUSED_WITH_HINT) == "application"
    turtles.panel.get_by_text("Click where the new turtle should appear").wait_for()
    turtles.page.keyboard.press("Enter")
    second = turtles.panel.get_by_role("button", name=re.compile("^turtle2"))
    second.get_by_text("x 5.54 · y 5.54").wait_for()
    wait_until("it is chosen", lambda: second.get_attribute("aria-pressed") == "true")


def j1_jerry_follows_a_command_and_the_distance_is_right(tab: StudioPage) -> None:
    panel = shown(tab, "jerry")
    panel.get_by_role("button", name="Start jerry_robot").click()
    panel.get_by_text("Jerry is at (0, 0)").wait_for()
    panel.get_by_label("Steps").fill("3")
    panel.get_by_role("button", name="Forward").click()
    panel.get_by_text("Jerry is at (3, 0)").wait_for()
    panel.get_by_role("application").focus()
    tab.page.keyboard.press("ArrowLeft")
    panel.get_by_text("Jerry is at (3, 3)").wait_for()
    panel.get_by_label("x", exact=True).fill("6")
    panel.get_by_label("y", exact=True).fill("-1")
    panel.get_by_role("button", name="How far?").click()
    panel.get_by_text("√((6 - 3)² + (-1 - 3)²) = 5".replace("-", MINUS), exact=True).wait_for()
    panel.get_by_text("exact", exact=True).wait_for()


@pytest.mark.sweep
def test_turtles_and_jerry_are_drawn_and_do_what_their_panels_say(browser: Browser, tmp_path: Path):
    with (
        running_router() as router,
        running_studio(
            ["demo", "--connect", router, "--router", "off"], tmp_path / "data"
        ) as studio,
        node_at(router) as node,
        studio_page(browser, studio, view=False) as tab,
    ):
        connect(tab)
        shown(tab, "turtlesim").get_by_text("No turtlesim is running here.").wait_for()
        with running_demo(router, "turtlesim_node"):
            turtles = Turtles(tab, node)
            turtles.panel.get_by_text("x 5.54 · y 5.54 · 0° · 0.0 m/s").wait_for()
            p1_the_ground_takes_the_colour_of_the_parameters(turtles)
            n10_the_arrow_keys_drive_it_and_it_draws(turtles)
            it_is_dragged_to_another_place(turtles)
            t2_the_slides_yaml_turns_it(turtles)
            sv4_a_second_turtle_appears(turtles)
        turtles.panel.get_by_text("No turtlesim is running here.").wait_for()
        j1_jerry_follows_a_command_and_the_distance_is_right(tab)
        assert tab.errors == []
