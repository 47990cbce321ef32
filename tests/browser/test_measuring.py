"""Distances measured in 3D, in the lists and by name, and what the links weigh."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from tests.support.descriptions import robot, write
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

ODD_NAME = "<b>tip</b> 'é🤖"
BODY = """
<xacro:property name="reach" value="0.3"/>
<xacro:macro name="inertial" params="kg at"><inertial><origin xyz="${at}"/><mass value="${kg}"/>
  <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></xacro:macro>
<link name="base"><visual><origin xyz="0 0 0.1"/><geometry><box size="0.4 0.3 0.2"/></geometry>
  </visual><xacro:inertial kg="3" at="0 0 0.1"/></link>
<link name="arm"><visual><geometry><box size="0.05 0.05 0.05"/></geometry></visual>
  <xacro:inertial kg="1" at="0.2 0 0"/></link>
<link name="&lt;b>tip&lt;/b> 'é🤖"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
  <origin xyz="0.1 0 0.2"/><axis xyz="0 0 1"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="arm"/><child link="&lt;b>tip&lt;/b> 'é🤖"/>
  <origin xyz="${reach} 0 0"/><axis xyz="1 0 0"/>
  <limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
"""
_PLACE_OF = """([link, point]) => {
  const frame = document.querySelector("iframe");
  const { camera, canvas, nodeRefFromName } = frame.contentWindow.__viserMutable;
  const { matrixWorld } = nodeRefFromName[`/robot/${encodeURIComponent(link)}`];
  const seen = camera.position.clone().set(...point).applyMatrix4(matrixWorld).project(camera);
  const { left, top } = frame.getBoundingClientRect();
  return [left + ((seen.x + 1) / 2) * canvas.clientWidth,
    top + ((1 - seen.y) / 2) * canvas.clientHeight];
}"""
_FORGET = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { deleteMeasures, stopMeasuring } =
    await import(new URL("../model/measuring.js", script));
  stopMeasuring();
  deleteMeasures();
  (await import(new URL("../model/tf.js", script))).millimetres.value = false;
}"""
_COUNT = """() => {
  window.pressed = 0;
  const count = () => { window.pressed += 1; };
  const windows = [window, document.querySelector("iframe").contentWindow];
  for (const one of windows)
    for (const type of ["pointerdown", "keydown"]) one.addEventListener(type, count, true);
}"""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    folder = tmp_path_factory.mktemp("measuring")
    file = write(folder / "robot", {"a.urdf.xacro": robot(BODY)})
    with running_studio(["open", str(file), "--viewer-link"], folder / "data") as running:
        yield running


@pytest.fixture(scope="module")
def opened(browser: Browser, studio: RunningStudio) -> Iterator[StudioPage]:
    """One tab for all tests of the file."""
    with studio_page(browser, studio) as page:
        yield page


@pytest.fixture
def tab(opened: StudioPage, studio: RunningStudio) -> Iterator[StudioPage]:
    """The same; afterwards nothing is edited, moved or measured."""
    yield opened
    opened.undo_all()
    set_joints(studio, turn=0.0)
    opened.page.evaluate(_FORGET)
    card(opened).wait_for(state="detached")


def card(tab: StudioPage) -> Locator:
    return tab.page.get_by_role("complementary", name="Measure")


def shows(tab: StudioPage, text: str, name: str = "Distance") -> None:
    """Wait until the newest measure says so."""
    output = card(tab).get_by_label(name).first
    wait_until(f"{name} {text}", lambda: output.count() == 1 and output.inner_text() == text)


def begin(tab: StudioPage) -> None:
    tab.page.keyboard.press("n")
    wait_until("the card", card(tab).is_visible)


def click_at(tab: StudioPage, link: str, point: tuple[float, float, float]) -> None:
    """Click in 3D where a point of a link is seen."""
    x, y = tab.page.evaluate(_PLACE_OF, [link, point])
    tab.page.mouse.click(x, y)


def link_row(tab: StudioPage, name: str) -> Locator:
    return tab.page.get_by_role("treeitem", name=name)


def set_joints(studio: RunningStudio, **positions: float) -> None:
    with studio.client() as client:
        (document,) = client.get("/api/documents").json()["documents"]
        command = {"type": "set_joints", "document": document["id"], "positions": positions}
        client.post("/api/commands", json=command).raise_for_status()


