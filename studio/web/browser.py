"""Opens the person's own browser, where there is a display for it."""

from __future__ import annotations

import os
import sys
import threading
import webbrowser


def has_display() -> bool:
    """Whether a window would be seen: not in a container, nor behind a plain ssh."""
    if sys.platform in {"win32", "darwin"}:
        return "SSH_CONNECTION" not in os.environ
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def show(address: str) -> None:
    """Open a page without waiting: starting a browser can take seconds."""
    if has_display():
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
