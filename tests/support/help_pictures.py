"""Takes the pictures of the help: `python -m tests.support.help_pictures [name ...]`.

One for each page that names one, in both themes, cut to the panel or window that it is about.
Names take only those.
"""

from __future__ import annotations

import io
import json
import sys
import tempfile
from contextlib import ExitStack, closing
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image

from tests.support.browser import open_browser
from tests.support.classmates import classmate
from tests.support.demos import running_demo
from tests.support.managed_arm import managed_arm
from tests.support.panel_pictures import SHOW_PANEL, THEMES, Theme, tab_of
from tests.support.readme_pictures import save_variant
from tests.support.run_studio import workspace
from tests.support.server import running_studio
from tests.support.student_nodes import OwnNode
from tests.support.studio_page import StudioPage, wait_until
from tests.support.wire import running_router
from tests.support.wired_tab import add_displays, connect, look_at_odometry

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Browser, FloatRect, Locator, Page

ASSETS = Path(__file__).resolve().parents[2] / "frontend_assets"
GROUP_OF: dict[str, str] = {
    path.parent.name: json.loads(path.read_text())["group"]
    for path in sorted(ASSETS.glob("panels/*/panel.json"))
}
"""What each panel is for, by its id."""
PANELS_WINDOW = (1060, 940)
"""So narrow that a panel, cut to it, is nearly as wide as the help that shows it."""
DIALOGS_WINDOW = (720, 640)
CLASS_WINDOW = (800, 760)
_CLASS_ADDRESS = "http://robots.example:8765/"
_NAMES = ("Grace", "Edsger", "Barbara", "Ada", "Donald")
OF_CLASSES = ("people", "class", "own_nodes")
"""The panel and the windows about a class, of which the demo has none."""
OF_PROGRAMS = ("packages", "launch")
"""The panels about what the owner runs, for which the demo has no folder."""
TAKEN_ELSEWHERE = ("actions", "services", "parameters", "publish", "turtlesim", "jerry", "bag")
"""Panels whose pictures `operation_pictures`, `field_pictures` and `bag_pictures` take."""
ON_THE_WIRE = sorted(
    (
        panel
        for panel, group in GROUP_OF.items()
        if group in {"watch", "act", "learn"}
        and panel not in (*TAKEN_ELSEWHERE, *OF_CLASSES, *OF_PROGRAMS)
    ),
    key=lambda panel: panel != "lessons",
)
"""Panels that show something only while a ROS 2 system is there. The node that the lesson starts
runs in the pictures after it, of both themes."""
NOT_OF_THE_DEMO = {
    *("problems", "displays"),
    *ON_THE_WIRE,
    *TAKEN_ELSEWHERE,
    *OF_CLASSES,
    *OF_PROGRAMS,
}
_HIGHEST_PX = 380
BESIDE_THE_SCENE = ("cameraview",)
"""Panels that the 3D view draws: it has to be there, too."""
DRAWN_WHOLE = ("graph", "plot")
"""Panels whose drawing fills them: cut off, it would show nothing."""
_STILL_MS = 1200
RUN = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../lib/commands.js", script))).commandById(id).run();
}"""
_ADD_CAMERA = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay, liveDisplays } = await import(new URL("../model/live-displays.js", script));
  if (!liveDisplays.value.some(({ kind }) => kind === "Camera"))
    await addDisplay("Camera", "/camera/image_raw");
}"""
_SHOW_DIALOG = """async (kind) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/view.js", script))).dialog.value = { kind };
}"""
_START_NODES = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/student-nodes.js", script))).startNodes();
}"""
_SELECT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { liveDisplays } = await import(new URL("../model/live-displays.js", script));
  const { takePicked } = await import(new URL("../model/selected-items.js", script));
  const { id: display } = liveDisplays.value.find(({ kind }) => kind === "LaserScan");
  const scan = { display, path: "0", shape: "points", node: "points", place: null };
  const take = (rows, how) =>
    takePicked({ nodes: [{ ...scan, rows }], links: [], how, left_out: 0 });
  await take([10], "replace");
  await take([11, 12, 13], "add");
}"""
_DOCK_OF = """(id) => {
  const script = document.querySelector('script[type="module"]').src;
  return import(new URL("panels.js", script)).then(({ panelTitle }) => {
    const label = [...document.querySelectorAll(".dv-tabs-container .tab-label")]
      .find((one) => one.textContent === panelTitle(id));
    const { x, y, width, height } = label.closest(".dv-groupview").getBoundingClientRect();
    return { x, y, width, height };
  });
}"""
_BROKEN = """<?xml version="1.0"?>
<robot name="cart" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="wheel_radius" value="0.1"/>
  <xacro:property name="spare" value="2"/>
  <link name="base_link">
    <visual><geometry><box size="0.4 0.3 0.1"/></geometry></visual>
  </link>
  <link name="wheel">
    <visual><geometry><cylinder radius="${wheel_radius}" length="0.04"/></geometry></visual>
  </link>
  <joint name="wheel_joint" type="revolute">
    <parent link="base_link"/>
    <child link="wheel"/>
    <axis xyz="0 1 0"/>
  </joint>
</robot>
"""
"""What has an error, a warning and notes."""


