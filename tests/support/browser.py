"""Finds a Chromium for the browser tests, or installs one: `python -m tests.support.browser`.

Looked for in this order: $STUDIO_CHROMIUM, the PATH, playwright's own folder. Installed, when there
is none, by apt (as root), else by `playwright install chromium`.
"""

from __future__ import annotations

import asyncio
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from playwright.sync_api import Browser, Error, sync_playwright

from tests.support.apt import install_by_apt

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

NAMES = (
    "chromium-headless-shell",
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
)
"""The shell first: the same engine without the parts of a window, for a fifth less work."""

# WebGL without a GPU; the page around it is drawn by the processor itself: composed by SwiftShader,
# too, four browsers took twice as long. The rest keeps Chromium from calling home.
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--disable-dev-shm-usage",
)

HOW_TO = (
    "The browser tests found no Chromium and could install none: "
    "run `playwright install --with-deps chromium`, or set STUDIO_CHROMIUM to one."
)


class NoChromiumError(Exception):
    """There is no Chromium and none could be installed; the text says the command."""


def find_chromium() -> Path | None:
    """The first Chromium that answers to --version.

    Raises:
        NoChromiumError: STUDIO_CHROMIUM names something else.
    """
    named = os.environ.get("STUDIO_CHROMIUM")
    if named:
        if _answers(Path(named)):
            return Path(named)
        message = f"STUDIO_CHROMIUM={named} is no Chromium that runs: name another or unset it."
        raise NoChromiumError(message)
    found = (Path(path) for name in NAMES if (path := shutil.which(name)))
    return next((path for path in found if _answers(path)), None) or _playwright_chromium()


@cache
def ensure_chromium() -> Path:
    """Find Chromium, or install it; a process does so once.

    Raises:
        NoChromiumError: Neither could be done.
    """
    for install in (None, _install_by_apt, _install_by_playwright):
        if install is not None:
            install()
        if path := find_chromium():
            return path
    raise NoChromiumError(HOW_TO)


def open_browser() -> Iterator[Browser]:
    """A running headless Chromium, closed afterwards.

    Playwright leaves its event loop running in this thread until it is stopped.
    """
    path = ensure_chromium()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(path), args=list(FLAGS))
        yield browser
        browser.close()


class KeptBrowser:
    """One Chromium for all files of tests of a process: each start costs a second of a processor.

    Its event loop counts as running only while a file has it: other files run loops of their own.
    """

    def __init__(self) -> None:
        self._opened: Iterator[Browser] = iter(())
        self._browser: Browser | None = None
        self._loop: asyncio.AbstractEventLoop | None = None

    @contextmanager
    def lent(self) -> Generator[Browser]:
        """The browser; a new one, if the one before has died."""
        asyncio._set_running_loop(self._loop)  # as Playwright does it, behind each of its calls
        try:
            if self._browser is None or not lives(self._browser):
                self._close()
                self._opened = open_browser()
                self._browser = next(self._opened)
            yield self._browser
        finally:
            self._loop = asyncio._get_running_loop()
            asyncio._set_running_loop(None)

    def close(self) -> None:
        """End it, if it was ever lent."""
        asyncio._set_running_loop(self._loop)
        self._close()
        self._loop = None
        asyncio._set_running_loop(None)

    def _close(self) -> None:
        self._browser = None
        for _ in self._opened:
            pass


def lives(browser: Browser) -> bool:
    """Whether it still does what it is told; that it has died is learnt by telling it something."""
    try:
        browser.new_context().close()
    except Error:
        return False
    return True


def _playwright_chromium() -> Path | None:
    """The one of `playwright install chromium`."""
    with sync_playwright() as playwright:
        path = Path(playwright.chromium.executable_path)
    return path if _answers(path) else None


def _answers(path: Path) -> bool:
    """Whether it runs: Ubuntu's chromium-browser may be a stub that only asks for a snap."""
    try:
        answer = subprocess.run(
            [path, "--version"], capture_output=True, text=True, timeout=30, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.returncode == 0 and "Chrom" in answer.stdout


def _install_by_apt() -> None:
    """Install Debian's Chromium, the shell if it has one."""
    install_by_apt("chromium-headless-shell", "chromium")


def _install_by_playwright() -> None:
    subprocess.run(
        [sys.executable, "-m", "playwright", "install", "chromium"],
        stdout=sys.stderr,
        timeout=600,
        check=False,
    )


if __name__ == "__main__":
    try:
        sys.stdout.write(f"Chromium: {ensure_chromium()}\n")
    except NoChromiumError as error:
        sys.exit(str(error))
