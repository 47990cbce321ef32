"""axe-core finds nothing on any panel or in any dialog, in both themes."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import pytest
from axe_playwright_python.base import AXE_SCRIPT

from tests.support.panel_pictures import PANEL_IDS, THEMES, Theme
from tests.support.scene_server import ASSETS
from tests.support.server import running_studio
from tests.support.studio_page import StudioPage, studio_page
from tests.support.wire import running_router
from tests.support.wired_tab import add_displays, connect, look_at_odometry

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator
    from pathlib import Path

    from playwright.sync_api import Browser

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

WITH_EXPERIMENTAL: Final = {
    "rules": {"label-content-name-mismatch": {"enabled": True}},
}
"""All rules of WCAG 2 A and AA and of best practice, and one that axe has off by itself."""
OF_COLOURS: Final = {"runOnly": ["color-contrast"]}
"""All that differs by theme; the elements are the same."""
OPTIONS: Final[dict[Theme, dict[str, Any]]] = {"dark": WITH_EXPERIMENTAL, "light": OF_COLOURS}
MERGED: Final = "urdf/rover.urdf.xacro"
OPEN_TABS: Final = ("recent", "browse", "examples", "new", "paste", "ros")
LINK: Final[dict[str, Any]] = {"text": "#robot", "arguments": 1, "files": [], "edits": 1}
OPENED: Final[dict[str, Any]] = {
    "name": "view.rviz",
    "displays": 2,
    "tools": 8,
    "views": 1,
    "view": None,
    "page": "",
    "losses": [{"reason": "no_display", "what": "x/Y", "names": []}],
}
DIALOGS: Final[dict[str, dict[str, Any]]] = {
    **{f"open {tab}": {"kind": "open", "tab": tab} for tab in OPEN_TABS},
    "save_as": {"kind": "save_as"},
    "choose_package": {"kind": "choose_package", "name": "arm"},
    "launch": {"kind": "launch", "path": ""},
    "merge": {"kind": "merge"},  # its button knows the file
    "save": {"kind": "save"},
    "share": {"kind": "share", "link": LINK},
    "graphics": {"kind": "graphics"},
    "ros": {"kind": "ros"},
    "add_display": {"kind": "add_display"},
    "rviz_open": {"kind": "rviz_open"},
    "rviz_save": {"kind": "rviz_save"},
    "rviz_opened": {"kind": "rviz_opened", "opened": OPENED},
    "layouts": {"kind": "layouts"},
    "new_package": {"kind": "new_package"},
    "add_to_package": {"kind": "add_to_package", "what": "node", "folder": "/x", "name": "x"},
    "class": {"kind": "class"},
    "class_name": {"kind": "class_name"},
    "nodes": {"kind": "nodes"},
    "remark": {"kind": "remark", "document": "x"},
    "keys": {"kind": "keys"},
    "palette": {"kind": "palette"},
    "confirm": {
        "kind": "confirm", "title": "Close", "text": "Unsaved.", "details": ["a"], "action": "Go",
    },
}  # fmt: skip
SOME_PANELS: Final = ("properties", "topics", "publish", "masses")
SOME_DIALOGS: Final = ("open browse", "add_display", "merge")
_SHOW_PANEL: Final = """async (id) => {
  const script = document.querySelector('script[type="module"]').src;
  const { PANELS, panelTitle } = await import(new URL("panels.js", script));
  (await import(new URL("../lib/commands.js", script))).commandById(`panel.${id}`).run();
  await PANELS[id].load();
  return panelTitle(id);
}"""
_SHOW_DIALOG: Final = """async (shown) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/view.js", script))).dialog.value = shown;
}"""
_SET_THEME: Final = """async (name) => {
  const script = document.querySelector('script[type="module"]').src;
  (await import(new URL("../model/view.js", script))).themeChoice.value = name;
}"""
_WHOLE: Final = "html"
_STOP_DRAWING: Final = """() => {
  document.querySelector("iframe").style.display = "none";
}"""
"""The 3D view draws a moving robot on the thread that axe needs, and axe does not look into it."""
_FAULTS: Final = """async ([part, options]) => {
  // The frame holds viser's own page: one canvas, which the trees beside it put into words.
  const found = await axe.run({ include: [[part]], exclude: [["iframe"]] },
    { ...options, resultTypes: ["violations"], iframes: false });
  return found.violations.flatMap(({ id, nodes }) => nodes.map(({ target, html, failureSummary }) =>
    `${id}: ${target.join(" ")}: ${html.slice(0, 200)}: ${failureSummary}`));
}"""


@contextmanager
def moving(browser: Browser, folder: Path, *, view: bool) -> Generator[StudioPage]:
    """A tab with a robot that moves, so that the panels have something."""
    data = folder / "data"
    with running_router() as endpoint:
        words = ["demo", "--connect", endpoint, "--router", "off"]
        with (
            running_studio(words, data, moving=True) as studio,
            studio_page(browser, studio, view=view) as tab,
        ):
            tab.page.evaluate(_STOP_DRAWING)
            connect(tab)
            add_displays(tab)
            look_at_odometry(tab)
            tab.page.get_by_role("treeitem", name="upper_arm", exact=True).click()
            let_collide(tab, data)
            tab.page.evaluate(AXE_SCRIPT)
            yield tab


@pytest.fixture
def tab(browser: Browser, tmp_path: Path) -> Iterator[StudioPage]:
    """Without the 3D view, whose tools can then not be used."""
    with moving(browser, tmp_path, view=False) as tab:
        yield tab


@pytest.fixture(scope="module")
def whole(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[StudioPage]:
    """One tab for the whole sweep."""
    with moving(browser, tmp_path_factory.mktemp("studio"), view=True) as tab:
        yield tab


def let_collide(tab: StudioPage, data: Path) -> None:
    """Change one value in the page and in the file, so that there is something to merge."""
    tab.drag_slider("base_mass", 0.7)
    file = data / "models/rover_description" / MERGED
    file.write_text(file.read_text().replace('"base_mass" value="18"', '"base_mass" value="20"'))
    tab.page.get_by_role("button", name="Compare", exact=True).wait_for()


def faults(tab: StudioPage, where: str, part: str, theme: Theme) -> list[str]:
    """What axe says of a part of the page, a selector: rule, selector, element, and how to mend."""
    found = tab.page.evaluate(_FAULTS, [part, OPTIONS[theme]])
    return [f"{where}, {theme}: {one}" for one in found]


def panel_faults(tab: StudioPage, panel: str, theme: Theme) -> list[str]:
    """What axe says of one panel, brought to the front."""
    title = tab.page.evaluate(_SHOW_PANEL, panel)
    part = f'section[aria-label="{title}"]'
    tab.page.locator(part).wait_for()
    tab.page.locator(f"{part} [role=progressbar]").wait_for(state="detached")
    return faults(tab, panel, part, theme)


def dialog_faults(tab: StudioPage, name: str, theme: Theme) -> list[str]:
    """What axe says of one dialog, opened and closed again."""
    if name == "merge":
        tab.page.get_by_role("button", name="Compare", exact=True).click()
        tab.page.get_by_role("radio", name="On disk").wait_for()
    else:
        tab.page.evaluate(_SHOW_DIALOG, DIALOGS[name])
    tab.page.locator("dialog h2").wait_for()
    if name == "save":
        tab.page.locator(".hunk-line").first.wait_for()
    found = faults(tab, name, "dialog", theme)
    tab.page.evaluate(_SHOW_DIALOG, None)
    tab.page.locator("dialog").wait_for(state="detached")
    return found


def test_axe_finds_nothing_on_the_page_nor_on_some_of_its_panels_and_dialogs(tab: StudioPage):
    found = faults(tab, "page", _WHOLE, "dark")
    for panel in SOME_PANELS:
        found += panel_faults(tab, panel, "dark")
    for name in SOME_DIALOGS:
        found += dialog_faults(tab, name, "dark")
    assert not found, "\n".join(found)


@pytest.mark.sweep
@pytest.mark.parametrize("theme", THEMES)
def test_axe_finds_nothing_on_any_panel_or_dialog(whole: StudioPage, theme: Theme):
    whole.page.evaluate(_SET_THEME, theme)
    whole.page.locator(f"html[data-theme={theme}]").wait_for()
    found = faults(whole, "page", _WHOLE, theme)
    for panel in whole.page.evaluate(PANEL_IDS):
        found += panel_faults(whole, panel, theme)
    for name in DIALOGS:
        found += dialog_faults(whole, name, theme)
    assert not found, "\n".join(found)


def test_every_dialog_is_looked_at():
    written = (ASSETS / "app/dialogs.js").read_text()
    kinds = {shown["kind"] for shown in DIALOGS.values()}
    assert set(re.findall(r'case "(\w+)"', written)) == kinds
