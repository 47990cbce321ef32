"""Opens the person's own browser, where there is a display for it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import threading
import webbrowser
from html import escape
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Final

from studio.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Callable

_REDIRECT: Final = Template("""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0;url=$address">
<title>Robot description studio</title>
</head>
<body><p><a href="$address">Go to the studio</a></p></body>
</html>
""")
_ASK_TIMEOUT_S: Final = 5.0


def has_display() -> bool:
    """Whether a window would be seen: not in a container, nor behind a plain ssh."""
    if sys.platform in {"win32", "darwin"}:
        return "SSH_CONNECTION" not in os.environ
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


class Window:
    """The browser window that a run of the studio opens.

    Every user of a machine sees the command lines of all programs: a browser is given the name of a
    file that only its owner may read, and the file leads to the address.
    """

    def __init__(self, data_folder: Path) -> None:
        self._data_folder = data_folder
        self._file: Path | None = None

    def show(self, address: str, opens: Callable[[str], object] = webbrowser.open) -> None:
        """Open an address that nobody else may see, without waiting for the browser."""
        threading.Thread(target=self._show, args=(address, opens), daemon=True).start()

    def close(self) -> None:
        """Remove the file; whoever starts the studio again on this folder writes it anew."""
        if self._file is not None:
            self._file.unlink(missing_ok=True)

    def _show(self, address: str, opens: Callable[[str], object]) -> None:
        folder = readable_folder(_default_browser(), Path.home(), self._data_folder)
        self._file = folder / f"robot-description-studio-{os.getpid()}.html"
        text = _REDIRECT.substitute(address=escape(address, quote=True))
        try:
            write_whole(self._file, text.encode(), mode=0o600)
        except OSError:  # the printed address opens the page as well
            return
        opens(self._file.as_uri())


def readable_folder(browser: str, home: Path, data_folder: Path) -> Path:
    """Where a browser can read a file: one from a snap sees nothing of hidden folders.

    Args:
        browser: Its desktop entry, as `firefox_firefox.desktop`, which names the snap first.
        home: The user's own folder.
        data_folder: Good for all other browsers.
    """
    snap, separator, _ = browser.partition("_")
    common = home / "snap" / snap / "common"
    return common if separator and common.is_dir() else data_folder


def _default_browser() -> str:
    """The desktop entry of the usual browser; empty where that is not known."""
    settings = shutil.which("xdg-settings")
    if settings is None:
        return ""
    asked = [settings, "get", "default-web-browser"]
    try:
        told = subprocess.run(
            asked, capture_output=True, text=True, timeout=_ASK_TIMEOUT_S, check=False
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return told.stdout.strip()
