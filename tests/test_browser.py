"""The Chromium of the browser tests: found, or asked for in a sentence; it draws without a GPU."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.browser import NoChromiumError, find_chromium

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