_ALONE = ("problems", "markers")
"""Pages whose pictures need a studio of their own."""
_ADD_MARKERS = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay } = await import(new URL("../model/live-displays.js", script));
  await addDisplay("InteractiveMarkers", "/basic_controls/update");
}"""
_HAS_MARKERS = """() => {
  const nodes = document.querySelector("iframe").contentWindow.__viserMutable.nodeRefFromName;
  const isPart = (name) => name.startsWith("/live/") && name.includes("-body/");
  return Object.keys(nodes).filter(isPart).length > 20;
}"""
_LOOK = "(pose) => document.querySelector('iframe').contentWindow.studio3d.setCamera(pose, false)"
_AT_MARKER = {"position": [-2.6, -0.9, 1.7], "target": [-1.5, 1.5, 0.1]}


def path_of(page: str, theme: Theme) -> Path:
    """The picture of a page of the help: in the folder of the panel that it is about, if it is."""
    name = f"panels/{page}/help" if page in GROUP_OF else f"help/pictures/{page}"
    return ASSETS / f"{name}-{theme}.webp"


class Camera:
    """Writes what a page shows, for one theme."""

    def __init__(self, tab: StudioPage, theme: Theme) -> None:
        self.tab, self.page = tab, tab.page
        self._theme: Theme = theme

    def take(self, name: str, box: FloatRect, highest_px: int = _HIGHEST_PX) -> None:
        """Cut the page to the box, no higher than a page of the help bears."""
        self.page.mouse.move(2, 2)
        self.page.wait_for_timeout(_STILL_MS)
        clip: FloatRect = {**box, "height": min(box["height"], highest_px)}
        with Image.open(io.BytesIO(self.page.screenshot(clip=clip))) as picture:
            path_of(name, self._theme).write_bytes(as_webp(picture))

    def take_part(self, name: str, part: Locator, highest_px: int = _HIGHEST_PX) -> None:
        # It grows while what it shows arrives.
        self.page.wait_for_timeout(_STILL_MS)
        box = part.bounding_box()
        assert box is not None, name
        self.take(name, box, highest_px)


def as_webp(picture: Image.Image) -> bytes:
    """The smaller of two: text is smaller (and sharper) of 64 colours and without loss, 3D with."""
    rgb = picture.convert("RGB")
    few = rgb.quantize(64, method=Image.Quantize.MAXCOVERAGE, kmeans=2, dither=Image.Dither.NONE)
    lossy, lossless = io.BytesIO(), io.BytesIO()
    rgb.save(lossy, "WEBP", quality=65, method=6)
    few.convert("RGB").save(lossless, "WEBP", lossless=True, quality=80, method=6)
    return min(lossy.getvalue(), lossless.getvalue(), key=len)


def wanted(name: str) -> bool:
    """Whether the command line asks for it."""
    return not sys.argv[1:] or name in sys.argv[1:]


def take_panels(camera: Camera) -> None:
    """Each panel in front, cut to it."""
    camera.page.get_by_role("treeitem", name="upper_arm", exact=True).click()
    for panel in GROUP_OF:
        if wanted(panel) and panel not in NOT_OF_THE_DEMO:
            camera.page.evaluate(SHOW_PANEL, panel)
            camera.take(panel, camera.page.evaluate(_DOCK_OF, panel))


def take_measuring(camera: Camera) -> None:
    """The distance between two links, chosen in the tree; with the card over the 3D view."""
    page = camera.page
    page.evaluate(SHOW_PANEL, "displays")
    page.evaluate(RUN, "measure")
    for name in ("left_finger", "mast"):
        page.get_by_role("treeitem", name=name, exact=True).click()
    camera.take("measuring", page.evaluate(_DOCK_OF, "scene"), highest_px=PANELS_WINDOW[1])


def show_changes(camera: Camera) -> None:
    """The window before saving, with one edit in it."""
    camera.page.evaluate(SHOW_PANEL, "properties")
    camera.tab.drag_slider("wheel_radius", 0.6)
    camera.page.evaluate(RUN, "save")


def show_graphics(camera: Camera) -> None:
    """The window that the note over a slow 3D view opens."""
    camera.page.evaluate(_SHOW_DIALOG, "graphics")


def search(camera: Camera) -> None:
    camera.page.evaluate(RUN, "palette")
    camera.page.locator(".palette-input").fill("wheel")


def run(command: str) -> Callable[[Camera], None]:
    return lambda camera: camera.page.evaluate(RUN, command)


WINDOWS: dict[str, Callable[[Camera], None]] = {
    "open": run("open"),
    "arguments": run("arguments"),
    "search": search,
    "keys": run("keys"),
    "layouts": run("layouts"),
    "graphics": show_graphics,
    "rviz": run("rviz_open"),
    "saving": show_changes,
}


def take_windows(camera: Camera) -> None:
    """Each window over the page, cut to it."""
    page = camera.page
    for name, show in WINDOWS.items():
        if wanted(name):
            show(camera)
            page.locator("dialog").wait_for()
            camera.take_part(name, page.locator("dialog"))
            page.keyboard.press("Escape")
    if wanted("saving"):
        page.evaluate(RUN, "undo")
    if wanted("export"):
        page.get_by_role("button", name="Export", exact=True).click()
        camera.take_part("export", page.get_by_role("menu"))


def take_problems(page: Page, camera: Camera) -> None:
    page.evaluate(SHOW_PANEL, "problems")
    page.locator(".problem-row, [role=treeitem]").first.wait_for()
    camera.take("problems", page.evaluate(_DOCK_OF, "problems"))


def take_demo(browser: Browser, data: Path) -> None:
    """All pages but that of the problems, of which the demo has none."""
    with running_studio(["demo"], data) as studio:
        for theme in THEMES:
            with tab_of(browser, studio, theme, PANELS_WINDOW) as tab:
                if theme == THEMES[0] and wanted("variants"):
                    save_variant(tab, "Road", "small wheels")
                camera = Camera(tab, theme)
                take_panels(camera)
                if wanted("measuring"):
                    take_measuring(camera)
            with tab_of(browser, studio, theme, DIALOGS_WINDOW) as tab:
                take_windows(Camera(tab, theme))


def show_lesson(page: Page) -> None:
    """That of the talker, which runs; of a picture before it runs already."""
    page.get_by_role("navigation", name="Lessons").get_by_text("talker", exact=True).last.click()
    start, stop = (page.get_by_role("button", name=f"{one} talker") for one in ("Start", "Stop"))
    start.or_(stop).wait_for()
    if start.is_visible():
        start.click()
    page.get_by_text("Publishing").first.wait_for()


def examine(page: Page) -> None:
    """Until the Doctor has heard enough to say all that it knows."""
    begin = page.get_by_role("button", name="Examine", exact=True)
    begin.click()
    page.locator(".doctor-live").wait_for()


def show_type(page: Page) -> None:
    page.get_by_label("Search types").fill("laser")
    page.get_by_role("button", name="sensor_msgs/msg/LaserScan").click()


def select_some(page: Page) -> None:
    """Until the panel Selection has facts."""
    page.evaluate(_SELECT)
    page.locator(".selection-facts").first.wait_for()


def show_tool(page: Page) -> None:
    """What is set of one."""
    tool = page.get_by_role("region", name="2D Goal Pose", exact=True)
    fold = tool.get_by_role("button", name="2D Goal Pose", exact=True)
    if fold.get_attribute("aria-expanded") == "false":
        fold.click()
    tool.get_by_role("button", name="Topic", exact=True).click()
    tool.evaluate("one => one.scrollIntoView()")


def show_camera(page: Page) -> None:
    """What the rover's camera sees; of the picture in the other theme the display is there."""
    page.evaluate(_ADD_CAMERA)
    page.locator(".cameraview-place canvas").wait_for()
    page.locator(".cameraview-said").wait_for(state="detached")


