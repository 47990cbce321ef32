"""A day with a bag: the demo is recorded from the page, opened, and scrubbed; and live, rewound."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from tests.support.demos import node_at, running_demo
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.timeline import TRACK_Y_PX, Timeline
from tests.support.wire import running_router
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from studio.ros.client import Node

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

SHARES: Final = (0.8, 0.3, 0.55)
FIELD: Final = ".pose.pose.position.x"
MOVES_M: Final = 0.05
LINES: Final = 40
EVERY_S: Final = 0.2
NEAR: Final = 1e-6
SHOWN: Final = 1e-4
"""As near as numbers are shown, m."""
EDGE_NS: Final = 2_000
"""Times of the page are told to a microsecond."""
MOMENT: Final = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { now_s, timeState } = await import(new URL("../model/time.js", script));
  return { zero_s: timeState.value.zero_s, now_s: now_s.value, mode: timeState.value.mode };
}"""
LOOK: Final = """async ([topic, path]) => {
  const script = document.querySelector('script[type="module"]').src;
  const { chosenTopic } = await import(new URL("../model/topics.js", script));
  const { series } = await import(new URL("../model/plotting.js", script));
  chosenTopic.value = topic;
  series.value = [{ topic, path }];
}"""
ROVER: Final = """() => {
  const { nodeRefFromName } = document.querySelector("iframe").contentWindow.__viserMutable;
  const { position, quaternion: q } = nodeRefFromName["/robot"];
  return [...position.toArray(), q.w, q.x, q.y, q.z];
}"""
"""Where the root of the robot stands in the fixed frame: position in m, and quaternion."""


class Recorded:
    """What a bag holds, as `rosbags` reads it: by topic, times in ns and messages."""

    def __init__(self, folder: Path) -> None:
        self.topics: dict[str, list[tuple[int, Any]]] = {}
        store = get_typestore(Stores.ROS2_JAZZY)
        with AnyReader([folder], default_typestore=store) as reader:
            for connection, at_ns, data in reader.messages():
                message = reader.deserialize(data, connection.msgtype)
                self.topics.setdefault(connection.topic, []).append((at_ns, message))

    def until(self, topic: str, at_ns: int) -> list[Any]:
        """Return the messages up to then, the newest last."""
        return [one for stamp_ns, one in self.topics[topic] if stamp_ns <= at_ns]

    def rover(self, at_ns: int) -> list[float]:
        """Return where TF of then says that the rover stands in the odometry's frame."""
        found = [
            one.transform
            for message in self.until("/tf", at_ns)
            for one in message.transforms
            if one.child_frame_id == "base_footprint"
        ]
        place, turn = found[-1].translation, found[-1].rotation
        return [place.x, place.y, place.z, turn.w, turn.x, turn.y, turn.z]


class Day:
    """The page, in the words of who records and looks."""

    def __init__(self, tab: StudioPage) -> None:
        self.tab, self.page, self.timeline = tab, tab.page, Timeline(tab)

    def panel(self, panel: str, name: str) -> Locator:
        """Bring a panel to the front."""
        self.page.evaluate(SHOW_PANEL, panel)
        return self.page.get_by_role("region", name=name, exact=True)

    def draw_in(self, frame: str) -> None:
        """Choose the fixed frame."""
        box = self.page.get_by_role("textbox", name="Fixed frame")
        box.fill(frame)
        box.press("Enter")

    def scrub(self, share: float) -> None:
        """Drag the time there."""
        box = self.timeline.box
        y = box["y"] + min(TRACK_Y_PX, box["height"] / 2)
        self.page.mouse.move(box["x"] + box["width"] * 0.5, y)
        self.page.mouse.down()
        self.page.mouse.move(box["x"] + box["width"] * share, y, steps=6)
        self.page.mouse.up()

    def moments(self) -> set[int]:
        """Return the time that is shown, ns, as near as it is told."""
        told = self.page.evaluate(MOMENT)
        at_ns = round(told["zero_s"] * 1e9) + round(told["now_s"] * 1e9)
        return {at_ns - EDGE_NS, at_ns, at_ns + EDGE_NS}

    def rover(self) -> list[float]:
        """Return where the rover stands in the scene."""
        return self.page.evaluate(ROVER)

    def stands_as_of_then(self, bag: Recorded) -> None:
        """The rover is where TF of the time says."""

        def stands() -> bool:
            rover = self.rover()
            wanted = (bag.rover(one) for one in self.moments())
            return any(is_same_pose(rover, one) for one in wanted)

        # What the page shows right after a drag may not be the last moment that it was dragged to.
        wait_until("the rover where TF of the time says", stands)


