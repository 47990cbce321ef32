"""Config files on the page: opened with a report, seen in 3D, changed, saved and undone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
import yaml

from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page

    from tests.support.studio_page import StudioPage

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

CONFIG = """Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Axes, Name: Corner, Value: true, Length: 0.5}
    - {Class: moveit_rviz_plugin/MotionPlanning, Name: Planning, Value: true}
  Global Options: {Background Color: 10; 20; 30, Fixed Frame: base_link, Frame Rate: 15}
  Views:
    Current: {Class: rviz_default_plugins/TopDownOrtho, Name: Current View, Scale: 80}
Studio:
  Version: 1
  Plots:
    - {topic: /odom, path: .twist.twist.linear.x}
"""
RUN = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../lib/commands.js", script))).commandById(id).run();
}"""
BEHIND = """() => getComputedStyle(
  document.querySelector("iframe").contentDocument.documentElement,
).getPropertyValue("--view-mid").trim()"""
VIEW = "() => document.querySelector('iframe').contentWindow.studio3d?.getView().kind"
LEAVING_IS_ASKED_ABOUT = """() => {
  const leaving = new Event("beforeunload", { cancelable: true });
  window.dispatchEvent(leaving);
  return leaving.defaultPrevented;
}"""
DROP = """(text) => {
  const held = new DataTransfer();
  held.items.add(new File([text], "dropped.rviz"));
  const event = new DragEvent("drop", { dataTransfer: held, bubbles: true, cancelable: true });
  document.body.dispatchEvent(event);
}"""
PLOTS = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/plotting.js", script))).series.value.length;
}"""


def test_a_config_file_is_opened_changed_saved_and_undone(
    tab: StudioPage, data: Path, tmp_path: Path
):
    page, file = tab.page, tmp_path / "lab.studio.yaml"
    file.write_text(CONFIG)
    theme = page.evaluate(BEHIND)
    open_file(page, file)
    wait_until("the background", lambda: page.evaluate(BEHIND) == "#0a141e")
    assert page.evaluate(PLOTS) == 1
    change_and_download(page)
    file = save(page, data)
    move_the_camera_and_save_over_changes_of_others(page, file)
    page.get_by_role("treeitem", name="Background Color").get_by_role("button").click()
    wait_until("the theme's own", lambda: page.evaluate(BEHIND) == theme)
    open_another_and_go_back(page)
    drop_another(page)
    begin_with_the_view_alone(page)
    close_the_robot(page)
    assert tab.errors == []


def open_file(page: Page, file: Path) -> None:
    """The file of the robot's own package is offered; this one comes from the browser."""
    page.evaluate(RUN, "rviz_open")
    page.get_by_role("button", name="rover.rviz").wait_for()
    page.locator(".config-dialog input[type=file]").set_input_files(file)
    report = page.get_by_role("dialog", name="lab.studio.yaml is open")
    report.wait_for()
    assert "moveit_rviz_plugin/MotionPlanning" in report.inner_text()
    report.get_by_role("button", name="Close").last.click()
    page.get_by_role("treeitem", name="Corner").wait_for()
    page.get_by_role("treeitem", name="Planning").first.wait_for()
    page.get_by_text("The studio has no display moveit_rviz_plugin/MotionPlanning").wait_for()


def change_and_download(page: Page) -> None:
    rate = page.get_by_role("treeitem", name="Frame Rate").get_by_role("textbox")
    assert rate.input_value() == "15"
    rate.fill("20")
    rate.press("Enter")
    page.locator(".config-text", has_text="lab.studio.yaml •").wait_for()
    with page.expect_download() as came:
        page.evaluate(RUN, "studio_download")
    written = yaml.safe_load(came.value.path().read_text())
    manager = written["Visualization Manager"]
    assert manager["Global Options"]["Frame Rate"] == 20
    assert manager["Views"]["Current"]["Class"] == "rviz_default_plugins/TopDownOrtho"
    assert manager["Displays"][1]["Class"] == "moveit_rviz_plugin/MotionPlanning"
    assert written["Studio"]["Panels"]["parts"]
    assert written["Studio"]["Plots"] == [{"topic": "/odom", "path": ".twist.twist.linear.x"}]


