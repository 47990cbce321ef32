"""Interactive markers of a server in another process, dragged and clicked in the 3D view."""

from __future__ import annotations

import math
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import pytest

from studio.ros.interactive_markers.names import FEEDBACK, FeedbackEvent
from tests.support.demos import heard, node_at, running_demo
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_context, wait_until
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from playwright.sync_api import Browser, ViewportSize

    from studio.ros.types.classes import MessageValue

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(400)]

SMALL: Final[ViewportSize] = {"width": 1000, "height": 640}
NAMES = (
    *("simple_6dof", "fixed_6dof", "view_facing", "move_3d", "rotate_3d", "move_rotate_3d"),
    *("quadrocopter", "pan_tilt", "chess_piece", "menu", "button", "moving"),
)
"""Markers of the demo, in the order in which their numbers are given."""
QUADROCOPTER: Final = 7
SHOW_OTHERS = "studio3d.setToolProperties('Interact', { 'Hide Inactive Objects': false })"
ADD = """async () => {
  const at = (name) => new URL(name, document.querySelector('script[type="module"]').src);
  await (await import(at("../model/ros.js"))).connectRos();
  const { addDisplay, setFixedFrame } = await import(at("../model/live-displays.js"));
  await setFixedFrame("base_link");
  await addDisplay("InteractiveMarkers", "/basic_controls/update");
  const { commandById } = await import(at("../lib/commands.js"));
  commandById("panel.scene").run();
  commandById("maximize").run();
}"""
IN_VIEW = """(script) => {
  const view = document.querySelector("iframe").contentWindow;
  return new view.Function("return " + script)();
}"""
NODES = "Object.keys(__viserMutable.nodeRefFromName).filter((n) => /-body\\/c/.test(n)).length"
LOOK = "(pose) => document.querySelector('iframe').contentWindow.studio3d.setCamera(pose, false)"
PLACE = """([x, y, z]) => {
  const iframe = document.querySelector("iframe");
  const { camera, canvas, nodeRefFromName } = iframe.contentWindow.__viserMutable;
  const point = camera.position.clone().set(x, y, z);
  point.applyMatrix4(nodeRefFromName["/live"].matrixWorld).project(camera);
  const [inside, outside] = [canvas.getBoundingClientRect(), iframe.getBoundingClientRect()];
  const left = outside.left + inside.left + ((point.x + 1) / 2) * inside.width;
  return [left, outside.top + inside.top + ((1 - point.y) / 2) * inside.height];
}"""
SEEN_AT = """(name) => {
  const node = document.querySelector("iframe").contentWindow.__viserMutable.nodeRefFromName[name];
  return node ? [node.position.x, node.position.y, node.position.z] : null;
}"""
SHOWN = """[/m1-body.c1-/, /m1-body.c0-/].map((name) => Object.entries(
  __viserMutable.nodeRefFromName).find(([one]) => name.test(one))[1].visible)"""
"""Of the first marker, whether a ring and the box, which is always visible, are seen."""
HIDDEN = """Object.entries(__viserMutable.nodeRefFromName)
  .filter(([name, node]) => /-body.c/.test(name) && !node.visible)
  .map(([name]) => Number(/\\/m(\\d+)-body/.exec(name)[1]))"""
"""Numbers of the markers of which a control is not seen."""
TAKE = "(tool) => document.querySelector('iframe').contentWindow.studio3d.setTool(tool)"
CURSOR = "() => document.querySelector('iframe').contentDocument.documentElement.dataset.cursor"


