"""The frame by fingers, at twice the size, and on machines that draw slowly."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from playwright.sync_api import Browser

    from tests.support.server import RunningStudio
    from tests.support.shared_tab import SharedTab

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(300)]

FINGER_PX = 40
FINGER_SIZES = [(390, 844), (1024, 768)]
MORE_FINGER_SIZES = [
    pytest.param(size, marks=pytest.mark.sweep) for size in [(844, 390), (1180, 820)]
]
_SMALL = """(least) => [...document.querySelectorAll(
    ".top-bar button, .top-bar a, .phone-tabs button, .dv-tab, .maximize, .scene-tools button")]
  .filter((one) => one.checkVisibility())
  .filter((one) => one.getBoundingClientRect().height < least)
  .map((one) => `${one.className} ${one.getAttribute("aria-label")} ${one.offsetHeight}`)"""
_BEYOND = """() => [...document.querySelectorAll(".top-bar *, .status-bar *, .phone-tabs *")]
  .filter((one) => one.checkVisibility() && one.getBoundingClientRect().right > innerWidth + 1)
  .map((one) => one.outerHTML.slice(0, 120))"""
_OVERLAPS = """() => {
  const parts = [...document.querySelector(".top-bar").children].map((one) =>
    one.getBoundingClientRect()).filter(({ width }) => width > 0);
  return parts.slice(1).some(({ left }, at) => left < parts[at].right - 1);
}"""
_HAS_ROBOT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  return (await import(new URL("../model/document.js", script))).robot.value !== null;
}"""
_VIEW = "document.querySelector('iframe').contentWindow"
_GRAPHICS = f"() => {_VIEW}.studio3d?.graphics() ?? null"
_SHADOWS = f"""() => {{
  let count = 0;
  {_VIEW}.__viserMutable.scene.traverse((one) => {{
    count += one.isDirectionalLight && one.castShadow ? 1 : 0;
  }});
  return count;
}}"""
_SPIN = f"""() => {{
  const mutable = {_VIEW}.__viserMutable;
  const drawn = mutable.scene.onAfterRender;
  mutable.scene.onAfterRender = () => {{ drawn(); mutable.requestRender(); }};
  mutable.requestRender();
}}"""
_SLOW_UNNAMED_CARD = """() => {
  const ask = WebGL2RenderingContext.prototype.getParameter;
  WebGL2RenderingContext.prototype.getParameter = function getParameter(what) {
    return what === 0x9246 ? "Some card" : ask.call(this, what);
  };
  if (window === top) return;
  const frame = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => window.setTimeout(() => frame(draw), 300);
  window.cancelAnimationFrame = window.clearTimeout.bind(window);
}"""
"""0x9246 is UNMASKED_RENDERER_WEBGL: what draws says that it were a card. Three pictures a second
are slow on every machine, and cost it little."""


@pytest.fixture(scope="module")
def studio(shared: SharedTab) -> RunningStudio:
    return shared.anew()


@contextmanager
def frame_of(
    browser: Browser,
    studio: RunningStudio,
    size: tuple[int, int],
    **more: Any,  # noqa: ANN401 - what playwright takes
) -> Generator[StudioPage]:
    """A tab of that size, without the 3D view."""
    context = studio_context(browser, {"width": size[0], "height": size[1]}, **more)
    context.add_cookies([{"name": "without_view", "value": "1", "url": studio.origin}])
    tab = StudioPage(context.new_page())
    tab.page.goto(studio.url)
    wait_until("the robot", lambda: bool(tab.page.evaluate(_HAS_ROBOT)))
    tab.stand_still()
    yield tab
    assert tab.errors == []
    context.close()


@contextmanager
def drawn(
    browser: Browser, studio: RunningStudio, scale: float, script: str = ""
) -> Generator[StudioPage]:
    """A tab in which the robot is drawn, in a small window at that scale."""
    context = browser.new_context(
        viewport={"width": 720, "height": 500}, reduced_motion="reduce", device_scale_factor=scale
    )
    if script:
        context.add_init_script(f"({script})()")
    tab = StudioPage(context.new_page())
    tab.page.goto(studio.url)
    wait_until("the robot", tab.has_drawn_robot)
    yield tab
    assert tab.errors == []
    context.close()


@pytest.mark.parametrize("size", [*FINGER_SIZES, *MORE_FINGER_SIZES])
def test_fingers_find_every_control_of_the_frame(
    browser: Browser, studio: RunningStudio, size: tuple[int, int]
):
    with frame_of(browser, studio, size, has_touch=True, is_mobile=True) as tab:
        assert tab.page.evaluate(_SMALL, FINGER_PX) == []
        assert tab.page.evaluate(_BEYOND) == []
        assert not tab.page.evaluate(_OVERLAPS)


@pytest.mark.parametrize("size", [(800, 475), pytest.param((640, 400), marks=pytest.mark.sweep)])
def test_at_twice_the_size_nothing_is_cut_off(
    browser: Browser, studio: RunningStudio, size: tuple[int, int]
):
    with frame_of(browser, studio, size, device_scale_factor=2) as tab:
        assert tab.page.evaluate(_BEYOND) == []
        assert not tab.page.evaluate(_OVERLAPS)
        tab.page.get_by_role("button", name="Settings").click()
        menu = tab.page.get_by_role("menu").bounding_box()
        assert menu is not None
        assert menu["x"] >= 0
        assert menu["y"] + menu["height"] <= size[1]


def draws(tab: StudioPage, *, light: bool) -> bool:
    """Whether the view stands, which may be made anew at this moment, and draws so."""
    told = tab.page.evaluate(_GRAPHICS)
    return told is not None and told["light"] is light


def test_where_the_processor_draws_it_is_said_once_and_drawn_lightly(
    browser: Browser, studio: RunningStudio
):
    with drawn(browser, studio, 2) as tab:
        note = tab.page.get_by_text("the 3D view is drawn with less detail here")
        note.wait_for()
        wait_until("it to be drawn lightly", lambda: draws(tab, light=True))
        assert tab.page.evaluate(_GRAPHICS)["software"]
        wait_until("no shadows", lambda: tab.page.evaluate(_SHADOWS) == 0)
        assert tab.page.evaluate(f"() => {_VIEW}.devicePixelRatio") == 1
        tab.page.get_by_role("button", name="Details").click()
        assert "Drawn by: " in tab.page.get_by_role("dialog", name="Graphics").inner_text()
        tab.page.keyboard.press("Escape")
        tab.page.get_by_role("region", name="3D view").get_by_role("button", name="Dismiss").click()
        note.wait_for(state="detached")
        tab.page.reload()
        wait_until("the robot", tab.has_drawn_robot)
        wait_until("it to be drawn lightly", lambda: draws(tab, light=True))
        assert note.count() == 0


@pytest.mark.sweep
def test_a_view_that_proves_slow_is_drawn_lightly_until_one_undoes_it(
    browser: Browser, studio: RunningStudio
):
    with drawn(browser, studio, 1, _SLOW_UNNAMED_CARD) as tab:
        assert draws(tab, light=False)
        tab.page.evaluate(_SPIN)
        tab.page.get_by_text("the 3D view is drawn with less detail here").wait_for(timeout=90_000)
        wait_until("it to be drawn lightly", lambda: draws(tab, light=True))
        wait_until("the shadows to go", lambda: tab.page.evaluate(_SHADOWS) == 0)
        tab.page.get_by_role("region", name="3D view").get_by_role(
            "button", name="Draw fully"
        ).click()
        wait_until("the robot anew", tab.has_drawn_robot)
        wait_until("full graphics", lambda: draws(tab, light=False))