READY: dict[str, Callable[[Page], None]] = {
    "cameraview": show_camera,
    "doctor": examine,
    "interfaces": show_type,
    "lessons": show_lesson,
    "selection": select_some,
    "tools": show_tool,
}
"""What a panel has to show before its picture is taken."""


def take_wired(browser: Browser, data: Path) -> None:
    """Panels about ROS 2, with the graph of the demo."""
    with (
        running_router() as endpoint,
        running_studio(
            ["demo", "--connect", endpoint, "--router", "off"], data, moving=True
        ) as studio,
        managed_arm(endpoint) as arm,
    ):
        arm.tell_parts()
        for theme in THEMES:
            with tab_of(browser, studio, theme, DIALOGS_WINDOW) as tab:
                camera = Camera(tab, theme)
                connect(tab)
                if theme == THEMES[0]:
                    add_displays(tab)
                look_at_odometry(tab)
                for panel in filter(wanted, ON_THE_WIRE):
                    take_wired_panel(camera, panel)
                if wanted("ros"):
                    tab.page.evaluate(RUN, "ros")
                    tab.page.locator(".ros-report").wait_for()
                    camera.take_part("ros", tab.page.locator("dialog"))
                    tab.page.keyboard.press("Escape")
                if wanted("live"):
                    tab.page.evaluate(_SHOW_DIALOG, "add_display")
                    # A rate is there once two messages came.
                    tab.page.locator(".offer-flow.live", has_text="Hz").nth(2).wait_for()
                    camera.take_part("live", tab.page.locator("dialog"))
                    tab.page.keyboard.press("Escape")
                if wanted("displays"):
                    take_displays(camera)


