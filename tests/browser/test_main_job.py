"""The main job as a person does it: open the demo, turn a knob, see it, undo, save."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, changed_bytes, studio_page, wait_until
from tests.support.wire import free_port, running_router
from tests.support.wired_tab import connect

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

ROVER = "rover_description/urdf/rover.urdf.xacro"


def test_a_dragged_property_changes_the_pixels_is_undone_and_saved_byte_by_byte(
    tab: StudioPage, models: Path, data: Path
):
    working_copy = data / "models" / ROVER
    as_shipped = tab.settle()
    assert tab.drag_slider("wheel_radius", 0.8) != "0.105"
    tab.show_other_than(as_shipped)

    tab.page.keyboard.press("Control+z")
    wait_until("the undo", lambda: tab.box("wheel_radius").input_value() == "0.105")
    tab.show_again(as_shipped)

    value = tab.drag_slider("wheel_radius", 0.7)
    assert working_copy.read_bytes() == (models / ROVER).read_bytes()
    save = tab.page.get_by_role("button", name="Save", exact=True)
    save.click()
    tab.agree_to_save()
    wait_until("the file to be written", lambda: f'"{value}"' in working_copy.read_text())
    (difference,) = changed_bytes(models / ROVER, working_copy.read_bytes())
    assert difference[1] == difference[0].replace(b'"0.105"', f'"{value}"'.encode())
    wait_until("nothing to be unsaved", lambda: not save.is_enabled())
    assert tab.errors == []


def test_one_drag_is_one_undo_step(tab: StudioPage):
    undo = tab.page.get_by_role("button", name="Undo", exact=True)
    assert tab.drag_slider("base_length", 0.9) != "0.62"
    wait_until("the undo button", undo.is_enabled)
    undo.click()
    wait_until("the value to come back", lambda: tab.box("base_length").input_value() == "0.62")
    wait_until("nothing to be left to undo", lambda: not undo.is_enabled())


def test_a_broken_expression_says_where_and_the_last_good_model_stays(tab: StudioPage):
    before = tab.settle()
    tab.seek("wheel_radius")
    box = tab.box("wheel_radius")
    box.fill("${wheel_radiu * 2}")
    box.press("Enter")
    notice = tab.page.get_by_text("Showing the last good model")
    wait_until("the notice over the 3D view", notice.is_visible)
    wait_until("what is wrong", tab.page.get_by_text("wheel_radiu").first.is_visible)
    wait_until("where it is", tab.page.get_by_text("rover.urdf.xacro:").first.is_visible)
    assert tab.has_drawn_robot()
    tab.page.get_by_role("button", name="Undo edit").first.click()
    wait_until("the notice to go", lambda: not notice.is_visible())
    tab.show_again(before)


def test_two_documents_in_two_tabs_are_independent(
    tab: StudioPage, studio: RunningStudio, data: Path
):
    other = data / "models" / "r2d2_description" / "urdf"
    entry = next(other.glob("*.urdf.xacro"))
    with studio.client() as client:
        command = {"type": "open_path", "path": str(entry)}
        answer = client.post("/api/commands", json=command).json()
    opened = next(event for event in answer["events"] if event["type"] == "opened")
    second = StudioPage(tab.page.context.new_page())
    second.open(f"{studio.origin}/d/{opened['document']}")
    before = second.settle()
    tab.page.bring_to_front()
    assert tab.drag_slider("wheel_radius", 0.9) != "0.105"
    second.page.bring_to_front()
    second.show_again(before)
    assert second.row("wheel_radius").count() == 0
    assert not second.page.get_by_role("button", name="Save", exact=True).is_enabled()


def test_the_page_comes_back_by_itself_with_everything_as_it_was(browser: Browser, tmp_path: Path):
    port = free_port()  # one that nobody is lent while no studio holds it
    with (
        running_router() as endpoint,
        running_studio(["demo", "--connect", endpoint], tmp_path / "data", port=port) as first,
        studio_page(browser, first) as tab,
    ):
        connect(tab)
        ros = tab.page.locator(".ros-status")
        wait_until("ROS 2 to be joined", lambda: "connected" in status_of(ros))
        first.stop()
        wait_until("the page to say so", lambda: "Studio: offline" in tab.page.inner_text("body"))
        assert status_of(ros) == "ROS: unknown"
        with running_studio(
            ["demo", "--connect", endpoint], tmp_path / "data", port=port
        ) as second:
            wait_until(
                "the page to be back", lambda: "Studio: offline" not in tab.page.inner_text("body")
            )
            second.hear_sites("rover")
            wait_until("the robot to be drawn", tab.has_drawn_robot)
            assert tab.drag_slider("wheel_radius", 0.9) != "0.105"
            wait_until("ROS 2 to be joined again", lambda: "connected" in status_of(ros))


def status_of(ros: Locator) -> str:
    """What the status bar says of ROS 2, which is green where it is connected and nowhere else."""
    words = ros.inner_text().strip()
    is_green = "good" in (ros.get_attribute("class") or "").split()
    assert is_green == ("ROS: connected" in words), words
    return words
