"""The pose of a frame in another one: in three clicks, live, copied, and as yourdfpy has it."""

from __future__ import annotations

import json
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.ros.messages import message
from tests.support.demos import node_at
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until
from tests.support.wire import free_endpoint, router_at
from tests.support.yourdfpy_poses import poses_by_yourdfpy

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from playwright.sync_api import Browser, Locator

    from studio.ros.client import Node, Publisher
    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

_LIT = """() => Object.entries(
  document.querySelector("iframe").contentWindow.__viserMutable.nodeRefFromName)
  .filter(([name, node]) => name.endsWith("/studio_frame") && node)
  .map(([name]) => name.split("/").at(-2)).sort()"""
_CHAIN = """() => document.querySelector("iframe").contentDocument
  .querySelector("polyline.chain")?.getAttribute("points").split(" ").length ?? 0"""
_JOINTS = """() => [...document.querySelectorAll(".joint")].map((row) => [
  row.getAttribute("aria-label"),
  Number(row.querySelector("input[type=range]").value)])"""


@pytest.fixture
def tab(tab: StudioPage) -> StudioPage:
    tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    return tab


class Hand:
    """Counts what it does."""

    def __init__(self) -> None:
        self.clicks = 0

    def click(self, at: Locator) -> None:
        at.click()
        self.clicks += 1


def panel(tab: StudioPage) -> Locator:
    return tab.page.locator("section[aria-label='Frames']")


def link(tab: StudioPage, name: str) -> Locator:
    return tab.page.get_by_role("treeitem", name=name, exact=True)


def box(tab: StudioPage, name: str) -> str:
    return tab.page.get_by_role("combobox", name=name).input_value()


def copied(tab: StudioPage, what: str, form: str) -> str:
    tab.page.evaluate("navigator.clipboard.writeText('')")
    tab.page.get_by_role("button", name=f"Copy: {what}").first.click()
    tab.page.get_by_role("menuitem", name=form).click()
    text = ""

    def is_there() -> bool:
        nonlocal text
        text = str(tab.page.evaluate("navigator.clipboard.readText()"))
        return text != ""

    wait_until("the copied text", is_there)
    return text


def matrix(tab: StudioPage) -> NDArray[np.float64]:
    return np.array(json.loads(copied(tab, "Matrix", "Copy as a Python list")))


def shown_matrix(tab: StudioPage) -> NDArray[np.float64]:
    cells = panel(tab).locator(".frames-matrix td").all_inner_texts()
    return np.array([float(cell) for cell in cells]).reshape(4, 4)


def test_the_pose_of_one_frame_in_another_takes_three_clicks(tab: StudioPage):
    hand = Hand()
    hand.click(link(tab, "base_link"))
    hand.click(tab.page.get_by_role("button", name="Poses in this frame"))
    hand.click(link(tab, "camera_head"))
    wait_until("the pose", lambda: panel(tab).locator(".frames-matrix").count() == 1)
    assert (box(tab, "Frame whose pose is shown"), hand.clicks) == ("camera_head", 3)
    assert box(tab, "Reference frame") == "base_link"
    wait_until("both frames in 3D", lambda: tab.page.evaluate(_LIT) == ["base_link", "camera_head"])
    on_chain = panel(tab).locator(".on-chain")
    wait_until("a line through all", lambda: tab.page.evaluate(_CHAIN) == on_chain.count() >= 3)

    way = tab.page.get_by_role("list", name="Joints between the two frames")
    way.get_by_role("button", name="mast_pan_joint").click()
    wait_until(
        "the joint in the tree",
        lambda: link(tab, "camera_yoke").get_attribute("aria-selected") == "true",
    )
    assert box(tab, "Frame whose pose is shown") == "camera_head"

    there = matrix(tab)
    tab.page.get_by_role("button", name="Swap the two frames").click()
    wait_until("the other way", lambda: box(tab, "Reference frame") == "camera_head")
    assert np.abs(matrix(tab) @ there - np.eye(4)).max() < 1e-9
    assert copied(tab, "Position", "<origin").startswith('<origin xyz="')

    reference = tab.page.get_by_role("combobox", name="Reference frame")
    reference.click()
    tab.page.keyboard.type("lidar")
    tab.page.keyboard.press("Enter")
    wait_until("the lidar", lambda: box(tab, "Reference frame") == "lidar")
    tab.page.get_by_role("tab", name="Source").click()
    wait_until("no frames in 3D", lambda: tab.page.evaluate(_LIT) == [])
    wait_until("no line", lambda: tab.page.evaluate(_CHAIN) == 0)
    assert tab.errors == []


def test_poses_follow_the_joints_and_are_those_of_yourdfpy(tab: StudioPage, studio: RunningStudio):
    page = tab.page
    document = page.url.rsplit("/", 1)[1]
    with studio.client() as client:
        urdf = client.get(f"/api/documents/{document}/urdf").content
        page.get_by_role("tab", name="Joints").click()
        link(tab, "base_link").click()
        page.get_by_role("button", name="Poses in this frame").click()
        for target in ("left_finger", "left_camera_optical_frame"):
            link(tab, target).click()
            for _ in range(3):
                command = {"type": "randomize_joints", "document": document}
                client.post("/api/commands", json=command).raise_for_status()
                agrees(tab, urdf, "base_link", target)
    assert tab.errors == []