def take_wired_panel(camera: Camera, panel: str) -> None:
    """One panel, alone in the window but for those that the 3D view draws."""
    page, is_alone = camera.page, panel not in BESIDE_THE_SCENE
    page.evaluate(SHOW_PANEL, panel)
    if is_alone:
        page.evaluate(RUN, "maximize")
    if ready := READY.get(panel):
        ready(page)
    page.wait_for_timeout(_STILL_MS)
    highest_px = DIALOGS_WINDOW[1] if panel in DRAWN_WHOLE else _HIGHEST_PX
    camera.take(panel, page.evaluate(_DOCK_OF, panel), highest_px)
    if is_alone:
        page.evaluate(RUN, "maximize")


def take_markers(browser: Browser, data: Path) -> None:
    """A marker of the demo with its handles, in the 3D view."""
    with (
        running_router() as endpoint,
        running_demo(endpoint, "basic_controls"),
        running_studio(["demo", "--connect", endpoint, "--router", "off"], data) as studio,
    ):
        for theme in THEMES:
            with tab_of(browser, studio, theme, DIALOGS_WINDOW) as tab:
                connect(tab)
                if theme == THEMES[0]:
                    tab.page.evaluate(_ADD_MARKERS)
                tab.page.evaluate(SHOW_PANEL, "scene")
                tab.page.evaluate(RUN, "maximize")
                wait_until("the markers", lambda: tab.page.evaluate(_HAS_MARKERS), 20)
                tab.page.evaluate(_LOOK, _AT_MARKER)
                camera = Camera(tab, theme)
                tab.settle()
                camera.take("markers", tab.page.evaluate(_DOCK_OF, "scene"))


def take_displays(camera: Camera) -> None:
    """The panel with live displays, one of which says why nothing of it is seen."""
    page = camera.page
    page.evaluate(SHOW_PANEL, "displays")
    page.evaluate(RUN, "maximize")
    page.get_by_role("treeitem", name="Robot model").click()
    page.locator(".tree-meta", has_text="10 Hz").wait_for()
    camera.take("displays", page.evaluate(_DOCK_OF, "displays"))


