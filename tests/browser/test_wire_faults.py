"""What goes wrong in a ROS 2 system, as the page shows it: said in a sentence, and healed."""

from __future__ import annotations

import re
import signal
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.faulty_robot import (
    STRANGE,
    STRANGE_TEXT,
    UNWANTED,
    FaultyRobot,
    faulty_robot,
    router_process,
)
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, studio_page, wait_until
from tests.support.wire import free_endpoint

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Locator

    from tests.support.demos import RunningDemo
    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

GONE = "The router at {} is gone"
DEEDS = ("services", "actions", "parameters", "publish")
OTHERS = ("topics", "teleop", "plot", "log", "image", "diagnostics", "graph", "lifecycle")
DOING: dict[str, dict[str, Any]] = {
    "publish": {"name": "/x", "message_type": "std_msgs/msg/String", "text": "", "rate_hz": 1},
    "call_service": {"name": "/silent", "service_type": "x/srv/Y", "text": "", "timeout_s": 1},
    "send_goal": {"name": "/fibonacci", "action_type": "x/action/Y"},
    "set_parameter": {"node": "/robot", "name": "use_sim_time", "text": "true"},
    "load_parameters": {"node": "/robot", "text": ""},
    "drive": {"topic": "/cmd_vel", "stamped": False, "x": 1, "y": 0, "yaw": 0},
    "change_state": {"node": "/robot", "transition": 1},
    "add_interfaces": {"texts": {STRANGE: STRANGE_TEXT}},
    "start_demo": {"demo": "talker"},
    "disconnect_wire": {},
}
SEEN = {
    "services": "/silent",
    "actions": "/fibonacci",
    "parameters": "/robot",
    "publish": "/count",
}
SHUT = {
    "services": ("/silent", "Call"),
    "actions": ("/fibonacci", "Send goal"),
    "publish": ("/count", "Publish once"),
    "teleop": ("", "Forward"),
}
"""What is chosen in a panel, and what can then be done by those who may."""
_SEND = """async (command) => {
  const script = document.querySelector('script[type="module"]').src;
  const { send } = await import(new URL("../model/wire.js", script));
  return send(command).then(({ type }) => type, ({ message }) => message);
}"""


@pytest.fixture(scope="module")
def endpoint() -> str:
    return free_endpoint()


@pytest.fixture(scope="module")
def router(endpoint: str) -> Iterator[RunningDemo]:
    with router_process(endpoint) as running:
        yield running


@pytest.fixture(scope="module")
def robot(endpoint: str, router: RunningDemo) -> Iterator[FaultyRobot]:
    del router  # is there before
    with faulty_robot(endpoint) as made:
        yield made


