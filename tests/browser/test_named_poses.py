"""Named poses above the joints: taken with one click, kept, renamed and deleted; viewers look."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.studio_page import StudioPage, studio_page, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Locator

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]


@pytest.fixture
def tab(tab: StudioPage) -> StudioPage:
    tab.page.get_by_role("tab", name="Joints").click()
    return tab


def pose(tab: StudioPage, name: str) -> Locator:
    poses = tab.page.get_by_role("region", name="Poses")
    return poses.locator(".pose", has_text=name).locator(".pose-choice")


def is_taken(tab: StudioPage, name: str) -> bool:
    return pose(tab, name).get_attribute("aria-pressed") == "true"


def choose(tab: StudioPage, name: str, item: str) -> None:
    tab.page.get_by_role("button", name=f"More for {name}").click()
    tab.page.get_by_role("menuitem", name=item).click()


def test_a_pose_of_the_srdf_is_taken_and_one_of_ones_own_is_kept(tab: StudioPage, data: Path):
    page = tab.page
    before = tab.settle()
    wait_until("the poses of the SRDF", lambda: pose(tab, "stowed").count() == 1)
    pose(tab, "stowed").click()
    wait_until("the arm in its pose", lambda: is_taken(tab, "stowed"))
    tab.show_other_than(before)

    page.get_by_role("button", name="Keep the current positions as a pose").click()
    page.keyboard.type("Van")
    page.keyboard.press("Enter")
    wait_until("the new pose", lambda: is_taken(tab, "Van"))
    page.get_by_role("button", name="Zero", exact=True).click()
    wait_until("the joints to leave it", lambda: not is_taken(tab, "Van"))
    choose(tab, "Van", "Rename")
    page.keyboard.type("Trailer")
    page.keyboard.press("Enter")
    wait_until("its new name", lambda: pose(tab, "Trailer").count() == 1)
    file = next((data / "models").rglob("rover.poses.yaml"))
    assert "- name: Trailer" in file.read_text()
    pose(tab, "Trailer").click()
    wait_until("the arm in its pose again", lambda: is_taken(tab, "stowed"))

    choose(tab, "Trailer", "Delete pose")
    page.get_by_role("dialog").get_by_role("button", name="Delete pose").click()
    wait_until("the pose to go", lambda: pose(tab, "Trailer").count() == 0)
    assert "Trailer" not in file.read_text()
    assert tab.errors == []


def test_whoever_only_watches_sees_the_poses_and_takes_none(
    browser: Browser, studio: RunningStudio
):
    with studio_page(browser, studio, view=False, viewer=True) as viewer:
        viewer.page.get_by_role("tab", name="Joints").click()
        wait_until("the poses", lambda: pose(viewer, "stowed").count() == 1)
        assert pose(viewer, "stowed").is_disabled()
        keep = viewer.page.get_by_role("button", name="Keep the current positions as a pose")
        assert keep.is_disabled()
        assert viewer.errors == []
