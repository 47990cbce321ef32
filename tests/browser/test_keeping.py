"""Nothing is lost: a killed studio, a save that shows itself first, files for other programs."""

from __future__ import annotations

import io
import signal
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from tests.support.packages import write_package
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, changed_bytes, studio_page, wait_until
from tests.support.wire import free_port

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from tests.support.studio_page import StudioPage as Tab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

MAST = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">\r
  <!-- é -->\r
  <xacro:property name="reach" value="0.4"/>\r
  <xacro:property name="width" value="0.1"/>\r
  <xacro:arg name="deep" default="0.1"/>\r
  <link name="mast">\r
    <visual><geometry><box size="${width} $(arg deep) ${reach}"/></geometry></visual>\r
  </link>\r
</robot>\r
"""


@pytest.fixture
def mast(tmp_path: Path) -> Path:
    package = write_package(tmp_path / "mast_description")
    entry = package / "mast.urdf.xacro"
    entry.write_bytes(b"\xef\xbb\xbf" + MAST.encode())
    return entry


def value(tab: Tab, name: str) -> str:
    tab.seek(name)
    return tab.box(name).input_value()


def undo_list(tab: Tab) -> list[str]:
    """The steps, newest first; the menu stays open."""
    tab.page.get_by_role("button", name="Undo list").click()
    return tab.page.get_by_role("menuitemradio").all_inner_texts()


def test_a_killed_studio_loses_nothing_of_what_was_done_in_the_open_page(
    browser: Browser, tmp_path: Path, mast: Path
):
    before = mast.read_bytes()
    drafts = tmp_path / "data/drafts"
    with (
        running_studio(["open", str(mast)], tmp_path / "data", port=free_port()) as first,
        studio_page(browser, first) as tab,
    ):
        page = tab.page
        reach = tab.drag_slider("reach", 0.7)
        width = tab.drag_slider("width", 0.6)
        page.keyboard.press("Control+z")
        wait_until("the undo", lambda: value(tab, "width") == "0.1")
        kept = b'"undone":[{"name":"width"'
        wait_until(
            "the draft to hold it",
            lambda: any(kept in one.read_bytes() for one in drafts.glob("*.json")),
        )
        first.stop(signal.SIGKILL)
        page.get_by_text("The studio does not answer").wait_for()
        with running_studio(["open", str(mast)], tmp_path / "data", port=first.port):
            page.get_by_text("were restored").wait_for()
            wait_until("the reach", lambda: value(tab, "reach") == reach)
            wait_until("the width", lambda: value(tab, "width") == "0.1")
            steps = [f"width 0.1 → {width}", f"reach 0.4 → {reach}", "As opened"]
            assert undo_list(tab) == steps
            page.get_by_role("menuitemradio").first.click()
            wait_until("the step to be done again", lambda: value(tab, "width") == width)
            undo_list(tab)
            page.keyboard.press("End")
            page.keyboard.press("Enter")
            wait_until("the beginning", lambda: value(tab, "reach") == "0.4")
            page.get_by_text("were restored").wait_for(state="hidden")
            assert mast.read_bytes() == before


def test_saving_shows_the_lines_and_writes_only_their_bytes(
    browser: Browser, tmp_path: Path, mast: Path
):
    before = tmp_path / "before"
    before.write_bytes(mast.read_bytes())
    with (
        running_studio(["open", str(mast)], tmp_path / "data") as studio,
        studio_page(browser, studio, view=False) as tab,
    ):
        reach = tab.drag_slider("reach", 0.7)
        page = tab.page
        page.keyboard.press("Control+s")
        window = page.get_by_role("dialog", name="Save these changes?")
        window.get_by_text("mast.urdf.xacro").wait_for()
        assert window.locator(".hunk-line.old mark").all_inner_texts() == ["0.4"]
        assert window.locator(".hunk-line.new mark").all_inner_texts() == [reach]
        tab.agree_to_save()
        wait_until("the file", lambda: mast.read_bytes() != before.read_bytes())
        old = b'  <xacro:property name="reach" value="0.4"/>'
        new = old.replace(b"0.4", reach.encode())
        assert changed_bytes(before, mast.read_bytes()) == [(old, new)]

        mast.chmod(0o444)
        tab.drag_slider("width", 0.6)
        page.keyboard.press("Control+s")
        window.get_by_text("read-only").wait_for()
        assert not window.get_by_role("button", name="Save", exact=True).is_enabled()
        window.get_by_role("button", name="Save a copy").click()
        copy = mast.with_name("mast_copy.urdf.xacro")
        wait_until("the copy", copy.exists)
        assert copy.read_bytes() != mast.read_bytes()
        assert tab.errors == []


def downloaded(tab: StudioPage, name: str) -> tuple[str, bytes]:
    """Choose an entry of the export menu; the name and the bytes of what came."""
    tab.page.get_by_role("button", name="Export").click()
    with tab.page.expect_download() as download:
        tab.page.get_by_role("menuitem", name=name, exact=True).click()
    return download.value.suggested_filename, Path(download.value.path()).read_bytes()


@pytest.mark.sweep
def test_the_robot_is_exported_as_files_and_as_pictures(
    browser: Browser, tmp_path: Path, mast: Path
):
    with (
        running_studio(["open", str(mast)], tmp_path / "data") as studio,
        studio_page(browser, studio) as tab,
    ):
        reach = tab.drag_slider("reach", 0.7)
        name, urdf = downloaded(tab, "URDF")
        assert name == "mast.urdf"
        assert f'size="0.1 0.1 {reach}"'.encode() in urdf
        name, packed = downloaded(tab, "Package with the edits (.zip)")
        assert name == "mast_description.zip"
        with zipfile.ZipFile(io.BytesIO(packed)) as archive:
            text = archive.read("mast_description/mast.urdf.xacro")
        assert text == mast.read_bytes().replace(b'"0.4"', f'"{reach}"'.encode())
        view = tab.page.locator("iframe").bounding_box()
        assert view is not None
        for entry, scale in (("Picture (.png)", 1), ("Picture without background", 2)):
            _, png = downloaded(tab, entry)
            with Image.open(io.BytesIO(png)) as image:
                assert image.width == pytest.approx(view["width"] * scale, abs=2 * scale)
                clear = image.convert("RGBA").getchannel("A").getextrema()[0] == 0
                assert clear == (entry == "Picture without background")
        assert tab.errors == []