def is_same_pose(one: list[float], other: list[float]) -> bool:
    """Whether two poses are as near as can be; a quaternion and its negative are one rotation."""
    negative = [*other[:3], *(-each for each in other[3:])]
    return any(np.allclose(one, each, rtol=0, atol=NEAR) for each in (other, negative))


@pytest.fixture(scope="module")
def wired(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path, str]]:
    """A demo at a router: its address, its data folder, and the router's."""
    data = tmp_path_factory.mktemp("day") / "data"
    with (
        running_router() as endpoint,
        running_demo(endpoint, "rover"),
        running_studio(["demo", "--router", "off", "--connect", endpoint], data) as studio,
    ):
        yield studio.url, data, endpoint


@pytest.fixture
def day(browser: Browser, wired: tuple[str, Path, str]) -> Generator[Day]:
    context = studio_context(browser)
    tab = StudioPage(context.new_page())
    tab.open(wired[0])
    connect(tab)
    yield Day(tab)
    assert tab.errors == []
    context.close()


def test_the_demo_is_recorded_from_the_page_and_every_panel_shows_the_moment(
    day: Day, wired: tuple[str, Path, str], tmp_path: Path
):
    _, data, endpoint = wired
    with node_at(endpoint, "teller") as node:
        record(day, node)
    day.page.reload()
    open_from_the_list(day)
    bag = Recorded(next((data / "bags").iterdir()))
    day.draw_in("odom")
    day.page.evaluate(LOOK, ["/odom", FIELD])
    stood: list[list[float]] = []
    for share in SHARES:
        day.scrub(share)
        day.stands_as_of_then(bag)
        stood.append(day.rover())
        moments = day.moments()
        echo_shows(day, [bag.until("/odom", one)[-1] for one in moments])
        plot_shows(day, [bag.until("/odom", one)[-1] for one in moments])
        log_shows(day, [bag.until("/rosout", one) for one in moments])
        image_shows(day, [bag.until("/camera/image_raw", one)[-1] for one in moments], tmp_path)
    assert np.ptp(np.array(stood)[:, :2], axis=0).max() > MOVES_M


def record(day: Day, node: Node) -> None:
    """Record all that is said, with lines of a log among it."""
    panel = day.panel("bag", "Bag")
    panel.get_by_role("button", name="Record", exact=True).click()
    a_bad_name_is_told_in_view(panel)
    panel.get_by_role("button", name="Start recording").click()
    expect(panel.get_by_role("button", name="Stop")).to_be_in_viewport()
    panel.get_by_role("region", name="Recording").get_by_text("/odom").wait_for()
    for number in range(LINES):
        node.get_logger().info(f"line {number}")
        time.sleep(EVERY_S)  # what is recorded takes its time
    panel.get_by_role("button", name="Stop").click()
    panel.get_by_role("region", name="Recorded").wait_for()


def a_bad_name_is_told_in_view(panel: Locator) -> None:
    """However low the panel is: beside the button, which then is of no use."""
    name = panel.get_by_role("textbox", name="Name", exact=True)
    name.fill("../drive")
    expect(name).to_have_attribute("aria-invalid", "true")
    start = panel.get_by_role("button", name="Start recording")
    expect(start).to_be_disabled()
    expect(start).to_be_in_viewport()
    expect(panel.get_by_text("The name must be that of a folder")).to_be_in_viewport()
    name.fill("")


