"""Tools of the 3D view: what a press, a finger or the keys send, as another session receives it."""

from __future__ import annotations

import math
import struct
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

import pytest
from playwright.sync_api import Error as PlaywrightError

from studio.nodes.robot_state_publisher import LATCHED
from studio.ros.messages import message
from studio.rviz.tools import POINT, POSE, POSE_WITH_COVARIANCE
from tests.support.demos import heard, node_at
from tests.support.navigation import navigator
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.wire import free_endpoint, router_at
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, ViewportSize

    from studio.ros.client import Node
    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]
TF = "tf2_msgs/msg/TFMessage"
CLOUD = "sensor_msgs/msg/PointCloud2"
ODOM_X_M = 0.25
"""Where the robot's root link is in odom."""
BEACON = (-0.35, -0.3, 0.5)
"""The one point of a cloud, in odom."""
WINDOW: Final[ViewportSize] = {"width": 1000, "height": 640}
"""Filled by the 3D view, so that the ground is seen all around the robot."""
NEAR_M = 0.02
"""A pixel of the ground is about a centimetre wide."""

_PLACE_OF = """([name, point]) => {
  const frame = document.querySelector("iframe");
  const { camera, canvas, nodeRefFromName } = frame.contentWindow.__viserMutable;
  const { matrixWorld } = nodeRefFromName[name];
  const seen = camera.position.clone().set(...point).applyMatrix4(matrixWorld).project(camera);
  const { left, top } = frame.getBoundingClientRect();
  return [left + ((seen.x + 1) / 2) * canvas.clientWidth,
    top + ((1 - seen.y) / 2) * canvas.clientHeight];
}"""
_SET_FIXED_FRAME = """async (frame) => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/live-displays.js", script))).setFixedFrame(frame);
}"""
_ADD_CLOUD = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay } = await import(new URL("../model/live-displays.js", script));
  await addDisplay("PointCloud2", "/beacon");
}"""
_ROBOT_X = """() => {
  const { nodeRefFromName } = document.querySelector("iframe").contentWindow.__viserMutable;
  return nodeRefFromName["/robot"]?.position.x;
}"""
_RUN = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../lib/commands.js", script))).commandById(id).run();
}"""
_IN_HAND = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/tools.js", script))).toolInHand.value?.name;
}"""
_MAY_TAKE = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { mayTake, tools } = await import(new URL("../model/tools.js", script));
  return tools.value.map(mayTake);
}"""
_IN_VIEW = """(asked) => {
  const [name, ...values] = [asked].flat();
  return document.querySelector("iframe").contentWindow.studio3d[name](...values);
}"""
_LABEL = """() => document.querySelector("iframe").contentDocument
  .querySelector(".studio-label.aim")?.textContent ?? "" """


def beacon() -> Any:  # noqa: ANN401
    """A cloud of one point."""
    field = message("sensor_msgs/msg/PointField")
    one = message(CLOUD)(height=1, width=1, point_step=12, row_step=12, is_dense=True)
    one.header.frame_id = "odom"
    one.fields = [
        field(name=name, offset=4 * at, datatype=7, count=1) for at, name in enumerate("xyz")
    ]
    one.data = struct.pack("<3f", *BEACON)
    return one


class Heard:
    """What a node of another session receives of the tools."""

    def __init__(self, node: Node) -> None:
        self.poses = heard(node, POSE_WITH_COVARIANCE, "/initialpose")
        self.goals = heard(node, POSE, "/goal_pose")
        self.others = heard(node, POSE, "/second/goal")
        self.points = heard(node, POINT, "/clicked_point")


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    with router_at(free_endpoint()) as router:
        yield router.endpoint.text


@pytest.fixture(scope="module")
def node(endpoint: str) -> Generator[Node]:
    """A node that says where the robot is in odom, and shows a point."""
    with node_at(endpoint, "teller") as made:
        frame = message("geometry_msgs/msg/TransformStamped")(child_frame_id="base_footprint")
        frame.header.frame_id = "odom"
        frame.transform.translation.x, frame.transform.rotation.w = ODOM_X_M, 1.0
        transforms: Any = message(TF)(transforms=[frame])
        made.create_publisher(message(TF), "/tf_static", LATCHED).publish(transforms)
        made.create_publisher(message(CLOUD), "/beacon", LATCHED).publish(beacon())
        yield made


