"""A robot that lacks an argument, a link to unsaved edits, and files changed on disk."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.packages import write_package
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, studio_page, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

_HAS_FOCUS = "one => one === document.activeElement"
MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="reach" value="0.4"/>
  <xacro:property name="width" value="0.1"/>
  <xacro:arg name="foot" default="false"/>
  <link name="$(arg side)_mast">
    <visual><geometry><box size="${width} 0.1 ${reach}"/></geometry></visual>
    <xacro:if value="${'$(arg side)' == 'left'}"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></xacro:if>
  </link>
</robot>
"""


def number(tab: StudioPage, name: str) -> str:
    return tab.box(name).input_value()


def answer_form(tab: StudioPage) -> None:
    """Give the robot what it asks for."""
    form = tab.page.get_by_role("dialog", name="Arguments of mast.urdf.xacro")
    form.get_by_text("This robot needs: side").wait_for()
    missing = form.get_by_role("combobox", name="side")
    wait_until("what lacks a value to have the focus", lambda: missing.evaluate(_HAS_FOCUS))
    missing.select_option("left")
    form.get_by_role("button", name="Apply").click()
    wait_until("the robot to be drawn", tab.has_drawn_robot)
    wait_until("the form to be gone", lambda: form.count() == 0)


def link_of(tab: StudioPage) -> str:
    """The link that the page offers to copy."""
    tab.page.get_by_role("button", name="Documents").click()
    tab.page.get_by_role("menuitem", name="Copy link").click()
    dialog = tab.page.get_by_role("dialog")
    link = dialog.get_by_label("Link", exact=True).input_value()
    dialog.get_by_role("button", name="Cancel").click()
    return link


def test_a_robot_asks_for_what_it_needs_and_a_link_opens_it_with_its_edits(
    browser: Browser, tmp_path: Path
):
    package = write_package(tmp_path / "mast_description", files={"mast.urdf.xacro": MAST})
    context = studio_context(browser)
    with running_studio(["open", str(package / "mast.urdf.xacro")], tmp_path / "data") as studio:
        tab = StudioPage(context.new_page())
        tab.page.goto(studio.url)
        answer_form(tab)
        dragged = tab.drag_slider("reach", 0.7)
        link = link_of(tab)
        other = StudioPage(context.new_page())
        other.page.goto(link)
        dialog = other.page.get_by_role("dialog", name="from this link?")
        dialog.get_by_role("button", name="Open", exact=True).click()
        other.page.wait_for_url("**/d/mast-2")
        wait_until("it to be drawn", other.has_drawn_robot)
        for one in (tab, other):  # the camera is set at the first sight of a robot
            one.open(one.page.url)
        other.show_again(tab.plain_picture())
        other.seek("reach")
        assert number(other, "reach") == dragged
        assert (tab.errors, other.errors) == ([], [])
    context.close()


def test_an_outside_write_is_merged_with_an_unsaved_drag_and_a_collision_is_a_choice(
    browser: Browser, tmp_path: Path
):
    package = write_package(tmp_path / "mast_description", files={"mast.urdf.xacro": MAST})
    entry = package / "mast.urdf.xacro"
    with (
        running_studio(["open", str(entry), "side:=left"], tmp_path / "data") as studio,
        studio_page(browser, studio) as tab,
    ):
        page = tab.page
        dragged = tab.drag_slider("reach", 0.7)
        entry.write_text(MAST.replace('value="0.1"', 'value="0.3"'))
        page.get_by_text("mast.urdf.xacro changed on disk: merged, your edit is kept").wait_for()
        assert number(tab, "reach") == dragged
        tab.seek("width")
        wait_until("what was written to be there", lambda: number(tab, "width") == "0.3")
        entry.write_text(MAST.replace('value="0.4"', 'value="0.9"'))
        page.get_by_role("button", name="Compare", exact=True).click()
        choice = page.get_by_role("dialog", name="mast.urdf.xacro changed on disk")
        wait_until("both texts", lambda: choice.locator("mark").count() == 2)
        assert choice.locator("mark").all_inner_texts() == [dragged, "0.9"]
        choice.get_by_role("radio", name="On disk").check()
        choice.get_by_role("button", name="Use these").click()
        wait_until("the choice to be gone", lambda: choice.count() == 0)
        tab.seek("reach")
        wait_until("theirs to stand", lambda: number(tab, "reach") == "0.9")
        page.get_by_role("button", name="Undo", exact=True).click()
        wait_until("mine to be back", lambda: number(tab, "reach") == dragged)
        assert tab.errors == []
