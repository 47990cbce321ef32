"""Robots that are dropped, pasted, made anew, or opened again out of the page."""

from __future__ import annotations

import base64
import io
import shutil
import zipfile
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from tests.support.broken_snippet import PRINTED
from tests.support.packages import write_package
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser, Locator, Page

    from tests.support.server import RunningStudio

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

SPHERE = '<visual><geometry><sphere radius="1"/></geometry></visual>'
OWN = f'<robot name="own"><link name="base">{SPHERE}</link></robot>'
WITH_MESH = (
    '<robot name="meshed"><link name="base"><visual><geometry>'
    '<mesh filename="package://meshed_description/meshes/tyre.stl"/>'
    "</geometry></visual></link></robot>"
)
_DRAG = """([type, target, files]) => {
  const held = new DataTransfer();
  for (const [name, content] of files)
    held.items.add(new File([Uint8Array.from(atob(content), (one) => one.charCodeAt(0))], name));
  const event = new DragEvent(type, { dataTransfer: held, bubbles: true, cancelable: true });
  document.querySelector(target).dispatchEvent(event);
}"""
"""A drag out of a file manager, which no tool for tests can begin."""
_SHOWS_THE_DOCUMENT = """() => document.querySelector("iframe")?.contentWindow.location.pathname
  === `${location.pathname}/viser/`"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("opening")


@pytest.fixture(scope="module")
def studio(folder: Path) -> Iterator[RunningStudio]:
    """A demo of somebody who opened a robot of their own the last time."""
    package = write_package(folder / "ws" / "own_robot", files={"urdf/own.urdf": OWN})
    with running_studio(["open", str(package)], folder / "data"):
        pass
    with running_studio(["demo"], folder / "data") as running:
        yield running


@pytest.fixture(scope="module")
def opened(browser: Browser, studio: RunningStudio) -> Iterator[StudioPage]:
    context = studio_context(browser)
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab = StudioPage(context.new_page())
    tab.page.set_viewport_size({"width": 1000, "height": 560})  # quickly drawn
    tab.open(studio.url)
    yield tab
    context.close()


@pytest.fixture
def tab(opened: StudioPage) -> Iterator[StudioPage]:
    """A tab, with whichever robot was opened last."""
    yield opened
    assert opened.errors == []


def wait_until_drawn(tab: StudioPage) -> None:
    """Wait until the 3D view holds the robot of the address, and not the one of before."""
    wait_until("the view of it", lambda: tab.page.evaluate(_SHOWS_THE_DOCUMENT))
    wait_until("it to be drawn", tab.has_drawn_robot)


def drag(tab: StudioPage, event: str, target: str, files: dict[str, bytes]) -> None:
    held = [(name, base64.b64encode(content).decode()) for name, content in files.items()]
    tab.page.evaluate(_DRAG, [event, target, held])


def zipped(files: dict[str, str]) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as writer:
        for path, content in files.items():
            writer.writestr(path, content)
    return archive.getvalue()


def test_a_dropped_zip_is_opened_and_drawn(tab: StudioPage):
    manifest = "<package><name>dropped</name></package>"
    content = zipped({"dropped/package.xml": manifest, "dropped/urdf/dropped.urdf": OWN})
    drag(tab, "dragenter", "header", {"robot.zip": content})
    tab.page.get_by_text("Drop to open this robot or bag").wait_for()
    drag(tab, "drop", ".drop-layer", {"robot.zip": content})
    tab.page.wait_for_url("**/d/dropped")
    wait_until_drawn(tab)


def test_a_robot_and_its_meshes_chosen_together_find_each_other(
    tab: StudioPage, models: Path, tmp_path: Path
):
    robot = tmp_path / 'a "b" <i> \'ü🤖.urdf'
    robot.write_text(WITH_MESH)
    mesh = models / "rover_description" / "meshes" / "tyre.stl"
    tab.page.keyboard.press("Control+o")
    tab.page.locator("input[type=file]").first.set_input_files([robot, mesh])
    tab.page.wait_for_url("**/d/a-b*")
    wait_until_drawn(tab)
    wait_until("its name", lambda: tab.page.get_by_text(robot.name).count() > 0)


@contextmanager
def slow_sending(page: Page) -> Generator[None]:
    """Let files go out at a megabyte a second, so that there is time to cancel."""
    network = page.context.new_cdp_session(page)
    speed = {"offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": 1 << 20}
    network.send("Network.enable")  # pyright: ignore[reportUnknownMemberType]
    network.send("Network.emulateNetworkConditions", speed)  # pyright: ignore[reportUnknownMemberType]
    yield
    network.detach()


def test_a_sending_that_is_cancelled_leaves_nothing(tab: StudioPage, folder: Path, tmp_path: Path):
    uploads = folder / "data" / "uploads"
    before = set(uploads.glob("*"))
    large = tmp_path / "large.stl"
    large.write_bytes(bytes(40 << 20))
    with slow_sending(tab.page):
        tab.page.keyboard.press("Control+o")
        tab.page.locator("input[type=file]").first.set_input_files([large])
        tab.page.get_by_text("Sending large.stl").wait_for()
        wait_until("the sending to begin", lambda: set(uploads.glob("*")) > before)
        tab.page.get_by_role("button", name="Cancel").click()
        wait_until("it to be gone", lambda: set(uploads.glob("*")) == before)
        sending = tab.page.get_by_text("Sending large.stl")
        wait_until("the page to say so", lambda: sending.count() == 0)


def test_a_pasted_text_is_drawn_at_once_and_gets_a_place_by_saving_it(tab: StudioPage):
    text = f'<link name="ball">{SPHERE}</link>'
    tab.page.evaluate("(text) => navigator.clipboard.writeText(text)", text)
    tab.page.keyboard.press("Control+v")
    tab.page.wait_for_url("**/d/untitled-1")
    wait_until_drawn(tab)
    tab.page.get_by_role("button", name="Documents").click()
    tab.page.get_by_role("menuitemradio", name="Untitled 1").wait_for()
    tab.page.get_by_role("menuitem", name="Save as").click()
    name = tab.page.get_by_role("textbox", name="Package")
    name.fill("My Ball")
    tab.page.get_by_text("has lower-case letters only").wait_for()
    name.fill("ball_description")
    tab.page.get_by_text("A good name").wait_for()
    tab.page.keyboard.press("Enter")
    tab.page.wait_for_url("**/d/ball")
    wait_until_drawn(tab)


def test_the_course_s_broken_listing_pasted_is_drawn_and_says_what_is_wrong(tab: StudioPage):
    tab.page.evaluate("(text) => navigator.clipboard.writeText(text)", PRINTED)
    tab.page.keyboard.press("Control+v")
    tab.page.wait_for_url("**/d/untitled-*")
    wait_until_drawn(tab)
    panel = tab.page.get_by_role("region", name="Problems")
    tab.page.get_by_role("tab", name="Problems").click()
    for word in ("</robot>", "base_link", "wheel_link"):
        panel.get_by_text(word).first.wait_for()


def test_a_pasted_text_that_is_no_robot_changes_nothing(tab: StudioPage):
    before = tab.page.url
    tab.page.evaluate("() => navigator.clipboard.writeText('some words')")
    tab.page.locator("iframe").click()  # the 3D view has the keys now
    tab.page.keyboard.press("Control+v")
    tab.page.get_by_text("The clipboard contains no robot description").wait_for()
    assert tab.page.url == before


def test_a_new_rover_is_drawn_with_the_keyboard_alone(tab: StudioPage):
    keys = tab.page.keyboard
    keys.press("Control+k")
    keys.type("new robot")
    tab.page.get_by_role("option", name="New robot").first.wait_for()
    keys.press("Enter")
    tab.page.get_by_role("textbox", name="Package").fill("my_rover_description")
    keys.press("Enter")
    tab.page.wait_for_url("**/d/my-rover")
    wait_until_drawn(tab)
    tab.page.get_by_role("button", name="0 problems").wait_for()


def list_served_folders(dialog: Locator) -> None:
    """Whatever the window showed last."""
    dialog.get_by_role("tab", name="Folders").click()
    dialog.get_by_role("navigation").get_by_role("button").first.click()


def test_folders_are_walked_through_and_filtered_by_keys(tab: StudioPage):
    keys, before = tab.page.keyboard, tab.page.url
    keys.press("Control+o")
    dialog = tab.page.get_by_role("dialog", name="Open a robot")
    list_served_folders(dialog)
    dialog.get_by_title("r2d2_description").first.focus()
    keys.press("Enter")
    dialog.get_by_role("navigation").get_by_text("r2d2_description").wait_for()
    dialog.get_by_role("button", name="urdf", exact=True).press("Enter")
    dialog.get_by_text("r2d2.urdf.xacro", exact=True).wait_for()
    holds_focus = "one => one.contains(document.activeElement)"
    wait_until("the focus to be in the list again", lambda: dialog.evaluate(holds_focus))
    keys.press("z")
    dialog.get_by_text("Nothing matches").wait_for()
    keys.press("Escape")
    dialog.get_by_text("r2d2.urdf.xacro", exact=True).wait_for()
    search = dialog.get_by_role("searchbox")
    search.fill("/nowhere/own.urdf")
    search.press("Enter")
    # It is told in front of the window, not behind it.
    dialog.get_by_role("alert").get_by_role("button", name="Dismiss").click()
    search.fill("")
    dialog.get_by_text("r2d2.urdf.xacro", exact=True).wait_for()
    search.press("Enter")
    tab.page.wait_for_url(lambda url: "/d/r2d2" in url and url != before)
    wait_until_drawn(tab)


def test_another_robot_is_opened_out_of_the_served_folders(tab: StudioPage):
    before = tab.page.url
    tab.page.get_by_role("button", name="Documents").click()
    tab.page.get_by_role("menuitem", name="Open a robot").click()
    dialog = tab.page.get_by_role("dialog", name="Open a robot")
    list_served_folders(dialog)
    dialog.get_by_role("button", name="Open r2d2_description", exact=True).click()
    tab.page.wait_for_url(lambda url: "/d/r2d2" in url and url != before)
    wait_until_drawn(tab)


def open_again(tab: StudioPage, file: str) -> None:
    tab.page.keyboard.press("Control+o")
    tab.page.get_by_role("tab", name="Recent").click()
    tab.page.get_by_role("dialog").get_by_role("button", name=file).first.click()


def test_ones_own_workspace_is_two_clicks_and_a_key_away_and_the_last_one_next_time(
    tab: StudioPage, folder: Path, tmp_path: Path
):
    open_again(tab, "own.urdf")
    tab.page.wait_for_url("**/d/own")
    wait_until_drawn(tab)
    shutil.copytree(folder / "data", tmp_path / "data")
    with running_studio(["open"], tmp_path / "data") as studio, studio.client() as client:
        (document,) = client.get("/api/documents").json()["documents"]
        assert document["title"] == "own.urdf"


def test_the_page_is_never_empty(tab: StudioPage, studio: RunningStudio):
    open_again(tab, "own.urdf")
    tab.page.wait_for_url("**/d/own")
    with studio.client() as client:
        for document in client.get("/api/documents").json()["documents"]:
            if document["id"] != "own":
                command = {"type": "close_document", "document": document["id"], "discard": True}
                client.post("/api/commands", json=command).raise_for_status()
    tab.page.get_by_role("button", name="Documents").click()
    tab.page.get_by_role("menuitem", name="Close").click()
    tab.page.get_by_role("heading", name="Which robot?").wait_for()
    tab.page.get_by_role("button", name="r2d2 The well-known droid").click()
    tab.page.wait_for_url("**/d/r2d2")
    wait_until_drawn(tab)
