"""How many clicks, drags and keys it takes to find a size, and to change and save it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.studio_page import StudioPage, changed_bytes, wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Locator

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(240)]

ROVER = "rover_description/urdf/rover.urdf.xacro"
_LISTEN = """() => {
  window.used = { clicks: 0, drags: 0, keys: 0 };
  let down = null;
  addEventListener("pointerdown", (event) => (down = event), { capture: true });
  addEventListener("pointerup", ({ clientX: x, clientY: y }) => {
    const moved = Math.hypot(x - down.clientX, y - down.clientY) > 5;
    used[moved ? "drags" : "clicks"] += 1;
  }, { capture: true });
  addEventListener("keydown", ({ key }) => {
    if (!["Control", "Shift", "Alt", "Meta"].includes(key)) used.keys += 1;
  }, { capture: true });
}"""
"""Counts what the browser itself sees of a hand: a key with others held down is one."""


@pytest.fixture
def tab(tab: StudioPage) -> StudioPage:
    tab.page.evaluate(_LISTEN)
    return tab


def used(tab: StudioPage) -> dict[str, int]:
    """What the hand did since it was asked last."""
    return tab.page.evaluate(
        "() => { const was = {...used}; for (const k in used) used[k] = 0; return was; }"
    )


def is_seen(one: Locator) -> bool:
    """Whether all of it lies in the window."""
    box = one.bounding_box() if one.count() == 1 else None
    return box is not None and box["y"] >= 0 and box["y"] + box["height"] <= 720


@pytest.mark.without_view
def test_what_sets_the_wheel_size_is_found_in_two_clicks_and_saved_with_a_drag_and_two_keys(
    tab: StudioPage, data: Path, models: Path
):
    tab.page.get_by_role("treeitem", name="front_left_wheel", exact=True).click()
    tab.page.get_by_role("button", name="Only front_left_wheel").click()
    wait_until("its radius to be in view", lambda: is_seen(tab.slider("wheel_radius")))
    assert used(tab) == {"clicks": 2, "drags": 0, "keys": 0}

    value = tab.drag_in_view("wheel_radius", 0.8)
    tab.page.keyboard.press("Control+s")
    tab.agree_to_save()
    written = data / "models" / ROVER
    wait_until("the file to be written", lambda: f'"{value}"' in written.read_text())
    assert used(tab) == {"clicks": 0, "drags": 1, "keys": 2}
    (difference,) = changed_bytes(models / ROVER, written.read_bytes())
    assert difference[1] == difference[0].replace(b'"0.105"', f'"{value}"'.encode())
    assert tab.errors == []