def take_programs(browser: Browser, folder: Path) -> None:
    """The packages of a workspace, and the plan of its launch file."""
    ws = workspace(folder / "workspace")
    arguments = ["open", str(ws), "--allow-run", str(ws), "--router", "off"]
    with running_studio(arguments, folder / "studio") as studio:
        for theme in THEMES:
            context = browser.new_context(
                viewport={"width": 1600, "height": 900}, color_scheme=theme, reduced_motion="reduce"
            )
            context.add_init_script("localStorage.setItem('studio.graphics.said', 'true')")
            tab = StudioPage(context.new_page())
            tab.page.goto(studio.url)
            tab.page.get_by_text("/hall/one").wait_for()
            camera = Camera(tab, theme)
            for panel in filter(wanted, OF_PROGRAMS):
                camera.take(panel, tab.page.evaluate(_DOCK_OF, panel))
            context.close()


def take_broken(browser: Browser, data: Path) -> None:
    """The problems of a robot that has some."""
    path = data / "cart.urdf.xacro"
    path.write_text(_BROKEN)
    with running_studio(["open", str(path)], data / "studio") as studio:
        for theme in THEMES:
            with tab_of(browser, studio, theme, PANELS_WINDOW) as tab:
                take_problems(tab.page, Camera(tab, theme))


def take_class(browser: Browser, data: Path) -> None:
    """Who is in a class, and how others join it; its address is one of documentation."""
    arguments = ["demo", "--share", "--host", "127.0.0.1", "--public-url", _CLASS_ADDRESS]
    with running_studio(arguments, data) as studio, ExitStack() as held:
        code = studio.class_code
        here = [held.enter_context(classmate(studio.origin, name, code)) for name in _NAMES]
        lanes = [held.enter_context(one.lane()) for one in here[:-1]]
        for lane, kind in zip(lanes, ("raise_hand", "ask_control"), strict=False):
            lane.ask(kind)
        for theme in THEMES:
            with tab_of(browser, studio, theme, DIALOGS_WINDOW) as tab:
                camera = Camera(tab, theme)
                tab.page.evaluate(SHOW_PANEL, "people")
                tab.page.evaluate(RUN, "maximize")
                if theme == THEMES[0]:
                    tab.page.get_by_role("button", name=f"Give control to {_NAMES[3]}").click()
                camera.take("people", tab.page.evaluate(_DOCK_OF, "people"))
            with tab_of(browser, studio, theme, CLASS_WINDOW) as tab:
                tab.page.evaluate(_SHOW_DIALOG, "class")
                tab.page.locator(".class-qr").wait_for()
                Camera(tab, theme).take("class", box_of(tab.page.locator("dialog")), 500)
            with tab_of(browser, studio, theme, CLASS_WINDOW) as tab:
                take_own_nodes(tab, Camera(tab, theme))


def take_own_nodes(tab: StudioPage, camera: Camera) -> None:
    """The line of somebody in a class, and the node that it let join."""
    tab.page.evaluate(_START_NODES)
    tab.page.evaluate(_SHOW_DIALOG, "nodes")
    line = tab.page.get_by_label("Line to paste")
    line.wait_for()
    with closing(OwnNode(line.input_value(), "temperature_sensor")):
        tab.page.get_by_role("listitem").filter(has_text="temperature_sensor").wait_for()
        camera.take_part("own_nodes", tab.page.locator("dialog"), 500)


def box_of(part: Locator) -> FloatRect:
    """Where it is."""
    box = part.bounding_box()
    assert box is not None
    return box


def main() -> None:
    """Take them all anew."""
    wired = (*ON_THE_WIRE, "live", "displays", "ros")
    for browser in open_browser():
        if not sys.argv[1:] or set(sys.argv[1:]).difference(wired, OF_CLASSES, OF_PROGRAMS, _ALONE):
            with tempfile.TemporaryDirectory() as data:
                take_demo(browser, Path(data))
        if any(map(wanted, wired)):
            with tempfile.TemporaryDirectory() as data:
                take_wired(browser, Path(data))
        if wanted("markers"):
            with tempfile.TemporaryDirectory() as data:
                take_markers(browser, Path(data) / "data")
        if any(map(wanted, OF_CLASSES)):
            with tempfile.TemporaryDirectory() as data:
                take_class(browser, Path(data) / "data")
        if any(map(wanted, OF_PROGRAMS)):
            with tempfile.TemporaryDirectory() as data:
                take_programs(browser, Path(data))
        if wanted("problems"):
            with tempfile.TemporaryDirectory() as data:
                take_broken(browser, Path(data))


if __name__ == "__main__":
    main()
