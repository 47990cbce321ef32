"""The panels about a ROS 2 system: joined in another domain, read, drawn, and given a new type."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.ros.client import Node
from studio.ros.messages import message
from tests.support.demos import node_at
from tests.support.managed_arm import managed_arm
from tests.support.node_pair import context_at
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import free_endpoint, running_router

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.managed_arm import Arm
    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(600)]
STRING = message("std_msgs/msg/String")
IMAGE = message("sensor_msgs/msg/Image")
COMPRESSED = message("sensor_msgs/msg/CompressedImage")
GREEN_PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA"
    "DUlEQVR4nGNgOMEARAAFfwGRkkj6EgAAAABJRU5ErkJggg=="
)
"""Two pixels of (0, 200, 0)."""
_MIDDLE_PIXEL = """canvas => {
  const copy = new OffscreenCanvas(1, 1).getContext("2d");
  copy.drawImage(canvas, canvas.width >> 1, canvas.height >> 1, 1, 1, 0, 0, 1, 1);
  return [...copy.getImageData(0, 0, 1, 1).data];
}"""

_DROP = """([name, text]) => {
  const held = new DataTransfer();
  held.items.add(new File([text], name));
  const options = { dataTransfer: held, bubbles: true, cancelable: true };
  document.body.dispatchEvent(new DragEvent("drop", options));
}"""

_PLOT = """async ([topic, path]) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/plotting.js", script))).addSeries(topic, path);
}"""


def panel(tab: StudioPage, name: str) -> Locator:
    """Bring a panel to the front; what it shows."""
    tab.page.evaluate(SHOW_PANEL, name)
    found = tab.page.locator(f"section.panel-body.{name}")
    found.wait_for()
    return found


def look_around(window: Locator, alone: str, humble: str) -> None:
    """What is in the way at a place is said, with what to do, before anything is joined."""
    address, domain = window.get_by_label("Address of the router"), window.get_by_label("Domain")
    before = address.input_value()
    for place, said, remedy in (
        (free_endpoint(), "No router answers at", "ros2 run rmw_zenoh_cpp rmw_zenohd"),
        (alone, "is running, but there are no nodes", "export RMW_IMPLEMENTATION=rmw_zenoh_cpp"),
        (humble, "neither side can read the other's", "Switch to humble"),
    ):
        address.fill(place)
        domain.fill("0")
        window.get_by_role("button", name="Test").click()
        report = window.locator(".ros-report").filter(has_text=said)
        report.get_by_text(remedy, exact=True).wait_for()
    address.fill(before)
    domain.fill("41")
    window.get_by_role("button", name="Test").click()


def join_where_nodes_are(tab: StudioPage, alone: str, humble: str) -> None:
    tab.page.locator(".ros-status").click()
    window = tab.page.get_by_role("dialog", name="ROS 2")
    window.get_by_text("There are no nodes in domain 41").wait_for()
    look_around(window, alone, humble)
    window.get_by_role("button", name="3 nodes in domain 0: switch").click()
    window.get_by_text("3 nodes are running in domain 0").wait_for()
    assert window.get_by_role("spinbutton", name="Domain").input_value() == "0"
    tab.page.keyboard.press("Escape")


def read_the_log(tab: StudioPage) -> None:
    log = panel(tab, "log")
    log.get_by_role("button", name="a word of warning").wait_for()
    log.get_by_label("Minimum level").select_option("error")
    log.get_by_text("does not match the filter").wait_for()
    log.get_by_label("Minimum level").select_option("info")
    log.get_by_role("searchbox").fill("warning")
    log.get_by_role("button", name="a word of warning").click()
    assert "a word of warning" in log.get_by_role("region", name="The whole line").inner_text()


def see_who_speaks_with_whom(tab: StudioPage) -> None:
    graph = panel(tab, "graph")
    graph.get_by_role("searchbox").fill("chatter")
    boxes = graph.locator(".graph-box")
    wait_until("two nodes and their topic", lambda: boxes.count() == 3)
    graph.get_by_role("button", name="Node /talker").click()
    details = graph.get_by_role("region", name="About /talker")
    details.get_by_role("heading", name="Publishes").wait_for()
    assert "std_msgs/msg/String" in details.inner_text()
    graph.get_by_label("Drawn as").select_option("nodes")
    wait_until("one edge between two", lambda: boxes.count() == 2)
    assert graph.locator(".graph-arrow").count() == 1


def give_a_type(tab: StudioPage) -> None:
    types = panel(tab, "interfaces")
    types.get_by_role("searchbox").fill("geometry pose")
    types.get_by_role("button", name="geometry_msgs/msg/Pose", exact=True).click()
    types.get_by_role("button", name="Unfold position").click()
    types.get_by_role("button", name="Add a type").click()
    types.get_by_label("Name").fill("my_robot_interfaces/msg/CustomTelemetry")
    types.get_by_label("Text").fill("this is no type !")
    types.get_by_role("button", name="Add it").click()
    types.get_by_role("alert").wait_for()
    types.get_by_label("Text").fill("string robot_name\nfloat32 battery_percent\n")
    types.get_by_role("button", name="Add it").click()
    types.get_by_role("heading", name="my_robot_interfaces/msg/CustomTelemetry").wait_for()
    assert "RIHS01_" in types.inner_text()


def use_a_dropped_type(tab: StudioPage) -> None:
    """A file becomes a type that is published and echoed at once (T11)."""
    tab.page.evaluate(_DROP, ["Level.msg", "float32 litres\n"])
    types = panel(tab, "interfaces")
    wait_until("a name is proposed", lambda: types.get_by_label("Name").count() == 1)
    assert types.get_by_label("Name").input_value() == "my_interfaces/msg/Level"
    types.get_by_role("button", name="Add it").click()
    types.get_by_role("heading", name="my_interfaces/msg/Level").wait_for()
    tab.page.evaluate(SHOW_PANEL, "publish")
    out = tab.page.locator("section.operations[aria-label='Publish']")
    out.get_by_label("Topic", exact=True).fill("/tank")
    out.get_by_label("Message type").fill("my_interfaces/msg/Level")
    out.get_by_role("button", name="Take", exact=True).click()
    out.get_by_label("litres").fill("7.25")
    out.get_by_role("button", name="Once a second").click()
    topics = panel(tab, "topics")
    topics.get_by_role("row", name="/tank").click()
    topics.get_by_role("treeitem", name="litres 7.25").wait_for()
    listen_otherwise(tab)


def listen_otherwise(tab: StudioPage) -> None:
    """A plot is heard as somebody chose, which the ends of its topic show."""
    tab.page.keyboard.press("Control+2")  # where both are seen at once
    tab.page.evaluate(_PLOT, ["/tank", ".litres"])
    plots = panel(tab, "plot")
    plots.get_by_role("listitem").get_by_text("7.25").wait_for()
    plots.get_by_role("button", name="Quality of service of its subscriptions").click()
    tab.page.get_by_role("menuitemradio", name="Transient local").click()
    topics = panel(tab, "topics")
    topics.get_by_role("button", name="Publishers, subscribers").click()
    ends = topics.get_by_role("listitem").filter(has_text="/studio")
    ends.get_by_text("transient local · keep last 4096").wait_for()


def change_a_state(tab: StudioPage) -> None:
    arm = panel(tab, "lifecycle").get_by_role("region", name="/arm")
    arm.get_by_role("button", name="configure", exact=True).click()
    arm.get_by_role("button", name="activate", exact=True).wait_for()
    assert arm.locator("[aria-current=step]").inner_text() == "inactive"
    parts = panel(tab, "diagnostics")
    parts.get_by_role("button", name="arm: motor").click()
    parts.get_by_text("81 °C").wait_for()


def send_pictures(arm: Arm) -> None:
    """A raw image and a compressed one, again and again."""
    raw_out = arm.create_publisher(IMAGE, "/eye/image_raw", 10)
    raw = IMAGE(width=2, height=1, encoding="bgr8", step=6)
    raw.data = np.array([30, 20, 10, 30, 20, 10], dtype=np.uint8)
    arm.create_timer(0.2, lambda: raw_out.publish(raw))
    packed_out = arm.create_publisher(COMPRESSED, "/eye/packed", 10)
    packed = COMPRESSED(format="png", data=np.frombuffer(GREEN_PNG, dtype=np.uint8))
    arm.create_timer(0.2, lambda: packed_out.publish(packed))


def see_pictures(tab: StudioPage) -> None:
    images = panel(tab, "image")
    images.get_by_text("· bgr8").wait_for()
    picture = images.get_by_role("img", name="Picture of /eye/image_raw")
    wait_until("its pixels", lambda: picture.evaluate(_MIDDLE_PIXEL) == [10, 20, 30, 255])
    picture.hover()
    images.get_by_text(": 10 20 30").wait_for()
    images.get_by_role("button", name="Topic of the picture").click()
    tab.page.get_by_role("menuitemradio", name="/eye/packed").click()
    images.get_by_text("· png").wait_for()
    picture = images.get_by_role("img", name="Picture of /eye/packed")
    wait_until("its pixels", lambda: picture.evaluate(_MIDDLE_PIXEL) == [0, 200, 0, 255])


def test_a_system_is_joined_read_drawn_and_given_a_type(browser: Browser, tmp_path: Path):
    with (
        running_router() as endpoint,
        running_router() as alone,
        running_router() as humble,
        context_at(humble, "humble") as old,
        node_at(endpoint, "talker") as talker,
        node_at(endpoint, "listener") as listener,
        managed_arm(endpoint) as arm,
    ):
        Node("old_talker", context=old).create_publisher(
            old.wire.types.message("std_msgs/msg/String"), "/chatter", 10
        )
        talker.create_publisher(STRING, "/chatter", 10)
        heard: list[object] = []
        listener.create_subscription(STRING, "/chatter", heard.append, 10)
        talker.get_logger().warning("a word of warning")
        arm.tell_parts()
        send_pictures(arm)
        place = ["--connect", endpoint, "--router", "off", "--domain", "41"]
        with (
            running_studio(["demo", *place], tmp_path / "data") as studio,
            studio_page(browser, studio, view=False) as tab,
        ):
            join_where_nodes_are(tab, alone, humble)
            read_the_log(tab)
            see_who_speaks_with_whom(tab)
            give_a_type(tab)
            use_a_dropped_type(tab)
            change_a_state(tab)
            see_pictures(tab)
            assert tab.errors == []
