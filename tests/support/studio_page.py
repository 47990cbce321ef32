"""The studio's page in a real browser, in the words of its user."""

from __future__ import annotations

import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

from playwright.sync_api import Error

from tests.support.pictures import difference_words, look_the_same

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from pathlib import Path

    from playwright.sync_api import (
        Browser,
        BrowserContext,
        ConsoleMessage,
        FloatRect,
        Locator,
        Page,
        ViewportSize,
    )

    from tests.support.server import RunningStudio

PATIENCE_S = 60.0
VIEWPORT: Final[ViewportSize] = {"width": 1280, "height": 720}
ACTION_PATIENCE_MS = 90_000
"""For a click or a word: Playwright's own is half a minute, too little where all cores are busy."""
_PICTURE_PATIENCE_S = 120.0
_POLL_S = 0.1
_HAS_FOCUS = "one => one === document.activeElement"
_COMPLAINTS = frozenset({"error"})
_HAS_VISUALS = """() => {
  const nodes = document.querySelector("iframe")?.contentWindow?.__viserMutable?.nodeRefFromName;
  return Object.keys(nodes ?? {}).some((name) => name.includes("/visual/"));
}"""

_AS_A_TEST = """try {
  localStorage.setItem("studio.pixels.fixed", "true");
  localStorage.setItem("studio.graphics.said", "true");
} catch {}
if (window !== top) {
  const frame = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => window.setTimeout(() => frame(draw), 120);
  window.cancelAnimationFrame = window.clearTimeout.bind(window);
}
if (document.cookie.includes("without_view"))
  Object.defineProperty(HTMLIFrameElement.prototype, "src", { set() {} });"""
"""A picture of a busy machine has the pixels of one of an idle one; and that the processor draws is
not said over the 3D view, where it would be in pictures of it. The 3D view draws seven pictures a
second at most: software GL takes thirty milliseconds of all cores for one. Without the view, its
frame stays empty."""