class View:
    """A tab with the markers, and what their server hears."""

    def __init__(self, tab: StudioPage, feedback: list[Any]) -> None:
        self.tab, self.page, self.feedback = tab, tab.page, feedback

    def show(self) -> None:
        """Wait for the markers."""
        nodes = lambda: self.page.evaluate(IN_VIEW, NODES)  # noqa: E731
        wait_until("the markers to be drawn", lambda: nodes() > 20)

    def look(self, x: float, y: float) -> None:
        """Look at a marker on the floor from before it and above."""
        self.page.evaluate(LOOK, {"position": [x - 0.8, y - 2.2, 1.9], "target": [x, y, 0.0]})
        box = self.page.locator("iframe").bounding_box() or {"x": 0, "width": 0}
        middle = box["x"] + box["width"] / 2  # the picture never stands still: a frame moves
        wait_until("the camera to be there", lambda: abs(self.at(x, y, 0.0)[0] - middle) < 2)

    def at(self, *point: float) -> tuple[float, float]:
        """Where a point of the fixed frame is on the page."""
        left, top = self.page.evaluate(PLACE, list(point))
        return left, top

    def seen(self, marker: str) -> tuple[float, float, float]:
        """Where a marker stands in this browser, m."""
        name = f"/live/d1/m{NAMES.index(marker) + 1}-body"
        x, y, z = self.page.evaluate(SEEN_AT, name)
        return x, y, z

    def hidden(self) -> set[int]:
        """Numbers of the markers of which a control is hidden in this browser."""
        return set(self.page.evaluate(IN_VIEW, HIDDEN))

    def hover(self, *point: float) -> None:
        """Move the mouse onto a handle until it is taken for one."""
        self.page.mouse.move(*self.at(*point))
        wait_until("the handle to be met", lambda: bool(self.page.evaluate(CURSOR)))

    def drag(self, start: tuple[float, ...], end: tuple[float, ...]) -> None:
        """Press on a point of a handle and draw it to another one; the button stays down."""
        self.hover(*start)
        (x0, y0), (x1, y1) = self.at(*start), self.at(*end)
        self.page.mouse.down()
        for share in (0.3, 0.7, 1.0):
            self.page.mouse.move(x0 + share * (x1 - x0), y0 + share * (y1 - y0))

    def events(self, marker: str) -> list[str]:
        """What the server heard about a marker, by name; moves that follow one another once."""
        names = [FeedbackEvent(one.event_type).name for one in self.of(marker)]
        names = [name for name in names if name != "KEEP_ALIVE"]  # as often as it takes
        return [name for at, name in enumerate(names) if at == 0 or names[at - 1] != name]

    def of(self, marker: str) -> list[MessageValue]:
        return [one for one in list(self.feedback) if one.marker_name == marker]

    def released(self, marker: str) -> MessageValue:
        """Let go; what the server heard last."""
        self.page.mouse.up()
        wait_until("the release", lambda: self.events(marker)[-1:] == ["MOUSE_UP"])
        return self.of(marker)[-1]


@contextmanager
def markers(browser: Browser, folder: Path) -> Generator[tuple[View, str]]:
    """A studio with the markers of a server in another process; the address for who only looks."""
    with (
        running_router() as endpoint,
        running_demo(endpoint, "basic_controls"),
        node_at(endpoint, "listener") as node,
        running_studio(
            ["demo", "--viewer-link", "--connect", endpoint, "--router", "off"], folder / "data"
        ) as studio,
    ):
        feedback = heard(node, FEEDBACK, "/basic_controls/feedback")
        context = studio_context(browser, SMALL, has_touch=True)
        tab = StudioPage(context.new_page())
        tab.open(studio.url)
        tab.page.evaluate(ADD)
        view = View(tab, feedback)
        view.show()
        yield view, studio.viewer_url
        assert tab.errors == []
        context.close()


def test_a_marker_is_dragged_at_once_given_back_and_asked_for_its_menu(
    browser: Browser, tmp_path: Path
):
    with markers(browser, tmp_path) as (view, _):
        page = view.page
        view.look(-1.5, 1.5)
        view.drag((-1.05, 1.5, 0.0), (-0.75, 1.5, 0.0))
        wait_until("the marker to move", lambda: view.seen("simple_6dof")[0] > -1.3)
        wait_until("the others' handles to hide", lambda: QUADROCOPTER in view.hidden())
        assert 1 not in view.hidden()
        last = view.released("simple_6dof")
        assert view.events("simple_6dof")[:3] == ["POSE_UPDATE", "MOUSE_DOWN", "POSE_UPDATE"]
        assert (last.client_id, last.control_name) == ("/studio", "move_x")
        assert (last.header.frame_id, last.mouse_point_valid) == ("base_link", True)
        x, y, z = (getattr(last.pose.position, axis) for axis in "xyz")
        assert (x, y, z) == pytest.approx((-1.2, 1.5, 0.0), abs=0.03)
        assert view.seen("simple_6dof") == pytest.approx((x, y, z), abs=1e-5)

        wait_until("the others' handles", lambda: view.hidden() == set())
        page.evaluate(IN_VIEW, SHOW_OTHERS)
        view.drag((x - 0.45, y, 0.0), (x - 1.0, y, 0.0))
        wait_until("the marker to move", lambda: view.seen("simple_6dof")[0] < x - 0.2)
        assert view.hidden() == set()
        page.keyboard.press("Escape")
        page.mouse.up()
        wait_until("it to be back", lambda: abs(view.seen("simple_6dof")[0] - x) < 1e-5)

        view.hover(x - 0.45, y, 0.0)
        page.mouse.click(*view.at(x - 0.45, y, 0.0), button="right")
        box = page.get_by_role("menuitemcheckbox", name="With a box")
        assert box.get_attribute("aria-checked") == "true"
        page.get_by_role("menuitem", name="Submenu").press("Enter")
        page.get_by_role("menuitem", name="Entry in the submenu").press("Enter")
        wait_until("the entry", lambda: view.events("simple_6dof")[-1] == "MENU_SELECT")
        assert view.of("simple_6dof")[-1].menu_entry_id == 4


