"""A robot on DDS behind the real bridge, on the page: seen, plotted, drawn, called and driven."""

from __future__ import annotations

import re
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pytest
from playwright.sync_api import Error
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from studio.ros.messages import service
from tests.support.dds_bridge import DdsNetwork, need_dds
from tests.support.dds_classroom import URDF
from tests.support.demos import call, node_at
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.scene_nodes import points_below, poses_below
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.wire import running_router
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, ViewportSize

    from studio.ros.client import Node
    from studio.ros.types.classes import MessageValue
    from tests.support.dds_bridge import DdsRobot

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

ADD: Final = "example_interfaces/srv/AddTwoInts"
SIZE: Final[ViewportSize] = {"width": 1100, "height": 640}
WALL_M: Final = 3.0
"""How far each wall of the room is from its middle, where the robot begins."""
_SHOW: Final = """async (displays) => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay } = await import(new URL("../model/live-displays.js", script));
  for (const [kind, topic] of displays) await addDisplay(kind, topic);
}"""
_DRAW: Final = """async (lines) => {
  const script = document.querySelector('script[type="module"]').src;
  const { series } = await import(new URL("../model/plotting.js", script));
  series.value = lines.map(([topic, path]) => ({ topic, path }));
}"""


class Classroom(NamedTuple):
    """The robot on DDS, a node on Zenoh beside it, and a page that has opened the robot."""

    robot: DdsRobot
    node: Node
    tab: StudioPage
    data: Path

    def panel(self, panel: str, name: str) -> Locator:
        """Bring a panel to the front."""
        self.tab.page.evaluate(SHOW_PANEL, panel)
        return self.tab.page.get_by_role("region", name=name, exact=True)


@pytest.fixture(scope="module")
def room(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Classroom]:
    need_dds()
    data = tmp_path_factory.mktemp("dds") / "data"
    with ExitStack() as stack:
        endpoint = stack.enter_context(running_router())
        network = stack.enter_context(DdsNetwork())
        network.bridge(connect=endpoint)
        robot = network.robot("classroom")
        give_it_work(robot)
        node = stack.enter_context(node_at(endpoint))
        place = ["--router", "off", "--connect", endpoint]
        studio = stack.enter_context(running_studio(["demo", *place], data))
        context = studio_context(browser, SIZE)
        stack.callback(context.close)
        tab = StudioPage(context.new_page())
        tab.page.goto(studio.url)
        connect(tab)
        open_from_ros(tab)
        draw(tab)
        yield Classroom(robot, node, tab, data)
        assert tab.errors == []


def give_it_work(robot: DdsRobot) -> None:
    """What a robot of a class has beside its body."""
    robot.ask("serve", service="/add", type_name=ADD, behaviour="add")
    robot.ask("serve_fibonacci")
    robot.ask("manage", node="/arm")


def open_from_ros(tab: StudioPage) -> None:
    """Open the robot whose description is told."""
    tab.page.get_by_role("treeitem").first.wait_for()
    tab.page.keyboard.press("Control+o")
    window = tab.page.get_by_role("dialog")
    window.get_by_role("tab", name="From ROS").click()
    topic = window.get_by_label("Topic with the description")
    wait_until("its topic", lambda: topic.input_value() == "/robot_description")
    window.get_by_role("button", name="Open", exact=True).click()
    wait_until("its document", lambda: path_of(tab) == "/d/robot-description")
    wait_until("the robot to be drawn", tab.has_drawn_robot)


def path_of(tab: StudioPage) -> str:
    """Where the tab is; empty on its way to another address."""
    try:
        return tab.page.evaluate("location.pathname")
    except Error:
        return ""


def draw(tab: StudioPage) -> None:
    """Draw what it sees and tells of itself, where its odometry says that it is."""
    kinds = [["LaserScan", "/scan"], ["TF", ""], ["RobotModel", "/robot_description"]]
    tab.page.evaluate(_SHOW, kinds)
    frame = tab.page.get_by_role("textbox", name="Fixed frame")
    frame.fill("odom")
    frame.press("Enter")


def test_it_is_opened_from_its_description_and_its_wheels_follow(room: Classroom):
    for link in ("base_link", "laser", "left_wheel_link", "right_wheel_link"):
        room.tab.page.get_by_role("treeitem", name=link, exact=True).wait_for()
    joints = room.panel("joints", "Joints")
    source = joints.get_by_label("Joints are moved by")
    wait_until("the joints to follow", lambda: source.input_value() == "joint_states")


