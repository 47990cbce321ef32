"""The camera goes with a frame, and what is fitted is all that is drawn."""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.messages import message
from studio.ros.types.plain import from_dict
from tests.support.demos import node_at
from tests.support.display_messages import point
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

TF, AREA = "tf2_msgs/msg/TFMessage", "geometry_msgs/msg/PolygonStamped"
FAR = [point(x, y, 0.0) for x, y in ((8, 8), (8, -8), (-8, -8), (-8, 8))]
CAMERA = """() => {
  const view = document.querySelector("iframe").contentWindow;
  const { camera, cameraControl, nodeRefFromName } = view.__viserMutable;
  const root = nodeRefFromName[""].matrixWorld;
  const inFixedFrame = (place) => place.applyMatrix4(root.clone().invert()).toArray();
  const at = (name) => {
    const place = nodeRefFromName[name]?.matrixWorld;
    return place ? inFixedFrame(camera.position.clone().setFromMatrixPosition(place)) : null;
  };
  const inPicture = ([x, y]) => {
    const seen = camera.position.clone().set(x, y, 0).applyMatrix4(root).project(camera);
    return Math.max(Math.abs(seen.x), Math.abs(seen.y)) < 1 && seen.z < 1;
  };
  return {
    eye: inFixedFrame(cameraControl.getPosition(camera.position.clone())),
    target: inFixedFrame(cameraControl.getTarget(camera.position.clone())),
    base: at("/robot/base_link"),
    dock: at("/live/followed/dock"),
    area: Object.keys(nodeRefFromName).some((name) => name.startsWith("/live/d1/")),
    corners: [[8, 8], [8, -8], [-8, -8], [-8, 8]].map(inPicture),
  };
}"""


class World:
    """Where the robot and its dock are; told again and again, as robots do."""

    def __init__(self) -> None:
        self.robot_x_m = self.dock_x_m = 0.0

    def transforms(self, stamp: Any) -> Any:  # noqa: ANN401 - messages
        rows = [
            {
                "header": {
                    "frame_id": "odom",
                    "stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec},
                },
                "child_frame_id": child,
                "transform": {"translation": point(x_m, 1.0, 0.0), "rotation": {"w": 1.0}},
            }
            for child, x_m in (("base_footprint", self.robot_x_m), ("dock", self.dock_x_m))
        ]
        return from_dict(message(TF), {"transforms": rows})


@contextmanager
def told(endpoint: str, world: World) -> Generator[None]:
    with node_at(endpoint, "teller") as node:
        frames = node.create_publisher(message(TF), "/tf", 10)
        areas = node.create_publisher(message(AREA), "/area", 10)

        def tell() -> None:
            stamp = node.get_clock().now().to_msg()
            frames.publish(world.transforms(stamp))
            header = {"frame_id": "odom", "stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec}}
            fields = {"header": header, "polygon": {"points": FAR}}
            areas.publish(from_dict(message(AREA), fields))

        node.create_timer(0.1, tell)
        yield


def go_with(tab: StudioPage, frame: str) -> None:
    """Choose the frame that the camera goes with."""
    tab.page.locator("button.target-frame").click()
    tab.page.get_by_role("menu").get_by_text(frame, exact=True).click()


def test_the_camera_goes_with_a_frame_and_fits_what_displays_draw(browser: Browser, tmp_path: Path):
    world = World()
    with (
        running_router() as endpoint,
        told(endpoint, world),
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], tmp_path / "data"
        ) as studio,
        studio.client() as client,
        studio_page(browser, studio) as tab,
    ):
        document = tab.page.url.partition("/d/")[2].partition("/")[0]

        def ask(**command: Any) -> None:  # noqa: ANN401
            answer = client.post("/api/commands", json={"document": document, **command})
            assert answer.is_success, answer.text

        def seen() -> dict[str, Any]:
            return tab.page.evaluate(CAMERA)

        def meets(name: str, x_m: float) -> Callable[[], bool]:
            """Whether a frame is there, and the camera looks at it."""

            def met() -> bool:
                now = seen()
                place: list[float] | None = now[name]
                is_there = place is not None and abs(place[0] - x_m) < 0.5
                return is_there and math.dist(place or (), now["target"]) < 1e-4

            return met

        ask(type="connect_wire")
        ask(type="set_fixed_frame", frame="odom")
        wait_until("the robot at its place", lambda: abs(seen()["base"][1] - 1.0) < 0.5)
        go_with(tab, "base_link")
        wait_until("the camera at the robot", meets("base", 0.0))
        before = seen()
        world.robot_x_m = 3.0
        wait_until("the camera to go with it", meets("base", 3.0))
        after = seen()
        for end in (before, after):
            end["offset"] = [eye - at for eye, at in zip(end["eye"], end["target"], strict=True)]
        assert after["offset"] == pytest.approx(before["offset"], abs=1e-4)

        world.dock_x_m = -2.0
        go_with(tab, "dock")
        wait_until("the camera at a frame that is no link", meets("dock", -2.0))
        world.dock_x_m = -4.0
        wait_until("the camera to go with that", meets("dock", -4.0))

        go_with(tab, "none: the camera stays")
        ask(type="add_display", kind="Polygon", topic="/area")
        wait_until("the area", lambda: seen()["area"])
        stays = seen()["target"]
        world.dock_x_m = world.robot_x_m = 0.0
        wait_until("the robot to be back", lambda: abs(seen()["base"][0]) < 0.5)
        assert seen()["target"] == pytest.approx(stays, abs=1e-6)
        assert not all(seen()["corners"])
        tab.page.get_by_role("button", name="Fit", exact=True).click()
        wait_until("all of the area in the picture", lambda: all(seen()["corners"]))
        assert tab.errors == []