def open_from_the_list(day: Day) -> None:
    panel = day.panel("bag", "Bag")
    panel.get_by_role("button", name="Bags", exact=True).click()
    panel.get_by_role("button", name=re.compile("^rosbag2_")).first.click()
    day.page.wait_for_url("**/d/rosbag2*")
    wait_until("the robot of the bag", day.tab.has_drawn_robot)
    day.timeline.slider.wait_for()


def echo_shows(day: Day, then: list[Any]) -> None:
    """The newest message of then, as a tree."""
    stamps = {f"{one.header.stamp.sec}.{one.header.stamp.nanosec:09d}" for one in then}
    tree = day.panel("topics", "Topics").get_by_role("tree", name="Message on /odom")
    wait_until(f"{stamps}", lambda: any(one in tree.inner_text() for one in stamps))


def plot_shows(day: Day, then: list[Any]) -> None:
    """The number of then stands beside the line."""
    told = day.panel("plot", "Plot").locator(".plot-legend output").first

    def is_told() -> bool:
        text = told.inner_text().replace("\u2212", "-")
        if text == "\u2013":  # not read yet
            return False
        found = [float(one) for one in text.split(" … ")]
        wanted = [one.pose.pose.position.x for one in then]
        return any(min(found) - SHOWN <= one <= max(found) + SHOWN for one in wanted)

    wait_until("the value of then", is_told)


def log_shows(day: Day, then: list[list[Any]]) -> None:
    """The lines that were written until then, and none that came later."""
    log = day.panel("log", "Log").get_by_role("log")
    wanted = [[one.msg for one in until if one.name == "teller"] for until in then]
    wait_until(
        f"{wanted[0][-1]}",
        lambda: re.findall(r"\bline \d+", log.inner_text())[-1:] in [one[-1:] for one in wanted],
    )


def image_shows(day: Day, then: list[Any], folder: Path) -> None:
    """Every pixel of the picture of then."""
    panel = day.panel("image", "Image")
    wanted = [np.reshape(one.data, (one.height, one.width, 3)) for one in then]

    def saved() -> np.ndarray:
        with day.page.expect_download() as download:
            panel.get_by_role("button", name="Save the picture as PNG").click()
        download.value.save_as(folder / "seen.png")
        with Image.open(folder / "seen.png") as image:
            return np.asarray(image.convert("RGB"))

    wait_until("the picture", lambda: any(np.array_equal(saved(), one) for one in wanted))


def test_what_runs_is_rewound_saved_and_led_back(day: Day, wired: tuple[str, Path, str]):
    """The rover stands where it stood; what was kept is a bag; and then it moves again."""
    _, data, _ = wired
    day.draw_in("odom")
    for panel, name in (("log", "Log"), ("image", "Image")):
        day.panel(panel, name)
    day.timeline.slider.wait_for()
    first = day.rover()
    wait_until("it drives", lambda: day.rover() != first)
    kept_s(day, 4.0)
    day.scrub(0.5)
    wait_until("then", lambda: day.page.evaluate(MOMENT)["mode"] == "past")
    panel = day.panel("bag", "Bag")
    panel.get_by_role("button", name="Contents", exact=True).click()
    before = set((data / "bags").glob("*"))
    panel.get_by_role("button", name="Last 2 minutes").click()
    day.page.get_by_text(re.compile("messages")).last.wait_for()
    wait_until("a bag", lambda: len(set((data / "bags").glob("*/metadata.yaml"))) > len(before))
    (folder,) = set((data / "bags").glob("*")) - before
    day.stands_as_of_then(Recorded(folder))
    stood = day.rover()
    day.page.keyboard.press("l")
    wait_until("now", lambda: day.page.evaluate(MOMENT)["mode"] == "live")
    wait_until("it drives on", lambda: not np.allclose(day.rover()[:2], stood[:2], atol=0.01))


def kept_s(day: Day, seconds: float) -> None:
    """Wait until so much is kept."""

    def told(name: str) -> float:
        return float(day.timeline.slider.get_attribute(name) or 0)

    wait_until(
        "seconds to go back to", lambda: told("aria-valuemax") - told("aria-valuemin") > seconds
    )