def test_its_nodes_and_topics_are_in_the_graph(room: Classroom):
    graph = room.panel("graph", "Node graph")
    for name in ("/driver", "/laser", "/talker", "/arm"):
        graph.get_by_role("button", name=re.compile(f"^Node .{name[1:]} DDS")).wait_for()
    graph.get_by_role("button", name=re.compile("^Node .talker ")).click()
    details = graph.get_by_role("region", name="About /talker")
    details.get_by_text("/chatter").first.wait_for()
    assert "std_msgs/msg/String" in details.inner_text()


def test_its_topics_are_listed_with_their_rate_and_echoed_with_their_qos(room: Classroom):
    topics = room.panel("topics", "Topics")
    for name in ("/chatter", "/odom", "/scan", "/tf"):
        row = topics.get_by_role("row", name=name)
        row.get_by_text(re.compile(r"^\d+(\.\d+)? Hz$")).wait_for()
    topics.get_by_role("row", name="/chatter").click()
    topics.get_by_role("treeitem", name=re.compile(r"^data The robot says \d+")).wait_for()
    topics.get_by_role("row", name="/scan").click()
    topics.get_by_role("treeitem", name=re.compile(r"^range_max 10\b")).wait_for()
    topics.get_by_role("button", name="Publishers, subscribers").click()
    ends = topics.get_by_role("listitem").filter(has_text="/laser")
    ends.get_by_text("best effort").wait_for()
    assert "keep last 5" in ends.inner_text()


def test_its_numbers_are_plotted(room: Classroom):
    room.tab.page.evaluate(_DRAW, [["/odom", ".pose.pose.position.x"], ["/scan", ".range_max"]])
    plot = room.panel("plot", "Plot")
    values = plot.locator(".plot-legend output")
    wait_until(
        "a number of each", lambda: list(map(len, map(number, values.all_inner_texts()))) == [1, 1]
    )
    assert number(values.last.inner_text()) == [10.0]
    plot.locator(".plot-chart canvas").wait_for()
    room.tab.page.evaluate(_DRAW, [])


def number(text: str) -> list[float]:
    """The number of a text; empty where it is none."""
    told = re.fullmatch(r"-?\d+(\.\d+)?(e-?\d+)?", text.replace("\u2212", "-"))
    return [float(told[0])] if told else []


def test_its_scan_frames_and_model_are_drawn(room: Classroom):
    page = room.tab.page
    wait_until("the scan on the walls", lambda: is_on_walls(points_below(page, "/live/d1")))
    wait_until("the model in odom", lambda: "base_link" in poses_below(page, "/live/d3"))
    model = poses_below(page, "/live/d3")
    base, laser = model["base_link"], model["laser"]
    np.testing.assert_allclose(laser[:3] - base[:3], (0.15, 0.0, 0.1), atol=1e-6)
    frames = {name.rpartition("/")[2] for name in poses_below(page, "/live/d2")}
    assert {f"names%2F{one}" for one in ("odom", "base_link", "laser")} <= frames


def is_on_walls(points: Any) -> bool:  # noqa: ANN401 - shape (N, 3)
    """Whether all lie on the walls of the room, 2 cm more or less."""
    if len(points) < 100:
        return False
    return bool(np.allclose(np.abs(points[:, :2]).max(axis=1), WALL_M, atol=0.02))


def test_services_are_called_both_ways(room: Classroom):
    services = operations(room, "services", "Services")
    services.get_by_role("button", name="/add").click()
    for name, value in (("a", "40"), ("b", "2")):
        services.get_by_role("textbox", name=name, exact=True).fill(value)
    services.get_by_role("button", name="Call", exact=True).click()
    rows = services.locator(".value-row")
    wait_until("its answer", lambda: rows.all_inner_texts() == ["sum\n42"])

    def multiply(request: MessageValue, response: MessageValue) -> MessageValue:
        response.sum = request.a * request.b
        return response

    server = room.node.create_service(service(ADD), "/multiply", multiply)
    assert room.robot.call("/multiply", ADD, a=6, b=7)["sum"] == 42
    room.node.destroy_service(server)


