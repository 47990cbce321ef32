"""Rows of the course in the page: nodes, topics, types and states, with nodes of other processes.

Each test is named after its row. Calls, goals, parameters and publishing are in
`test_doing_panels.py`, numbers over time in `test_data_lane.py`, driving beside turtlesim.
"""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest
from rosbags.typesys import Stores, get_typestore

from tests.support.demos import running_demo
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Locator

    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

TALKER, LISTENER = "Node /topic_helloworld_pub", "Node /topic_helloworld_sub"
PACKAGES = ("std_msgs", "sensor_msgs", "geometry_msgs", "nav_msgs", "action_msgs")
WALK = (
    ("configure", "inactive"),
    ("activate", "active"),
    ("deactivate", "inactive"),
    ("cleanup", "unconfigured"),
    ("shutdown", "finalized"),
)
TELEMETRY = "my_robot_interfaces/msg/CustomTelemetry"


@pytest.fixture(scope="module")
def router() -> Iterator[str]:
    with running_router() as endpoint:
        yield endpoint


@pytest.fixture(scope="module")
def joined(
    browser: Browser, router: str, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[StudioPage]:
    """A tab of a studio that is connected; each test brings the nodes that it needs."""
    words = ["demo", "--connect", router, "--router", "off"]
    with (
        running_studio(words, tmp_path_factory.mktemp("studio") / "data") as studio,
        studio_page(browser, studio, view=False) as tab,
    ):
        tab.page.keyboard.press("Control+2")
        panel(tab, "topics").get_by_role("button", name="Connect", exact=True).click()
        yield tab


@pytest.fixture
def tab(joined: StudioPage) -> Iterator[StudioPage]:
    yield joined
    assert joined.errors == []


def panel(tab: StudioPage, name: str) -> Locator:
    """Bring a panel to the front; what it shows."""
    tab.page.evaluate(SHOW_PANEL, name)
    found = tab.page.locator(f"section.panel-body.{name}")
    found.wait_for()
    return found


def see_fields(tab: StudioPage, topic: str, count: int) -> Locator:
    """Echo a topic by a click; the rows of its message, once there are so many."""
    panel(tab, "topics")
    tab.page.locator(f"[id='topic-{topic}']").click()
    rows = tab.page.locator("[id^='echo-']")
    wait_until(f"{count} fields of {topic}", lambda: rows.count() == count)
    return rows


def test_n1_n7_a_node_is_there_once_it_runs_and_gone_once_it_is_killed(
    tab: StudioPage, router: str
):
    graph = panel(tab, "graph")
    with running_demo(router, "listener"), running_demo(router, "talker") as talker:
        graph.get_by_role("button", name=TALKER).wait_for()
        talker.stop(signal.SIGKILL)
        graph.get_by_role("button", name=TALKER).wait_for(state="detached")


def test_n2_what_a_node_has_is_grouped_as_ros2_node_info_does(tab: StudioPage, router: str):
    graph = panel(tab, "graph")
    with running_demo(router, "turtlesim_node"), running_demo(router, "turtle_teleop_key"):
        graph.get_by_role("button", name="Node /turtlesim").click()
        about = graph.get_by_role("region", name="About /turtlesim")
        for group in ("Publishes", "Subscribes to", "Serves services", "Serves actions"):
            about.get_by_role("heading", name=group).wait_for()
        for end in ("/turtle1/pose", "/turtle1/cmd_vel", "/spawn", "/turtle1/rotate_absolute"):
            about.get_by_text(end, exact=True).wait_for()
        about.get_by_role("button", name="Close").click()


def test_n4_talker_and_listener_are_two_nodes_and_one_edge(tab: StudioPage, router: str):
    graph = panel(tab, "graph")
    with running_demo(router, "talker"), running_demo(router, "listener"):
        graph.get_by_label("Drawn as").select_option("nodes")
        for name in (TALKER, LISTENER):
            graph.get_by_role("button", name=name).wait_for()
        boxes, edges = graph.locator(".graph-box"), graph.locator(".graph-arrow")
        wait_until("two nodes, one edge", lambda: (boxes.count(), edges.count()) == (2, 1))


def test_t4_who_comes_late_is_told_the_last_and_each_end_shows_its_quality(
    tab: StudioPage, router: str
):
    kept = "qos_overrides./reliable_topic.publisher.durability:=transient_local"
    with running_demo(router, "qos_topic_node", "--ros-args", "-p", kept):
        row = see_fields(tab, "/reliable_topic", 1)
        assert "reliably: 0" in row.inner_text()
        tab.page.get_by_role(
            "button", name="Publishers, subscribers and their quality of service"
        ).click()
        ends = tab.page.locator(".topics-ends")
        wait_until("its publisher", lambda: "/qos_topic_node" in (ends.text_content() or ""))
        assert all(word in ends.inner_text() for word in ("reliable", "transient local"))
        tab.page.get_by_role("button", name="Listen", exact=True).click()
        tab.page.get_by_text("Best effort", exact=True).click()
        wait_until("how the studio listens", lambda: "best effort" in ends.inner_text())
        tab.page.get_by_role("button", name="Listen", exact=True).click()
        tab.page.get_by_text("Match the publishers", exact=True).click()
        tab.page.get_by_role(
            "button", name="Publishers, subscribers and their quality of service"
        ).click()


def test_t5_a_pose_unfolds_into_what_it_is_made_of(tab: StudioPage):
    types = panel(tab, "interfaces")
    types.get_by_role("searchbox").fill("geometry_msgs/msg/Pose")
    types.get_by_role("button", name="geometry_msgs/msg/Pose", exact=True).click()
    types.get_by_role("button", name="Unfold position").click()
    types.get_by_role("button", name="Unfold orientation").click()
    details = types.get_by_role("region", name="geometry_msgs/msg/Pose")
    assert details.get_by_text("float64", exact=True).count() == 3 + 4
    types.get_by_role("searchbox").fill("")


@pytest.mark.parametrize("package", [*PACKAGES, "builtin_interfaces"])
def test_t6_all_types_of_a_usual_package_are_listed(tab: StudioPage, package: str):
    prefix = f"{package}/msg/"
    store = get_typestore(Stores.ROS2_JAZZY).fielddefs
    expected = {name.removeprefix(f"{package}/") for name in store if name.startswith(prefix)}
    types = panel(tab, "interfaces")
    listed = types.locator("details").filter(has=tab.page.get_by_text(package, exact=True))
    if listed.get_attribute("open") is None:
        listed.locator("summary").click()
    names = listed.get_by_role("button")
    wait_until("all of them", lambda: expected <= set(names.all_inner_texts()))


def test_t7_an_amazing_quote_has_three_fields(tab: StudioPage, router: str):
    with running_demo(router, "quote_publisher"):
        rows = see_fields(tab, "/amazing_quote", 3).all_inner_texts()
        said = "\n".join(rows)
        assert all(one in said for one in ("id", "Use the force, Pikachu!", "Uncle Ben"))


def test_t11_a_pasted_type_is_published_and_echoed_without_a_build(tab: StudioPage):
    types = panel(tab, "interfaces")
    types.get_by_role("button", name="Add a type").click()
    types.get_by_label("Name").fill(TELEMETRY)
    types.get_by_label("Text").fill("string robot_name\nfloat32 battery_percent\n")
    types.get_by_role("button", name="Add it").click()
    types.get_by_role("heading", name=TELEMETRY).wait_for()
    assert "RIHS01_" in types.inner_text()
    publish = tab.page.locator("section.operations[aria-label='Publish']")
    tab.page.evaluate(SHOW_PANEL, "publish")
    publish.get_by_role("textbox", name="Topic").fill("/telemetry")
    publish.get_by_role("textbox", name="Type").fill(TELEMETRY)
    publish.get_by_role("button", name="Take").click()
    publish.get_by_role("textbox", name="robot_name").fill("rover")
    publish.get_by_role("button", name="Once a second").click()
    rows = see_fields(tab, "/telemetry", 2)
    assert "rover" in rows.first.inner_text()
    tab.page.evaluate(SHOW_PANEL, "publish")
    publish.get_by_role("button", name="Stop", exact=True).last.click()


def test_l1_a_managed_node_walks_the_four_primary_states(tab: StudioPage, router: str):
    with running_demo(router, "lifecycle_talker"):
        talker = panel(tab, "lifecycle").get_by_role("region", name="/lc_talker")
        for way, state in WALK:
            talker.get_by_role("button", name=way, exact=True).click()
            step = talker.locator("[aria-current=step]")
            wait_until(state, lambda s=step, name=state: s.inner_text() == name)