@pytest.mark.sweep
def test_every_mode_moves_what_it_should_and_who_only_looks_moves_nothing(
    browser: Browser, tmp_path: Path
):
    with markers(browser, tmp_path) as (view, address):
        every_mode_moves_what_it_should(view)
        clicks_are_heard_and_another_tool_hides_handles(view)
        viewer_moves_nothing(browser, address, view)


def every_mode_moves_what_it_should(view: View) -> None:
    view.look(-1.5, -1.5)
    angle = math.radians(-60)
    ring = (-1.5 + 0.4 * math.cos(angle), -1.5 + 0.4 * math.sin(angle), 0.0)
    view.drag(ring, (-1.0, -1.6, 0.0))
    moved = view.released("quadrocopter").pose
    grip = math.atan2(-1.6 - moved.position.y, -1.0 - moved.position.x)
    turn = 2 * math.atan2(moved.orientation.z, moved.orientation.w)
    assert grip == pytest.approx(angle + turn, abs=0.05), "what was gripped is at the mouse"

    view.look(0.0, -1.5)
    view.drag((0.2, -1.5 - 0.3464, 0.0), (0.3464, -1.5 - 0.2, 0.0))
    turned = view.released("pan_tilt").pose
    assert 2 * math.degrees(math.asin(turned.orientation.z)) == pytest.approx(30, abs=2)

    view.look(-1.5, 0.0)
    view.drag((-1.5, -0.17, 0.1), (-1.3, -0.17, 0.3))
    free = view.released("move_3d").pose.position
    assert (free.x, free.z) == pytest.approx((-1.3, 0.15), abs=0.12)
    view.look(0.0, 0.0)
    view.drag((0.0, -0.17, 0.1), (0.3, -0.17, 0.1))
    assert abs(view.released("rotate_3d").pose.orientation.w) < 0.95
    view.look(1.5, 0.0)
    view.page.keyboard.down("Control")
    view.drag((1.5, -0.17, 0.1), (1.8, -0.17, 0.1))
    both = view.released("move_rotate_3d").pose
    view.page.keyboard.up("Control")
    assert abs(both.orientation.w) < 0.95
    assert both.position.x == pytest.approx(1.5)

    view.look(1.5, -1.5)
    view.drag((1.5, -1.65, 0.05), (1.9, -1.2, 0.05))
    view.released("chess_piece")
    wait_until("the snap", lambda: view.seen("chess_piece")[:2] == pytest.approx((1.8, -1.0)))


def clicks_are_heard_and_another_tool_hides_handles(view: View) -> None:
    page = view.page
    view.look(0.0, -3.0)
    view.hover(0.0, -3.16, 0.05)
    page.mouse.click(*view.at(0.0, -3.16, 0.05))
    wait_until("the click", lambda: "BUTTON_CLICK" in view.events("button"))

    view.look(-1.5, -3.0)
    shown = lambda: page.evaluate(IN_VIEW, SHOWN)  # noqa: E731
    assert shown() == [True, True]
    page.evaluate(TAKE, "MoveCamera")
    wait_until("the handles to hide", lambda: shown() == [False, True])
    page.evaluate(TAKE, "Interact")
    wait_until("the handles", lambda: shown() == [True, True])
    page.touchscreen.tap(*view.at(-1.5, -3.16, 0.05))
    page.get_by_role("menuitem", name="First entry").press("Escape")


def viewer_moves_nothing(browser: Browser, address: str, view: View) -> None:
    """Whoever has no control is told so, and the marker stays."""
    context = studio_context(browser, SMALL)
    other = View(StudioPage(context.new_page()), view.feedback)
    other.tab.open(address)
    other.show()
    other.look(1.5, 1.5)
    before = len(view.of("view_facing"))
    other.drag((1.5, 1.35, 0.0), (1.8, 1.35, 0.0))
    other.page.get_by_text("Only who has control moves markers").wait_for()
    other.page.mouse.up()
    assert other.seen("view_facing") == pytest.approx((1.5, 1.5, 0.0))
    assert len(view.of("view_facing")) == before
    context.close()
