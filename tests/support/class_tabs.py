"""Tabs of people who share a studio, in the words of a class."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from tests.support.studio_page import StudioPage, studio_context, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from playwright.sync_api import Browser, Locator

_CAMERA: Final = "frame => frame.contentWindow.studio3d?.getCamera()"


@contextmanager
def tab(browser: Browser) -> Generator[StudioPage]:
    """A browser of somebody's own; the certificate is that of the test."""
    context = studio_context(browser, ignore_https_errors=True)
    try:
        yield StudioPage(context.new_page())
    finally:
        context.close()


def join(tab: StudioPage, address: str, name: str, code: str, *, view: bool = False) -> StudioPage:
    """Come to the bare address, type the code and a name."""
    url = address[: address.index("/", 8)]
    if not view:
        tab.page.context.add_cookies([{"name": "without_view", "value": "1", "url": url}])
    tab.page.goto(address)
    tab.page.get_by_label("Code").fill(code)
    tab.page.get_by_label("Your name").fill(name)
    tab.page.get_by_role("button", name="Join").click()
    bar(tab).get_by_text("You are looking").wait_for()
    return tab


def bar(tab: StudioPage) -> Locator:
    """The bar that says who has control."""
    return tab.page.locator(".control-bar")


def copy_bar(tab: StudioPage) -> Locator:
    """The bar above a copy."""
    return tab.page.locator(".copy-bar")


def press(tab: StudioPage, name: str) -> None:
    """Press the one button of that name."""
    tab.page.get_by_role("button", name=name, exact=True).click()


def press_in_bar(tab: StudioPage, name: str) -> None:
    """Press a button beside the words who has control."""
    bar(tab).get_by_role("button", name=name).click()


def is_pressed(tab: StudioPage, name: str) -> bool:
    """Whether a button stays down."""
    button = tab.page.get_by_role("button", name=name, exact=True)
    return button.get_attribute("aria-pressed") == "true"


def value_of(tab: StudioPage, name: str) -> float:
    """The number of a property, as this page shows it."""
    tab.seek(name)
    return float(tab.box(name).input_value())


def shows(tab: StudioPage, name: str, value: float) -> None:
    """Wait until this page shows that number."""
    wait_until(f"{name} to be {value:g}", lambda: abs(value_of(tab, name) - value) < 1e-9)


def give_control(presenter: StudioPage, name: str) -> None:
    """By the list of people, to which the window of sharing leads."""
    presenter.page.get_by_role("button", name="Share").click()
    presenter.page.locator(".class-code").wait_for()
    presenter.page.locator(".class-dialog footer .primary").click()
    presenter.page.get_by_role("button", name=f"Give control to {name}").click()


def hold_slider(tab: StudioPage, name: str, share: float) -> None:
    """Drag a property's slider to a share of its length, and do not let go of it."""
    tab.seek(name)
    slider = tab.slider(name)
    slider.scroll_into_view_if_needed()
    begin = float(slider.evaluate("one => (one.value - one.min) / (one.max - one.min)"))
    tab.page.mouse.move(*_place_on(slider, begin))
    tab.page.mouse.down()
    tab.page.mouse.move(*_place_on(slider, share), steps=4)


def let_go(tab: StudioPage, name: str, share: float) -> None:
    """Drag the slider that is held further, and let go of it there."""
    tab.page.mouse.move(*_place_on(tab.slider(name), share), steps=4)
    tab.page.mouse.up()


def _place_on(slider: Locator, share: float) -> tuple[float, float]:
    box = slider.bounding_box()
    assert box is not None
    return box["x"] + box["width"] * share, box["y"] + box["height"] / 2


def camera(tab: StudioPage) -> list[float]:
    """Its eye and what it looks at, in the root frame."""
    pose = tab.page.locator("iframe").evaluate(_CAMERA)
    return [*pose["position"], *pose["target"]]


def same_camera(one: StudioPage, other: StudioPage) -> bool:
    """Whether both look at the same from the same place."""
    return all(abs(a - b) < 1e-4 for a, b in zip(camera(one), camera(other), strict=True))


def orbit(tab: StudioPage, x_px: float) -> None:
    """Drag the ground of the 3D view."""
    box = tab.page.locator("iframe").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] * 0.7, box["y"] + box["height"] * 0.3
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + x_px, y + 30, steps=5)
    tab.page.mouse.up()