def save(page: Page, data: Path) -> Path:
    """The folder of the robot's own files is proposed."""
    page.evaluate(RUN, "rviz_save_as")
    page.get_by_label("Name", exact=True).fill("mine")
    page.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
    page.locator(".config-text", has_text="mine.studio.yaml").wait_for()
    wait_until("it is saved", lambda: is_marked(page, marked=False))
    wait_until("its dialog is gone", lambda: page.get_by_role("dialog").count() == 0)
    (saved,) = data.rglob("mine.studio.yaml")
    assert "Frame Rate: 20" in saved.read_text()
    return saved


def is_marked(page: Page, *, marked: bool = True) -> bool:
    """Whether the page says everywhere that the file is not saved, or nowhere."""
    marks = {
        "•" in page.locator(".config-text").inner_text(),
        page.title().startswith("•"),
        bool(page.evaluate(LEAVING_IS_ASKED_ABOUT)),
    }
    return marks == {marked}


def move_the_camera_and_save_over_changes_of_others(page: Page, file: Path) -> None:
    """Who presents is asked on leaving, and before what others wrote is lost."""
    assert not page.evaluate(LEAVING_IS_ASKED_ABOUT)
    box = page.locator("iframe").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down(button="middle")
    page.mouse.move(x + 60, y + 30, steps=4)
    page.mouse.up(button="middle")
    wait_until("the mark", lambda: is_marked(page))
    before = file.read_text()
    file.write_text(before.replace("Frame Rate: 20", "Frame Rate: 21"))
    page.evaluate(RUN, "rviz_save")
    asked = page.get_by_role("dialog", name="Save view")
    asked.get_by_text("mine.studio.yaml changed on disk since it was opened").wait_for()
    asked.get_by_role("button", name="Cancel").click()
    assert "Frame Rate: 21" in file.read_text()
    assert is_marked(page)
    page.evaluate(RUN, "rviz_save")
    asked.get_by_role("button", name="Replace").click()
    wait_until("it is saved", lambda: is_marked(page, marked=False))
    after = file.read_text()
    assert "Frame Rate: 20" in after
    assert after != before, "the view is another"


def open_another_and_go_back(page: Page) -> None:
    """What is not saved is asked about first; those opened lately are offered until forgotten."""
    wait_until("the mark", lambda: is_marked(page))
    page.evaluate(RUN, "rviz_open")
    page.get_by_role("button", name="Go on without saving").click()
    row = page.get_by_role("listitem").filter(has=page.get_by_text("mine.studio.yaml"))
    assert "in the package" not in row.inner_text()
    forget = row.get_by_role("button", name="Remove mine.studio.yaml from the list")
    forget.click()
    row.get_by_text("in the package").wait_for()
    assert forget.count() == 0
    assert page.get_by_role("tab", name="Views").count() == 0
    page.get_by_role("button", name="rover.rviz").click()
    report = page.get_by_role("dialog", name="rover.rviz is open")
    report.get_by_role("button", name="Back to the view before").click()
    page.get_by_role("treeitem", name="Planning").first.wait_for()
    # Its panels were opened, too, behind those that are seen.
    assert page.get_by_role("tab", name="Views").get_attribute("aria-selected") == "false"


def drop_another(page: Page) -> None:
    """It asks as any other way to open one does."""
    wait_until("the mark", lambda: is_marked(page))
    page.evaluate(DROP, CONFIG.replace("Corner", "Dropped"))
    page.get_by_role("button", name="Go on without saving").click()
    report = page.get_by_role("dialog", name="dropped.rviz is open")
    report.wait_for()
    page.get_by_role("treeitem", name="Dropped", exact=True).wait_for()
    report.get_by_role("button", name="Back to the view before").click()
    page.get_by_role("treeitem", name="Corner").wait_for()


def begin_with_the_view_alone(page: Page) -> None:
    """As the address says that `--fullscreen` opens; it is said once. The view is the file's."""
    page.evaluate("location.assign('/?fullscreen=1')")
    page.get_by_role("button", name="Leave full screen").click()
    wait_until("a map", lambda: page.evaluate(VIEW) == "TopDownOrtho")
    page.locator(".top-bar").wait_for()
    assert "fullscreen" not in page.url


def close_the_robot(page: Page) -> None:
    """A file that is not saved is asked about, and stays open until the person says so."""
    wait_until("the mark", lambda: is_marked(page))
    asked = page.get_by_role("dialog", name="Unsaved view")
    page.evaluate(RUN, "close_document")
    asked.get_by_role("button", name="Cancel").click()
    asked.wait_for(state="detached")
    assert is_marked(page)
    page.evaluate(RUN, "close_document")
    asked.get_by_role("button", name="Go on without saving").click()
    page.locator(".config-text").wait_for(state="detached")
