"""Opening another robot out of the page, and pointing at the folder of a missing package."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.packages import write_package
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

ASKS = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:include filename="$(find parts)/base.xacro"/></robot>'
)
BASE = (
    '<robot><link name="base"><visual><geometry><sphere radius="1"/></geometry></visual></link>'
    "</robot>"
)


def test_another_robot_is_opened_out_of_the_served_folders(browser: Browser, tmp_path: Path):
    with running_studio(["demo"], tmp_path / "data") as studio, studio_page(browser, studio) as tab:
        tab.page.get_by_role("button", name="Documents").click()
        tab.page.get_by_role("menuitem", name="Open a robot").click()
        dialog = tab.page.get_by_role("dialog", name="Open a robot")
        dialog.get_by_role("button", name="Open r2d2_description", exact=True).click()
        tab.page.wait_for_url("**/d/r2d2")
        wait_until("it to be drawn", tab.has_drawn_robot)
        assert tab.errors == []


def test_a_missing_package_is_pointed_at_and_the_robot_appears(browser: Browser, tmp_path: Path):
    package = write_package(tmp_path / "ws" / "asks", files={"urdf/r.urdf.xacro": ASKS})
    elsewhere = write_package(tmp_path / "elsewhere" / "parts", files={"base.xacro": BASE})
    options = ["open", str(package)]
    with running_studio(options, tmp_path / "data") as studio:
        context = browser.new_context(viewport={"width": 1280, "height": 720})
        tab = StudioPage(context.new_page())
        tab.page.goto(studio.url)
        tab.page.get_by_role("button", name="Choose its folder").first.click()
        tab.page.get_by_label("Or type the path of its folder").fill(str(elsewhere))
        tab.page.get_by_role("button", name="Use this folder").click()
        wait_until("the robot to be drawn", tab.has_drawn_robot)
        assert tab.errors == []
        context.close()
