"""The Chromium of the browser tests: found, or asked for in a sentence; it draws without a GPU."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import pytest
from playwright.sync_api import Error

from tests.support.browser import KeptBrowser, NoChromiumError, find_chromium, lives
from tests.support.studio_page import wait_until

if TYPE_CHECKING:
    from pathlib import Path

    from playwright.sync_api import Page


def test_a_named_chromium_that_does_not_run_is_said(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    other = tmp_path / "chromium"
    other.write_text("#!/bin/sh\necho a stub that asks for a snap\n")
    other.chmod(0o755)
    monkeypatch.setenv("STUDIO_CHROMIUM", str(other))
    with pytest.raises(NoChromiumError, match=f"STUDIO_CHROMIUM={other} is no Chromium"):
        find_chromium()


def test_the_path_is_searched_when_none_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    own = tmp_path / "google-chrome"
    own.write_text("#!/bin/sh\necho Google Chrome 156.0\n")
    own.chmod(0o755)
    monkeypatch.delenv("STUDIO_CHROMIUM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_chromium() == own


def test_the_shell_without_a_window_is_taken_first(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    for name in ("chromium", "chromium-headless-shell"):
        (tmp_path / name).write_text("#!/bin/sh\necho Chromium 156.0\n")
        (tmp_path / name).chmod(0o755)
    monkeypatch.delenv("STUDIO_CHROMIUM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_chromium() == tmp_path / "chromium-headless-shell"


@pytest.mark.browser
def test_the_browser_draws_webgl_without_a_gpu(page: Page):
    page.set_content("<canvas id=c></canvas>")
    version = page.evaluate(
        "document.getElementById('c').getContext('webgl2').getParameter(0x1F02)"
    )
    assert str(version).startswith("WebGL 2.0")


@pytest.mark.browser
def test_a_kept_browser_leaves_room_for_other_loops_and_is_replaced_when_it_has_died():
    async def nothing() -> None:
        pass

    kept = KeptBrowser()
    with kept.lent() as first:
        session: Any = first.new_browser_cdp_session()
    asyncio.run(nothing())
    with kept.lent() as again:
        assert again is first
        with suppress(Error):  # it may die before it answers
            session.send("Browser.close")
        wait_until("it to be gone", lambda: not lives(first))
    with kept.lent() as second:
        assert second is not first
        assert second.new_page().evaluate("1 + 1") == 2
    kept.close()
    asyncio.run(nothing())
