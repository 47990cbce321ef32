"""What is found wrong is mended out of the page: a typing error, a package that is not found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.broken_snippet import PRINTED
from tests.support.packages import write_package
from tests.support.studio_page import StudioPage, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

MISSPELT = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="radius" value="0.5"/>
  <link name="ball"><visual><geometry><sphere radius="${radius}"/></geometry></vizual></link>
</robot>
"""
ASKS = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:include filename="$(find parts)/base.xacro"/></robot>'
)
BASE = (
    '<robot><link name="base"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
    "</robot>"
)


def test_row_d4_the_printed_listing_is_mended_by_one_click_and_drawn(
    shared: SharedTab, tmp_path: Path
):
    package = write_package(tmp_path / "ws" / "course", files={"urdf/robot.urdf": PRINTED})
    tab = shared.opened(shared.instead(package / "urdf/robot.urdf"))
    tab.page.get_by_role("tab", name="Problems").click()
    panel = tab.page.get_by_role("region", name="Problems", exact=True)
    for label in ("Write </robot>", 'Rename the link to "base_link"', 'Add the link "wheel_link"'):
        panel.get_by_role("button", name=label).wait_for()
    panel.get_by_role("button", name="Mend 3").click()
    tab.page.get_by_role("button", name="Undo").first.wait_for()
    buttons = panel.get_by_role("button", name="Mend")
    wait_until("nothing to be left to mend", lambda: buttons.count() == 0)
    wait_until("the mended robot to be drawn", tab.has_drawn_robot)
    for link in ("base_link", "wheel_link"):
        tab.page.get_by_text(link, exact=True).first.wait_for()
    assert tab.errors == []


def test_a_misspelt_end_tag_is_found_and_mended_by_one_click(shared: SharedTab, tmp_path: Path):
    package = write_package(tmp_path / "ws" / "ball", files={"urdf/ball.xacro": MISSPELT})
    tab = shared.opened(shared.instead(package / "urdf/ball.xacro"), view=False)
    tab.page.get_by_role("tab", name="Problems").click()
    tab.page.get_by_text("</vizual> is to close <visual> of line 3").wait_for()
    tab.page.get_by_role("button", name="Write </visual>").click()
    gone = tab.page.get_by_text("</vizual> is to close")
    wait_until("the finding to be gone", lambda: gone.count() == 0)
    tab.seek("radius")
    wait_until("the value", lambda: tab.box("radius").input_value() == "0.5")
    assert tab.errors == []


def test_a_missing_package_is_pointed_at_and_the_robot_appears(shared: SharedTab, tmp_path: Path):
    package = write_package(tmp_path / "ws" / "asks", files={"urdf/r.urdf.xacro": ASKS})
    elsewhere = write_package(tmp_path / "elsewhere" / "parts", files={"base.xacro": BASE})
    url = shared.instead(package / "urdf/r.urdf.xacro")
    tab = StudioPage(shared.page)
    tab.page.goto(url)
    tab.page.get_by_role("button", name="Choose its folder").first.click()
    tab.page.get_by_label("Or type the path of its folder").fill(str(elsewhere))
    tab.page.get_by_role("button", name="Use this folder").click()
    wait_until("the robot to be drawn", tab.has_drawn_robot)
    assert tab.errors == []