@pytest.fixture(scope="module")
def studio(
    endpoint: str, router: RunningDemo, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[RunningStudio]:
    del router  # is there before
    words = ["demo", "--viewer-link", "--connect", endpoint, "--router", "off"]
    with running_studio(words, tmp_path_factory.mktemp("studio") / "data") as running:
        yield running


@pytest.fixture(scope="module")
def tab(browser: Browser, studio: RunningStudio, robot: FaultyRobot) -> Iterator[StudioPage]:
    """A tab of a studio that is connected with the robot."""
    del robot  # is there before
    with studio_page(browser, studio, view=False) as opened:
        opened.page.keyboard.press("Control+2")
        panel(opened, "topics").get_by_role("button", name="Connect", exact=True).click()
        row(opened, "/count").wait_for()
        yield opened


def panel(tab: StudioPage, name: str) -> Locator:
    """Bring a panel to the front; what it shows."""
    tab.page.evaluate(SHOW_PANEL, name)
    one_of_many = f".operations[aria-label={name.title()}]"
    found = tab.page.locator(one_of_many if name in DEEDS else f".panel-body.{name}")
    found.wait_for()
    return found


def row(tab: StudioPage, topic: str) -> Locator:
    return tab.page.locator(f"[id='topic-{topic}']")


def echo(tab: StudioPage, topic: str) -> Locator:
    """What a topic says now."""
    panel(tab, "topics")
    row(tab, topic).click()
    return tab.page.get_by_role("region", name=f"Message on {topic}")


def newest(tab: StudioPage) -> float:
    """The count of the robot that is shown."""
    said = tab.page.locator("[id='echo-.data'] .echo-value").inner_text()
    return float(said.strip("[]"))


def test_t3_a_source_of_30_hz_reads_29_to_31_in_its_row(tab: StudioPage):
    panel(tab, "topics")

    def rate_hz() -> float:
        found = re.search(r"([\d.]+) Hz", row(tab, "/count").inner_text())
        return float(found[1]) if found else 0.0

    wait_until("29 to 31 Hz", lambda: 29 <= rate_hz() <= 31)


@pytest.fixture
def viewer(browser: Browser, studio: RunningStudio, tab: StudioPage) -> Iterator[StudioPage]:
    """A tab of somebody who came by the address for viewers."""
    del tab  # has connected
    assert studio.process.stdout is not None
    address = studio.process.stdout.readline().removeprefix("Viewer: ").strip()
    context = studio_context(browser)
    made = StudioPage(context.new_page())
    made.open(address, view=False)
    made.page.keyboard.press("Control+2")
    yield made
    assert made.errors == []
    context.close()


def sees_everything(viewer: StudioPage) -> None:
    echo(viewer, "/count")
    wait_until("the count", lambda: newest(viewer) > 0)
    for name, part in SEEN.items():
        panel(viewer, name).get_by_text(part, exact=True).first.wait_for()
    panel(viewer, "graph").get_by_role("button", name="Node /robot").wait_for()


def finds_all_operations_shut(viewer: StudioPage) -> None:
    for name, (choice, button) in SHUT.items():
        shown = panel(viewer, name)
        if choice:
            shown.get_by_role("button", name=choice).first.click()
        assert shown.get_by_role("button", name=button).first.is_disabled()
        shown.get_by_text(re.compile("You are looking: ask for control")).wait_for()


def test_v7_a_viewer_sees_everything_and_does_nothing(viewer: StudioPage):
    sees_everything(viewer)
    finds_all_operations_shut(viewer)
    refused = {command: do(viewer, command) for command in DOING}
    words = {one: f"A guest may not {one.replace('_', ' ')}: ask the presenter." for one in DOING}
    assert refused == words


def a_publisher_falls_silent(tab: StudioPage, robot: FaultyRobot) -> None:
    said = echo(tab, "/count")
    wait_until("its count", lambda: newest(tab) > 0)
    robot.fall_silent()
    said.get_by_text("No message for").wait_for()
    wait_until("its row says so", lambda: "silent" in row(tab, "/count").inner_text())
    robot.speak_again()
    said.get_by_text("No message for").wait_for(state="detached")


def a_type_is_unknown_until_somebody_adds_it(tab: StudioPage) -> None:
    said = echo(tab, "/strange")
    said.get_by_text(f'The type "{STRANGE}" cannot be used').wait_for()
    assert "6f 64 64" in said.locator(".topics-hex").inner_text()
    do(tab, "add_interfaces")
    wait_until("it is read", lambda: "odd" in tab.page.locator("[id='echo-.data']").inner_text())


def bytes_are_no_message(tab: StudioPage, robot: FaultyRobot) -> None:
    said = echo(tab, "/cut")
    said.get_by_text("for which it has too few bytes").wait_for()
    robot.send_whole()
    said.get_by_text("for which it has too few bytes").wait_for(state="detached")
    wait_until("the next whole one is read", lambda: newest(tab) > 0)


def a_call_gets_no_answer(tab: StudioPage) -> None:
    services = panel(tab, "services")
    services.get_by_role("button", name="/silent").click()
    box = services.get_by_label("Time-out in seconds")
    box.fill("1")
    box.press("Enter")
    services.get_by_role("button", name="Call", exact=True).click()
    services.get_by_role("alert").filter(has_text="gave no answer within 1 s").wait_for()


def a_goal_is_rejected(tab: StudioPage) -> None:
    actions = panel(tab, "actions")
    actions.get_by_role("button", name="/fibonacci").click()
    actions.get_by_role("textbox", name="order").fill(str(UNWANTED))
    actions.get_by_role("button", name="Send goal").click()
    actions.get_by_role("alert").filter(has_text="does not accept this goal").wait_for()


def a_tab_sleeps(tab: StudioPage, robot: FaultyRobot) -> None:
    """What it wakes up to is what is, not what was while it slept."""
    echo(tab, "/count")
    wait_until("its count", lambda: newest(tab) > 0)
    devtools: Any = tab.page.context.new_cdp_session(tab.page)
    devtools.send("Page.setWebLifecycleState", {"state": "frozen"})
    asleep = robot.count
    wait_until("the robot to count on", lambda: robot.count > asleep + 60)
    devtools.send("Page.setWebLifecycleState", {"state": "active"})
    wait_until("the newest", lambda: newest(tab) > asleep + 60)


def the_router_is_killed(tab: StudioPage, endpoint: str, router: RunningDemo) -> None:
    router.stop(signal.SIGKILL)
    for name in (*DEEDS, *OTHERS):
        shown = panel(tab, name)
        shown.get_by_role("status").filter(has_text=GONE.format(endpoint)).wait_for()
        assert "Connected." not in shown.inner_text()
    services = panel(tab, "services")
    services.get_by_role("button", name="Call", exact=True).click()
    services.get_by_text("so no node can be reached").wait_for()


def the_router_is_back(tab: StudioPage, robot: FaultyRobot) -> None:
    before = robot.count
    echo(tab, "/count")
    wait_until("what comes now", lambda: newest(tab) > before)
    assert tab.page.get_by_text("is gone: start it there again").count() == 0


def do(tab: StudioPage, command: str) -> str:
    """Have the page send it; the type of the answer, or why it was refused."""
    return tab.page.evaluate(_SEND, {"type": command, **DOING[command]})


@pytest.mark.sweep
def test_each_fault_is_said_in_a_sentence_and_heals(
    tab: StudioPage, robot: FaultyRobot, router: RunningDemo, endpoint: str
):
    a_publisher_falls_silent(tab, robot)
    a_type_is_unknown_until_somebody_adds_it(tab)
    bytes_are_no_message(tab, robot)
    a_call_gets_no_answer(tab)
    a_goal_is_rejected(tab)
    a_tab_sleeps(tab, robot)
    the_router_is_killed(tab, endpoint, router)
    with router_process(endpoint):
        the_router_is_back(tab, robot)
    assert tab.errors == []