def operations(room: Classroom, panel: str, title: str) -> Locator:
    room.tab.page.evaluate(SHOW_PANEL, panel)
    return room.tab.page.locator(f"section.operations[aria-label='{title}']")


def test_a_goal_shows_feedback_and_its_result_and_another_is_cancelled(room: Classroom):
    actions = operations(room, "actions", "Actions")
    actions.get_by_role("button", name="/fibonacci").click()
    chosen = actions.locator(".operations-chosen")
    order = actions.get_by_role("textbox", name="order")
    send = actions.get_by_role("button", name="Send goal", exact=True)
    order.fill("6")
    send.click()
    chosen.get_by_text("Succeeded").wait_for()
    assert "0, 1, 1, 2, 3, 5, 8" in chosen.inner_text()
    order.fill("1000")
    send.click()
    chosen.get_by_text(re.compile("0, 1, 1")).first.wait_for()
    chosen.get_by_role("button", name="Cancel", exact=True).click()
    chosen.get_by_text("Cancelled after").wait_for()


def test_parameters_are_read_and_set(room: Classroom):
    parameters = operations(room, "parameters", "Parameters")
    parameters.get_by_role("button", name="/driver", exact=True).click()
    box = parameters.get_by_role("textbox", name="speed_max_m_s")
    assert box.input_value() == "1"
    box.fill("0.4")
    box.press("Enter")
    wait_until("the robot has it", lambda: speed_max_m_s(room.node) == 0.4)


def speed_max_m_s(node: Node) -> float:
    kind = "rcl_interfaces/srv/GetParameters"
    answer = call(node, kind, "/driver/get_parameters", names=["speed_max_m_s"])
    return answer.values[0].double_value


def test_a_managed_node_is_led_through_its_states(room: Classroom):
    arm = room.panel("lifecycle", "Lifecycle").get_by_role("region", name="/arm")
    arm.get_by_role("button", name="configure", exact=True).click()
    arm.get_by_role("button", name="activate", exact=True).wait_for()
    assert arm.locator("[aria-current=step]").inner_text() == "inactive"
    assert room.robot.wait_said("state", node="/arm")["state"] == "inactive"


def test_it_is_driven_by_hand_and_the_page_shows_how_far(room: Classroom):
    page = room.tab.page
    teleop = room.panel("teleop", "Teleop")
    topic = teleop.get_by_label("Topic", exact=True)
    assert topic.input_value() == "/cmd_vel"
    wait_until("it is where its odometry says", lambda: "robot" in poses_below(page, ""))
    before = poses_below(page, "")["robot"]
    forward = teleop.get_by_role("button", name="Forward", exact=True)
    box = forward.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    wait_until("it drives", lambda: poses_below(page, "")["robot"][0] > before[0] + 0.1)
    page.mouse.up()
    wait_until("it stands", lambda: room.robot.all_said("cmd_vel")[-1]["linear_m_s"] == 0)
    assert max(one["linear_m_s"] for one in room.robot.all_said("cmd_vel")) > 0
    wait_until("the scan on the walls", lambda: is_on_walls(points_below(page, "/live/d1")))


def has(one: Locator, words: re.Pattern[str]) -> bool:
    return words.search(one.inner_text()) is not None


def test_it_is_recorded_from_the_page(room: Classroom):
    bag = room.panel("bag", "Bag")
    bag.get_by_role("button", name="Record", exact=True).click()
    bag.get_by_role("button", name="Start recording").click()
    recording = bag.get_by_role("region", name="Recording")
    for topic in ("/odom", "/scan", "/robot_description"):
        count = re.compile(rf"{topic}\s+[1-9]")
        wait_until(f"messages on {topic}", lambda count=count: has(recording, count))
    bag.get_by_role("button", name="Stop", exact=True).click()
    bag.get_by_role("region", name="Recorded").wait_for()
    (folder,) = (room.data / "bags").iterdir()
    store = get_typestore(Stores.ROS2_JAZZY)
    with AnyReader([folder], default_typestore=store) as reader:
        told: dict[str, Any] = {
            connection.topic: reader.deserialize(data, connection.msgtype)
            for connection, _, data in reader.messages()
        }
    assert told["/robot_description"].data == URDF
    assert told["/scan"].header.frame_id == "laser"
    assert told["/odom"].child_frame_id == "base_link"
