"""The camera follows a frame, and what is fitted is all that is drawn."""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.messages import message
from studio.ros.types.convert import from_dict
from tests.support.demos import node_at
from tests.support.display_messages import point
from tests.support.server import running_studio
from tests.support.studio_page import studio_page, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from httpx2 import Client
    from playwright.sync_api import Browser

    from tests.support.studio_page import StudioPage

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


class Camera:
    """What the camera of a tab sees, in a document that is told what to show."""

    def __init__(self, tab: StudioPage, client: Client) -> None:
        self.tab, self._client = tab, client
        self._document = tab.page.url.partition("/d/")[2].partition("/")[0]

    def ask(self, **command: Any) -> None:  # noqa: ANN401
        command = {"document": self._document, **command}
        answer = self._client.post("/api/commands", json=command)
        assert answer.is_success, answer.text

    def seen(self) -> dict[str, Any]:
        return self.tab.page.evaluate(CAMERA)

    def go_with(self, frame: str) -> None:
        """Choose the frame that it goes with."""
        self.tab.page.locator("button.target-frame").click()
        self.tab.page.get_by_role("menu").get_by_text(frame, exact=True).click()

    def wait_until_it_looks_at(self, name: str, x_m: float) -> dict[str, Any]:
        """A frame is there, and the camera looks at it; what is seen then."""

        def met() -> bool:
            now = self.seen()
            place: list[float] | None = now[name]
            is_there = place is not None and abs(place[0] - x_m) < 0.5
            return is_there and math.dist(place or (), now["target"]) < 1e-4

        wait_until(f"the camera at {name}, {x_m} m", met)
        return self.seen()


def offset_m(seen: dict[str, Any]) -> list[float]:
    """From what is looked at to the eye."""
    return [eye - at for eye, at in zip(seen["eye"], seen["target"], strict=True)]


def go_with_the_robot(camera: Camera, world: World) -> None:
    camera.ask(type="set_fixed_frame", frame="odom")
    wait_until("the robot at its place", lambda: abs(camera.seen()["base"][1] - 1.0) < 0.5)
    camera.go_with("base_link")
    before = camera.wait_until_it_looks_at("base", 0.0)
    world.robot_x_m = 3.0
    after = camera.wait_until_it_looks_at("base", 3.0)
    assert offset_m(after) == pytest.approx(offset_m(before), abs=1e-4)


def go_with_a_frame_that_is_no_link(camera: Camera, world: World) -> None:
    world.dock_x_m = -2.0
    camera.go_with("dock")
    camera.wait_until_it_looks_at("dock", -2.0)
    world.dock_x_m = -4.0
    camera.wait_until_it_looks_at("dock", -4.0)


def stay_and_fit(camera: Camera, world: World) -> None:
    camera.go_with("none: the camera stays")
    camera.ask(type="add_display", kind="Polygon", topic="/area")
    wait_until("the area", lambda: camera.seen()["area"])
    stays = camera.seen()["target"]
    world.dock_x_m = world.robot_x_m = 0.0
    wait_until("the robot to be back", lambda: abs(camera.seen()["base"][0]) < 0.5)
    assert camera.seen()["target"] == pytest.approx(stays, abs=1e-6)
    assert not all(camera.seen()["corners"])
    camera.tab.page.get_by_role("button", name="Fit", exact=True).click()
    wait_until("all of the area in the picture", lambda: all(camera.seen()["corners"]))


def test_the_camera_goes_with_a_frame_and_fits_what_displays_draw(browser: Browser, tmp_path: Path):
    world = World()
    with running_router() as endpoint, told(endpoint, world):
        place = ["--connect", endpoint, "--router", "off"]
        with (
            running_studio(["demo", *place], tmp_path / "data") as studio,
            studio.client() as client,
            studio_page(browser, studio) as tab,
        ):
            camera = Camera(tab, client)
            camera.ask(type="connect_wire")
            go_with_the_robot(camera, world)
            go_with_a_frame_that_is_no_link(camera, world)
            stay_and_fit(camera, world)
            assert tab.errors == []