@pytest.fixture(scope="module")
def ear(node: Node) -> Heard:
    return Heard(node)


@pytest.fixture(scope="module")
def studio(endpoint: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    data: Path = tmp_path_factory.mktemp("tools") / "data"
    words = ["demo", "--viewer-link", "--connect", endpoint, "--router", "off"]
    with running_studio(words, data) as running:
        yield running


@pytest.fixture(scope="module")
def tab(browser: Browser, studio: RunningStudio, node: Node) -> Iterator[StudioPage]:
    """One tab for all tests of the file, fixed to odom."""
    del node
    with studio_page(browser, studio) as page:
        page.page.set_viewport_size(WINDOW)
        page.page.evaluate(SHOW_PANEL, "scene")
        page.page.evaluate(_RUN, "maximize")
        connect(page)
        page.page.evaluate(_ADD_CLOUD)
        page.page.evaluate(_SET_FIXED_FRAME, "odom")
        wait_until("the robot in odom", lambda: page.page.evaluate(_ROBOT_X) == ODOM_X_M)
        page.page.get_by_role("button", name="Dismiss").click()
        yield page
        assert page.errors == []


def place(tab: StudioPage, *point: float, name: str = "") -> tuple[float, float]:
    """Where a point of a node of the scene is seen; of the fixed frame if it has no name."""
    x, y = tab.page.evaluate(_PLACE_OF, [name, point])
    return x, y


def bar(tab: StudioPage) -> Locator:
    return tab.page.get_by_role("toolbar", name="3D tools")


def take(tab: StudioPage, key: str, name: str) -> None:
    tab.page.keyboard.press(key)
    in_hand(tab, name)


def in_hand(tab: StudioPage, name: str) -> None:
    wait_until(f"{name} in hand", lambda: tab.page.evaluate(_IN_HAND) == name)


def draw(tab: StudioPage, begin: tuple[float, float], end: tuple[float, float]) -> None:
    """Press at a place of the ground and draw the mouse to another; it stays pressed."""
    mouse = tab.page.mouse
    mouse.move(*place(tab, *begin, 0.0))
    mouse.down()
    mouse.move(*place(tab, *end, 0.0), steps=4)


def yaw_of(turn: Any) -> float:  # noqa: ANN401 - a quaternion
    return 2 * math.atan2(turn.z, turn.w)


def test_a_goal_is_pressed_and_drawn_and_escape_gives_it_up(tab: StudioPage, ear: Heard):
    take(tab, "g", "2D Goal Pose")
    draw(tab, (0.05, -0.6), (0.05, -0.9))
    wait_until("numbers at the mouse", lambda: "yaw -1.5" in tab.page.evaluate(_LABEL))
    tab.page.keyboard.press("Escape")
    tab.page.mouse.up()
    in_hand(tab, "2D Goal Pose")
    button = bar(tab).get_by_role("button", name="2D Goal Pose", exact=True)
    assert button.get_attribute("aria-pressed") == "true"
    draw(tab, (0.05, -0.6), (0.35, -0.6))
    tab.page.mouse.up()
    tab.page.get_by_text("2D Goal Pose: published on /goal_pose, in odom.").wait_for()
    wait_until("the goal", lambda: len(ear.goals) == 1)
    said = ear.goals[0]
    assert said.header.frame_id == "odom"
    assert said.pose.position.x == pytest.approx(0.05, abs=NEAR_M)
    assert said.pose.position.y == pytest.approx(-0.6, abs=NEAR_M)
    assert yaw_of(said.pose.orientation) == pytest.approx(0, abs=0.1)
    in_hand(tab, "Interact")


def test_a_finger_sends_a_pose_estimate(tab: StudioPage, ear: Heard):
    take(tab, "p", "2D Pose Estimate")
    with tab.finger(coarse=False) as touch:
        before = place(tab, 0.0, 0.0, 0.0)
        touch("touchStart", place(tab, 0.05, -0.6, 0.0))
        for y in (-0.7, -0.8, -0.9):
            touch("touchMove", place(tab, 0.05, y, 0.0))
        touch("touchEnd")
        assert place(tab, 0.0, 0.0, 0.0) == before  # the camera stood still
    wait_until("the pose", lambda: len(ear.poses) == 1)
    pose = ear.poses[0].pose
    assert pose.pose.position.x == pytest.approx(0.05, abs=NEAR_M)
    assert yaw_of(pose.pose.orientation) == pytest.approx(-math.pi / 2, abs=0.1)
    own = {at: one for at, one in enumerate(pose.covariance) if one}
    assert own == pytest.approx({0: 0.25, 7: 0.25, 35: (math.pi / 12) ** 2})


def test_a_point_of_a_link_and_of_a_cloud_is_named_at_the_mouse_and_published(
    tab: StudioPage, ear: Heard
):
    for name, at in (("PointCloud2", place(tab, *BEACON)), ("mast", mast(tab))):
        take(tab, "u", "Publish Point")
        tab.page.mouse.move(*at)
        wait_until(f"{name} at the mouse", lambda name=name: name in tab.page.evaluate(_LABEL))
        tab.page.mouse.click(*at)
        in_hand(tab, "Interact")
    wait_until("both points", lambda: len(ear.points) == 2)
    cloud, link = (one.point for one in ear.points)
    assert (cloud.x, cloud.y, cloud.z) == pytest.approx(BEACON, abs=1e-3)  # half precision
    assert ear.points[0].header.frame_id == "odom"
    assert 0.3 < link.z < 0.8
    assert link.x == pytest.approx(ODOM_X_M - 0.2, abs=0.15)
    # Where nothing is drawn nothing is sent, and the tool stays.
    take(tab, "u", "Publish Point")
    tab.page.mouse.click(*place(tab, 0.13, -0.63, 0.0))
    in_hand(tab, "Publish Point")
    tab.page.keyboard.press("Escape")
    in_hand(tab, "Interact")
    assert len(ear.points) == 2


def mast(tab: StudioPage) -> tuple[float, float]:
    """The middle of the mast."""
    return place(tab, 0.0, 0.0, 0.2, name="/robot/mast")


def test_the_camera_alone_is_moved_and_focused(tab: StudioPage):
    take(tab, "m", "Move Camera")
    tab.page.mouse.click(*mast(tab))
    assert tab.page.locator(".tree-row.selected").count() == 0
    take(tab, "i", "Interact")
    take(tab, "c", "Focus Camera")
    x, y = place(tab, *BEACON)
    tab.page.mouse.click(x, y)
    in_hand(tab, "Interact")
    frame = tab.page.locator("iframe").bounding_box()
    assert frame is not None
    middle = (frame["x"] + frame["width"] / 2, frame["y"] + frame["height"] / 2)
    wait_until("the point in the middle", lambda: math.dist(place(tab, *BEACON), middle) < 2)
    tab.page.mouse.move(*mast(tab))
    wait_until("the mast under the mouse", lambda: tab.page.evaluate(_IN_VIEW, "isPointing"))
    tab.page.keyboard.press("f")
    wait_until("the mast in the middle", lambda: math.dist(mast(tab), middle) < 12)


def test_without_perspective_goals_and_points_are_where_they_are_pressed(
    tab: StudioPage, ear: Heard
):
    goals, points = len(ear.goals), len(ear.points)
    tab.page.evaluate(_IN_VIEW, ["setViewKind", "TopDownOrtho"])
    tab.page.evaluate(_IN_VIEW, ["setViewValue", "Scale", 150])
    metre = lambda: math.dist(place(tab, 0.0, 0.0, 0.0), place(tab, 1.0, 0.0, 0.0))  # noqa: E731
    wait_until("the map to stand", lambda: abs(metre() - 150) < 0.1)
    take(tab, "g", "2D Goal Pose")
    draw(tab, (0.05, -0.6), (0.35, -0.9))
    tab.page.mouse.up()
    wait_until("the goal", lambda: len(ear.goals) > goals)
    goal = ear.goals[-1].pose
    assert (goal.position.x, goal.position.y) == pytest.approx((0.05, -0.6), abs=NEAR_M)
    assert yaw_of(goal.orientation) == pytest.approx(-math.pi / 4, abs=0.1)
    take(tab, "u", "Publish Point")
    tab.page.mouse.click(*place(tab, *BEACON))
    wait_until("the point", lambda: len(ear.points) > points)
    point = ear.points[-1].point
    assert (point.x, point.y, point.z) == pytest.approx(BEACON, abs=1e-3)
    tab.page.evaluate(_IN_VIEW, ["setViewKind", "Orbit"])
    in_hand(tab, "Interact")


def test_a_tool_of_ones_own_is_added_set_and_used_by_keys(tab: StudioPage, ear: Heard):
    tab.page.evaluate(_RUN, "maximize")
    tab.page.set_viewport_size({"width": 1500, "height": 800})
    tab.page.evaluate(SHOW_PANEL, "tools")
    panel = tab.page.get_by_role("region", name="Tool Properties")
    panel.get_by_role("button", name="Add tool").click()
    tab.page.get_by_role("menuitem", name="2D Goal Pose").click()
    name = panel.get_by_label("Name of 2D Goal Pose 2")
    name.fill("Second goal")
    name.press("Enter")
    for what, text in (("Topic", "/second/goal"), ("Frame", "base_footprint")):
        box = panel.get_by_role("textbox", name=f"Second goal: {what}")
        box.fill(text)
        box.press("Enter")
    panel.get_by_role("button", name="Take Second goal").click()
    card = tab.page.get_by_role("complementary", name="Second goal")
    for what, text in (("x in odom", "1.25"), ("y in odom", "-0.5"), ("Yaw in odom", "1.5708")):
        card.get_by_label(what).fill(text)
    card.get_by_label("Yaw in odom").press("Enter")
    wait_until("the goal", lambda: len(ear.others) == 1)
    said = ear.others[0]
    assert said.header.frame_id == "base_footprint"
    assert said.pose.position.x == pytest.approx(1.25 - ODOM_X_M)
    assert yaw_of(said.pose.orientation) == pytest.approx(math.pi / 2, abs=1e-3)
    box = panel.get_by_role("textbox", name="Second goal: Frame")
    box.fill("moon")
    box.press("Enter")
    panel.get_by_role("button", name="Take Second goal").click()
    card.get_by_role("button", name="Send").click()
    tab.page.get_by_role("alert").filter(has_text="moon").wait_for()
    panel.get_by_role("button", name="Remove Second goal").click()
    card.wait_for(state="detached")
    assert len(ear.others) == 1


def test_a_navigation_goal_shows_how_far_it_is_and_is_cancelled(
    tab: StudioPage, ear: Heard, endpoint: str
):
    sent = len(ear.goals)
    with navigator(endpoint) as work:
        card = tab.page.get_by_role("complementary", name="2D Goal Pose")
        send = card.get_by_role("button", name="Send")

        goal = tab.page.locator(".navigation-goal")

        def is_sent() -> bool:  # once it is known that the action is served
            if send.count() == 0:
                take(tab, "g", "2D Goal Pose")
            send.click()
            with suppress(PlaywrightError):
                goal.wait_for(timeout=3000)
            return goal.count() == 1

        wait_until("the goal in the view", is_sent)
        work.tell(2.5, recoveries=1, seconds=3)
        goal.get_by_text("2.5 m to go · 3 s under way · 1 recovery").wait_for()
        goal.get_by_role("button", name="Cancel").click()
        wait_until("the cancel request", lambda: work.goal().is_cancel_requested)
        work.end("canceled")
        goal.get_by_text("/navigate_to_pose: canceled.").wait_for()
    assert len(ear.goals) >= sent


def test_where_there_is_no_room_the_tools_are_in_a_menu(tab: StudioPage):
    tab.page.set_viewport_size({"width": 1000, "height": 700})
    bar(tab).get_by_role("button", name="Tools: Interact").click()
    tab.page.get_by_role("menuitemradio", name="Measure").click()
    tab.page.get_by_role("complementary", name="Measure").wait_for()
    tab.page.keyboard.press("Escape")
    bar(tab).get_by_role("button", name="Tools: Interact").wait_for()


def test_who_only_looks_can_take_no_tool_that_publishes_and_is_refused(
    browser: Browser, studio: RunningStudio, ear: Heard
):
    before = len(ear.goals)
    with studio_page(browser, studio, viewer=True, view=False) as viewer:
        bar(viewer).get_by_role("button", name="Tools: Interact").wait_for()
        assert viewer.page.evaluate(_MAY_TAKE) == [
            True,
            True,
            True,
            True,
            True,
            False,
            False,
            False,
        ]
        answer = viewer.page.evaluate(
            """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { send } = await import(new URL("../model/wire.js", script));
  return send({ type: "use_tool", tool: "t7", x: 0, y: 0, fixed_frame: "odom" })
    .then(() => "sent", (error) => error.kind);
}"""
        )
    assert answer == "NotAllowedError"
    assert len(ear.goals) == before