def test_corners_of_a_box_that_were_clicked_are_as_far_apart_as_written(tab: StudioPage):
    begin(tab)
    card(tab).get_by_role("button", name="Points").click()
    # A little inside of the upper face: from there the corner is near enough to be meant.
    click_at(tab, "base", (0.198, -0.148, 0.2))
    click_at(tab, "base", (-0.198, -0.148, 0.2))
    shows(tab, "0.4 m")
    assert "-0.4  0  0 m" in card(tab).inner_text()
    # The pixels of the mouse, without the corners: on the face, to the digit.
    tab.page.keyboard.down("Alt")
    click_at(tab, "base", (0.15, -0.1, 0.2))
    click_at(tab, "base", (-0.15, 0.1, 0.2))
    tab.page.keyboard.up("Alt")
    wait_until("the second measure", lambda: card(tab).get_by_label("Distance").count() == 2)
    shown = card(tab).get_by_label("Distance").first.inner_text()
    assert float(shown.removesuffix(" m")) == pytest.approx(math.hypot(0.3, 0.2), abs=0.005)
    assert "  0 m" in card(tab).get_by_role("listitem").first.inner_text()
    assert tab.errors == []


def test_two_joints_are_measured_with_three_clicks_and_keys_and_stay_true(
    tab: StudioPage, studio: RunningStudio
):
    tab.page.evaluate(_COUNT)
    tab.page.keyboard.press("n")
    link_row(tab, "base").click()
    link_row(tab, ODD_NAME).click()
    shows(tab, f"{math.hypot(0.4, 0.2):.6g} m")
    assert tab.page.evaluate("pressed") <= 3
    set_joints(studio, turn=math.pi / 2)
    shows(tab, f"{math.hypot(0.1, 0.3, 0.2):.6g} m")
    tab.seek("reach")
    box = tab.box("reach")
    box.fill("0.5")
    box.press("Enter")
    shows(tab, f"{math.hypot(0.1, 0.5, 0.2):.6g} m")
    card(tab).get_by_role("button", name="Lengths in millimetres").click()
    shows(tab, f"{1000 * math.hypot(0.1, 0.5, 0.2):.6g} mm")
    tab.page.get_by_role("treeitem", name="base").focus()
    tab.page.keyboard.press("Escape")
    wait_until("the end", lambda: card(tab).get_by_role("button", name="Measure more").is_visible())
    card(tab).get_by_role("button", name="Delete this measurement").click()
    wait_until("the card to go", lambda: not card(tab).is_visible())
    assert tab.errors == []


def test_who_only_looks_measures_with_the_keyboard_alone_and_has_it_after_a_reload(
    browser: Browser, studio: RunningStudio
):
    with studio_page(browser, studio, view=False, viewer=True) as viewer:
        begin(viewer)
        box = card(viewer).get_by_role("combobox")
        box.focus()
        for name in ("base", "slide"):
            viewer.page.keyboard.type(name)
            viewer.page.keyboard.press("Enter")
        shows(viewer, f"{math.hypot(0.4, 0.2):.6g} m")
        viewer.page.reload()
        shows(viewer, f"{math.hypot(0.4, 0.2):.6g} m")
        card(viewer).get_by_role("button", name="Delete all").click()
        viewer.page.reload()
        link_row(viewer, "arm").wait_for()
        assert not card(viewer).is_visible()
        assert viewer.errors == []


def test_the_masses_of_the_links_their_sum_and_centre_follow_the_joints(
    tab: StudioPage, studio: RunningStudio
):
    tab.page.get_by_role("tab", name="Masses").click()
    panel = tab.page.locator("section[aria-label='Masses']")
    centre = panel.locator(".masses-centre")
    wait_until("the centre", lambda: centre.inner_text().split()[:3] == ["0.075", "0", "0.125"])
    assert "4 kg" in panel.locator(".masses-sum").inner_text()
    set_joints(studio, turn=math.pi / 2)
    wait_until("it to move", lambda: centre.inner_text().split()[:3] == ["0.025", "0.05", "0.125"])
    names = panel.locator("tbody .link-name")
    assert names.all_inner_texts() == ["base", "arm"]
    panel.get_by_role("button", name="Density").click()
    wait_until("the denser first", lambda: names.all_inner_texts() == ["arm", "base"])
    panel.get_by_role("button", name="arm", exact=True).click()
    row = link_row(tab, "arm")
    wait_until("the tree to follow", lambda: row.get_attribute("aria-selected") == "true")
    assert tab.errors == []