_UNDO_ALL = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/requests.js", script))).undo(Infinity);
}"""

_SEVERAL_FRAMES = """() => new Promise((done) => {
  const view = document.querySelector("iframe")?.contentWindow ?? window;
  const frame = (left) => view.requestAnimationFrame(() => (left ? frame(left - 1) : done()));
  frame(2);
})"""

_DRAWN_AFTER_SEVERAL_FRAMES = """async () => {
  const view = document.querySelector("iframe")?.contentWindow ?? window;
  for (let left = 2; left; left -= 1)
    await new Promise((next) => view.requestAnimationFrame(next));
  const canvas = view.__viserMutable?.canvas;
  if (!canvas?.width) return 0;
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  let hash = 2166136261;
  for (const pixel of new Uint32Array(data.buffer)) hash = Math.imul(hash ^ pixel, 16777619);
  return hash;
}"""
"""A hash (FNV-1a) of what the 3D view has drawn. It costs 3 ms where a screenshot costs
130. A tab behind another draws once in a second, and takes six for a screenshot."""


class ConditionNotMetError(AssertionError):
    """Something awaited did not come in time."""


def wait_until(what: str, condition: Callable[[], bool], patience_s: float = PATIENCE_S) -> None:
    """Ask again and again until it holds."""
    end_s = time.monotonic() + patience_s
    while not condition():
        if time.monotonic() > end_s:
            raise ConditionNotMetError(what)
        time.sleep(_POLL_S)


class StudioPage:
    """One tab; `errors` collects what its console and its scripts complain of."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.errors: list[str] = []
        page.set_default_timeout(ACTION_PATIENCE_MS)
        page.on("console", self._heard)
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def _heard(self, message: ConsoleMessage) -> None:
        if message.type in _COMPLAINTS:
            self.errors.append(message.text)

    def open(self, url: str, *, view: bool = True) -> None:
        """Go there and wait until the robot is drawn.

        Args:
            url: Where to.
            view: Whether with the 3D view, half of the work; without it the robot is listed.
        """
        if not view:
            self.page.context.add_cookies([{"name": "without_view", "value": "1", "url": url}])
        self.page.goto(url)
        if view:
            wait_until("the 3D view to draw the robot", self.has_drawn_robot)
        else:
            self.page.get_by_role("treeitem").first.wait_for()
        self.stand_still()

    def has_drawn_robot(self) -> bool:
        """Whether viser's scene holds the visual of some link."""
        try:
            return bool(self.page.evaluate(_HAS_VISUALS))
        except Error:  # on its way to another address
            return False

    def seek(self, name: str) -> None:
        """Bring a property into the list's view, of which only what is seen is drawn."""
        self.page.get_by_role("searchbox", name="Filter properties").fill(name)
        wait_until(f"the row of {name}", lambda: self.row(name).count() == 1)

    def row(self, name: str) -> Locator:
        """The row of a property."""
        return self.page.get_by_role("group", name=name, exact=True)

    def slider(self, name: str) -> Locator:
        """The slider of a property."""
        return self.row(name).get_by_role("slider")

    def box(self, name: str) -> Locator:
        """The number or text box of a property; `seek` it first."""
        return self.row(name).get_by_role("textbox").first

    def drag_slider(self, name: str, share: float) -> str:
        """Drag a property's slider to a share of its length; the text that this gave it."""
        self.seek(name)
        self.slider(name).scroll_into_view_if_needed()
        return self.drag_in_view(name, share)

    def drag_in_view(self, name: str, share: float) -> str:
        """The same with a slider that is in view."""
        slider = self.slider(name)
        box = slider.bounding_box()
        assert box is not None
        begin = float(slider.evaluate("one => (one.value - one.min) / (one.max - one.min)"))
        y = box["y"] + box["height"] / 2
        mouse = self.page.mouse
        mouse.move(box["x"] + box["width"] * begin, y)
        mouse.down()
        mouse.move(box["x"] + box["width"] * share, y, steps=6)
        mouse.up()
        wanted = float(slider.input_value())
        wait_until(
            f"{name} to be {wanted:g}",
            lambda: abs(float(self.box(name).input_value()) - wanted) < 1e-9,
        )
        return self.box(name).input_value()

    def _resting_place(self, control: Locator) -> FloatRect:
        """Where a control is seen once nothing moves it any more: a list may still close up."""
        control.scroll_into_view_if_needed()
        last = control.bounding_box()

        def rests() -> bool:
            nonlocal last
            self.page.evaluate(_SEVERAL_FRAMES)
            before, last = last, control.bounding_box()
            return last is not None and before == last

        wait_until("the control to stand still", rests)
        assert last is not None
        return last

    def agree_to_save(self) -> None:
        """Save what the window that shows the changes holds, by the one key that it takes."""
        window = self.page.get_by_role("dialog", name="Save these changes?")
        agree = window.get_by_role("button", name="Save", exact=True)
        wait_until("the key to be the button's", lambda: agree.evaluate(_HAS_FOCUS))
        self.page.keyboard.press("Enter")
        wait_until("the window to be gone", lambda: window.count() == 0)

    @contextmanager
    def finger(self, *, coarse: bool = True) -> Generator[Callable[..., None]]:
        """One on a touch screen; it is told an event, as `touchStart`, and places of the page.

        For a coarse one the page has larger controls: where they are is asked inside.
        """
        session: Any = self.page.context.new_cdp_session(self.page)
        session.send("Emulation.setTouchEmulationEnabled", {"enabled": coarse})

        def touch(kind: str, *places: tuple[float, float]) -> None:
            points = [{"x": x, "y": y} for x, y in places]
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        try:
            yield touch
        finally:
            session.send("Emulation.setTouchEmulationEnabled", {"enabled": False})
            session.detach()

    def undo_all(self) -> None:
        """Take back every edit, as for the next test with this tab."""
        self.page.evaluate(_UNDO_ALL)
        undo = self.page.get_by_role("button", name="Undo", exact=True).first
        wait_until("nothing to be undone", undo.is_disabled)

    def picture(self) -> bytes:
        """The pixels of the 3D view as PNG."""
        return self.page.locator("iframe").screenshot()

    def settle(self) -> bytes:
        """Wait until the 3D view stands still; its picture."""
        picture = b""

        def stood() -> bool:
            nonlocal picture
            drawn = self.stand_still()
            picture = self.picture()
            return drawn == self._drawn()

        wait_until("the 3D view to stand still", stood)
        return picture

    def stand_still(self) -> int:
        """Wait until the 3D view draws the same over several frames; its hash."""
        self.page.bring_to_front()
        last = self._drawn()

        def same() -> bool:
            nonlocal last
            before, last = last, self._drawn()
            return before == last

        wait_until("the 3D view to stand still", same)
        return last

    def _drawn(self) -> int:
        return int(self.page.evaluate(_DRAWN_AFTER_SEVERAL_FRAMES))

    def plain_picture(self) -> bytes:
        """The 3D view standing still, while nothing is pointed at."""
        self.page.mouse.move(9, 9)
        self.page.mouse.move(5, 5)
        return self.settle()

    def show_again(self, picture: bytes) -> None:
        """Wait until the 3D view looks as it did then, when nothing was pointed at."""
        now = self.plain_picture()

        def same() -> bool:
            nonlocal now
            now = self.settle()
            return look_the_same(picture, now)

        try:
            wait_until("the picture of before", same, _PICTURE_PATIENCE_S)
        except ConditionNotMetError as error:
            raise ConditionNotMetError(f"{error}: {difference_words(picture, now)}") from None

    def show_other_than(self, picture: bytes) -> bytes:
        """Wait until the 3D view stands still and looks different from then; its picture now."""
        other = picture

        def differs() -> bool:
            nonlocal other
            other = self.settle()
            return not look_the_same(picture, other)

        wait_until("another picture", differs, _PICTURE_PATIENCE_S)
        return other


def studio_context(
    browser: Browser,
    viewport: ViewportSize = VIEWPORT,
    **more: Any,  # noqa: ANN401 - what playwright takes
) -> BrowserContext:
    """A browser's session, in which pictures of the 3D view can be compared."""
    context = browser.new_context(viewport=viewport, reduced_motion="reduce", **more)
    context.add_init_script(_AS_A_TEST)
    return context


@contextmanager
def studio_page(
    browser: Browser, studio: RunningStudio, *, view: bool = True, viewer: bool = False
) -> Generator[StudioPage]:
    """A tab that has opened the studio's printed address, with or without the 3D view.

    Args:
        browser: Gets a session for it.
        studio: Which one.
        view: Whether with the 3D view, as `StudioPage.open`.
        viewer: Whether by the address for those who only look.
    """
    context = studio_context(browser)
    page = StudioPage(context.new_page())
    try:
        page.open(studio.viewer_url if viewer else studio.url, view=view)
        yield page
    finally:
        context.close()


def changed_bytes(before: Path, after: bytes) -> list[tuple[bytes, bytes]]:
    """Pairs of differing lines of a file before and after."""
    old, new = before.read_bytes().splitlines(), after.splitlines()
    assert len(old) == len(new)
    return [pair for pair in zip(old, new, strict=True) if pair[0] != pair[1]]
