"""Keys: one press at a time, named as the arrows are, from the terminal or from a page."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.errors import SettingsError

if TYPE_CHECKING:
    from collections.abc import Callable, Generator
    from queue import SimpleQueue

_ARROWS = {"A": "up", "B": "down", "C": "right", "D": "left"}
_ESCAPE = "\x1b"
_WINDOWS_ARROWS = {"H": "up", "P": "down", "M": "right", "K": "left"}
_sent: list[SimpleQueue[str]] = []


def take_keys_from(sent: SimpleQueue[str]) -> None:
    """Read the keys of this process from a queue, not from a terminal."""
    _sent[:] = [sent]


@contextmanager
def key_presses() -> Generator[Callable[[], str]]:
    """Return a function that waits for a key; Ctrl-C still interrupts.

    Raises:
        SettingsError: Nobody types: the input is no terminal.
    """
    if _sent:
        yield _sent[0].get
        return
    if not sys.stdin.isatty():
        raise SettingsError("Keys come from a terminal: start this in one, in the foreground.")
    if sys.platform == "win32":
        yield _windows_key
        return
    import termios  # noqa: PLC0415 - Unix only
    import tty  # noqa: PLC0415 - Unix only

    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    try:
        tty.setcbreak(terminal)
        yield _unix_key
    finally:
        termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def _unix_key() -> str:
    """Read a letter, or an arrow, which comes as three bytes."""
    pressed = sys.stdin.read(1)
    if pressed != _ESCAPE:
        return pressed
    sys.stdin.read(1)
    return _ARROWS.get(sys.stdin.read(1), "")


def _windows_key() -> str:
    import msvcrt  # noqa: PLC0415 - Windows only

    pressed = str(msvcrt.getwch())  # pyright: ignore
    if pressed in {"\x00", "\xe0"}:
        return _WINDOWS_ARROWS.get(str(msvcrt.getwch()), "")  # pyright: ignore
    return pressed