def tell_frames(node: Node) -> Publisher:
    """Tell where the rover is in odom, of a tree of its own, and what no frame can be."""
    kind = message("tf2_msgs/msg/TFMessage")
    out = node.create_publisher(kind, "/tf", 10)

    def tell() -> None:
        told = [("odom", "base_footprint", 1.5), ("moon", "crater", 2.0), ("odom", "odom", 0.0)]
        out.publish(kind(transforms=[transform(*one) for one in told]))

    node.create_timer(0.05, tell)
    return out


def transform(parent: str, child: str, x_m: float) -> object:
    one = message("geometry_msgs/msg/TransformStamped")(child_frame_id=child)
    one.header.frame_id = parent
    one.transform.translation.x = x_m
    one.transform.rotation.w = 1.0
    return one


def row(tab: StudioPage, name: str) -> Locator:
    return panel(tab).locator(f".tf-tree [role=treeitem][aria-label^='{name},']")


def said_of(tab: StudioPage, name: str) -> str:
    return " ".join(row(tab, name).all_inner_texts())


@pytest.mark.sweep
def test_frames_of_others_stand_in_the_tree_with_who_tells_of_them(
    browser: Browser, tmp_path: Path
):
    with router_at(free_endpoint()) as router, node_at(router.endpoint.text) as other:
        out = tell_frames(other)
        place = ["--connect", router.endpoint.text, "--router", "off"]
        with (
            running_studio(["demo", *place], tmp_path / "data") as studio,
            studio_page(browser, studio) as tab,
        ):
            tab.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
            tab.page.get_by_role("tab", name="Frames").click()
            wait_until("its own frames", lambda: "this robot" in said_of(tab, "base_link"))
            tab.page.get_by_role("button", name="Connect", exact=True).click()
            dialog = tab.page.get_by_role("dialog")
            dialog.get_by_role("button", name="Connect", exact=True).click()
            dialog.get_by_role("button", name="Disconnect").wait_for()
            tab.page.keyboard.press("Escape")
            name = other.get_fully_qualified_name()
            wait_until("who tells of it", lambda: name in said_of(tab, "base_footprint"))
            wait_until("how often", lambda: "Hz" in said_of(tab, "base_footprint"))
            assert "not connected" in said_of(tab, "crater")
            assert "not connected" not in said_of(tab, "odom")
            sees_the_rover_in_odom(tab)
            search = panel(tab).get_by_role("searchbox")
            search.fill("crater")
            wait_until("the way to it", lambda: panel(tab).get_by_role("treeitem").count() == 2)
            panel(tab).get_by_text("1 rejected transform").click()
            sentences = panel(tab).locator(".tf-refused li").all_inner_texts()
            assert [one.split(":")[1] for one in sentences] == [
                " a frame cannot be its own parent."
            ]
            tab.page.get_by_role("tab", name="Source").click()
            wait_until("nobody listens", lambda: out.get_subscription_count() == 0)
            assert tab.errors == []


def sees_the_rover_in_odom(tab: StudioPage) -> None:
    row(tab, "odom").focus()
    tab.page.keyboard.press("Shift+Enter")
    row(tab, "lidar").click()
    assert box(tab, "Reference frame") == "odom"
    wait_until("the pose by TF", lambda: panel(tab).locator(".frames-matrix").count() == 1)
    lit = [
        str(one.get_attribute("aria-label")).split(",")[0]
        for one in panel(tab).locator(".on-chain").all()
    ]
    assert lit == ["odom", "base_footprint", "base_link", "lidar"]
    wait_until("a frame of TF in 3D, too", lambda: tab.page.evaluate(_LIT) == ["lidar", "odom"])
    wait_until("a line through all four", lambda: tab.page.evaluate(_CHAIN) == len(lit))
    in_odom = matrix(tab)
    row(tab, "base_footprint").focus()
    tab.page.keyboard.press("Shift+Enter")
    wait_until("in the root", lambda: box(tab, "Reference frame") == "base_footprint")
    wait_until("its pose", lambda: panel(tab).locator(".frames-matrix").count() == 1)
    assert np.abs(in_odom[0, 3] - matrix(tab)[0, 3] - 1.5) < 1e-9


def agrees(tab: StudioPage, urdf: bytes, reference: str, target: str) -> None:
    """Wait until the panel shows the joints that the sliders show, then look at every digit."""
    wanted = np.zeros((4, 4))

    def follows() -> bool:
        nonlocal wanted
        positions = dict(tab.page.evaluate(_JOINTS))
        poses = poses_by_yourdfpy(BytesIO(urdf), positions)
        assert poses is not None
        wanted = np.linalg.inv(poses[reference]) @ poses[target]
        return bool(np.abs(shown_matrix(tab) - wanted).max() < 2e-5)

    wait_until(f"the pose of {target}", follows)
    assert np.abs(matrix(tab) - wanted).max() < 1e-9
