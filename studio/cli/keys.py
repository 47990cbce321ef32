"""Keys pressed at the terminal while a verb goes on with something else."""

from __future__ import annotations

import contextlib
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

_CHECK_S: Final = 0.1
_READ_BYTES: Final = 64
_ARROWS: Final = {"A": "up", "B": "down", "C": "right", "D": "left"}
_WINDOWS_ARROWS: Final = {"H": "up", "P": "down", "M": "right", "K": "left"}


@contextmanager
def watching_keys(pressed: Callable[[str], object]) -> Generator[bool]:
    """Tell of each key in a thread of its own; arrows by name. Ctrl-C still interrupts.

    Gives whether there is a terminal: where there is none, no key is told.
    """
    if not sys.stdin.isatty():
        yield False
        return
    ended = threading.Event()
    with _single_keys():
        watch = _watch_unix
        if sys.platform == "win32":
            watch = _watch_windows
        thread = threading.Thread(target=watch, args=(pressed, ended), name="keys", daemon=True)
        thread.start()
        try:
            yield True
        finally:
            ended.set()
            thread.join()


def keys_of(text: str) -> list[str]:
    """Part what a terminal sent into keys: an arrow is three characters, or two behind an O."""
    found: list[str] = []
    at = 0
    while at < len(text):
        if text[at] == "\x1b" and text[at + 1 : at + 2] in {"[", "O"}:
            arrow = _ARROWS.get(text[at + 2 : at + 3])
            at += 3
            if arrow is not None:
                found.append(arrow)
        else:
            found.append(text[at])
            at += 1
    return found


@contextmanager
def _single_keys() -> Generator[None]:
    """Have the terminal send each key at once, and show none."""
    if sys.platform == "win32":
        yield
        return
    import termios
    import tty

    terminal = sys.stdin.fileno()
    before = termios.tcgetattr(terminal)
    try:
        tty.setcbreak(terminal)
        yield
    finally:
        with contextlib.suppress(termios.error):  # the terminal has closed
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def _watch_unix(pressed: Callable[[str], object], ended: threading.Event) -> None:
    """Read what comes, without waiting inside a read: that would outlive the verb."""
    import os
    import select

    terminal = sys.stdin.fileno()
    while not ended.is_set():
        try:
            if not select.select([terminal], [], [], _CHECK_S)[0]:
                continue
            read = os.read(terminal, _READ_BYTES)
        except OSError:  # the terminal has closed
            return
        if not read:
            return
        for key in keys_of(read.decode(errors="replace")):
            pressed(key)


def _watch_windows(pressed: Callable[[str], object], ended: threading.Event) -> None:
    import msvcrt

    while not ended.wait(_CHECK_S):
        while msvcrt.kbhit():  # pyright: ignore
            key = str(msvcrt.getwch())  # pyright: ignore
            if key in {"\x00", "\xe0"}:
                key = _WINDOWS_ARROWS.get(str(msvcrt.getwch()), "")  # pyright: ignore
            if key:
                pressed(key)
