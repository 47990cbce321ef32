"""The Bag panel: what a bag holds, a topic marked, and a form to record the next."""

from __future__ import annotations

import base64
import io
import zipfile
from typing import TYPE_CHECKING, Final

import pytest
from axe_playwright_python.base import AXE_SCRIPT

from tests.support.number_bags import write_numbers
from tests.support.panel_pictures import SHOW_PANEL
from tests.support.studio_page import wait_until
from tests.support.timeline import RULER_Y_PX, messages, shown_bag, write_chatter

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Browser, Page

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

PREPARE: Final = """async (line) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/recording.js", script))).prepareRecording(line);
}"""
DROP: Final = """([name, content]) => {
  const held = new DataTransfer();
  held.items.add(new File([Uint8Array.from(atob(content), (one) => one.charCodeAt(0))], name));
  const options = { dataTransfer: held, bubbles: true, cancelable: true };
  document.querySelector("main").dispatchEvent(new DragEvent("drop", options));
}"""
AXE: Final = """async () => {
  const places = { include: [[".timeline"], [".bag"]] };
  return (await axe.run(places)).violations;
}"""
FORM: Final = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/recording.js", script))).recordForm.value;
}"""

WRITE: Final = """async (share) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/recording.js", script))).writtenShare.value = share;
}"""


def test_the_contents_of_a_bag_are_listed_and_a_topic_is_marked(browser: Browser, tmp_path: Path):
    with shown_bag(browser, tmp_path) as timeline:
        page = timeline.tab.page
        page.evaluate(SHOW_PANEL, "bag")
        panel = page.get_by_role("region", name="Bag", exact=True)
        panel.get_by_text("drive.mcap", exact=True).first.wait_for()
        panel.get_by_text("0:10.000").wait_for()
        row = panel.get_by_role("row", name="/chatter")
        assert str(len(messages())) in row.inner_text()
        row.get_by_role("button", name="Mark /chatter on the timeline").click()
        assert page.locator(".timeline-topic").input_value() == "/chatter"
        how_far_a_part_is_written_is_shown(page)
        nothing_is_in_the_way(page)
        a_line_fills_the_form(page)
        nothing_is_in_the_way(page)


def how_far_a_part_is_written_is_shown(page: Page) -> None:
    """With a way to stop it, until it ends."""
    page.evaluate(WRITE, 0.4)
    bar = page.get_by_role("progressbar", name="Writing a bag: 40 %")
    bar.wait_for()
    nothing_is_in_the_way(page)
    page.get_by_role("button", name="Cancel", exact=True).click()  # nothing is written: harmless
    page.evaluate(WRITE, None)
    bar.wait_for(state="detached")


def nothing_is_in_the_way(page: Page) -> None:
    """axe finds nothing wrong in the panel and on the timeline."""
    page.evaluate(AXE_SCRIPT)
    found = page.evaluate(AXE)
    assert [(one["id"], [node["html"] for node in one["nodes"]]) for one in found] == []


def a_line_fills_the_form(page: Page) -> None:
    """What a pasted command line says stands in the form."""
    page.evaluate(PREPARE, {"topics": ["/tf", "/scan"], "storage": "sqlite3", "name": "drive"})
    form = page.evaluate(FORM)
    assert form["which"] == "topics"
    assert form["topics"] == ["/tf", "/scan"]
    assert form["storage"] == "sqlite3"
    assert form["name"] == "drive"
    record = page.get_by_role("button", name="Record", exact=True)
    assert record.get_attribute("aria-pressed") == "true"


@pytest.mark.parametrize("how", ["file", "zip"])
def test_a_dropped_bag_is_shown_beside_the_robot_or_by_itself(
    browser: Browser, tmp_path: Path, how: str
):
    bag = write_chatter(tmp_path / "walk.mcap")
    name, content = "walk.mcap", bag.read_bytes()
    if how == "zip":
        name, content = "walk.zip", zipped({"walk.mcap": content})
    with shown_bag(browser, tmp_path) as timeline:
        page = timeline.tab.page
        page.evaluate(SHOW_PANEL, "bag")
        timeline.button("Close").click()
        timeline.slider.wait_for(state="detached")
        held = [name, base64.b64encode(content).decode()]
        page.evaluate(DROP, held)
        window = page.get_by_role("dialog", name=f"Where shall {name} be shown?")
        window.get_by_role("button", name="Cancel").click()
        assert timeline.slider.count() == 0
        page.evaluate(DROP, held)
        window.get_by_role("button", name="Let post.urdf move by it").click()
        timeline.slider.wait_for()
        assert page.url.endswith("/d/post")
        page.locator(".timeline-title", has_text="walk").wait_for()
        page.evaluate(DROP, held)
        window.get_by_role("button", name="As a document of its own").click()
        page.wait_for_url("**/d/walk*")
        timeline.slider.wait_for()


def zipped(files: dict[str, bytes]) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as writer:
        for path, content in files.items():
            writer.writestr(path, content)
    return archive.getvalue()


def test_a_number_of_a_topic_is_plotted_and_files_are_downloaded(browser: Browser, tmp_path: Path):
    with shown_bag(browser, tmp_path, write_wave) as timeline:
        page = timeline.tab.page
        bags = tmp_path / "data" / "bags" / "kept"
        page.evaluate(SHOW_PANEL, "bag")
        panel = page.get_by_role("region", name="Bag", exact=True)
        panel.get_by_role("button", name="Plot a number of /points").click()
        page.get_by_role("menuitem", name="point.y", exact=True).click()
        plot = page.get_by_role("region", name="Plot", exact=True)
        plot.get_by_role("list", name="Lines").get_by_text("point.y").wait_for()
        timeline.drag(2.0, 4.0, RULER_Y_PX)
        timeline.button("End the loop").wait_for()
        page.evaluate(SHOW_PANEL, "bag")
        panel.get_by_role("textbox", name="Name of the bag").fill("kept")
        panel.get_by_role("button", name="Save as a bag").click()
        wait_until("the part is a bag", (bags / "metadata.yaml").is_file)
        panel.get_by_role("button", name="Bags", exact=True).click()
        panel.get_by_role("button", name="Download the files of kept").click()
        with page.expect_download() as download:
            page.get_by_role("menuitem", name="kept_0.mcap").click()
        assert download.value.path().read_bytes() == (bags / "kept_0.mcap").read_bytes()


def write_wave(file: Path) -> Path:
    """A number ten times a second."""
    return write_numbers(file, [(n * 10**8, float(n)) for n in range(101)])
