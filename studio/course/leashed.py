"""Leashed: runs a demo for as long as its input stays open: it ends with the one who started it.

Lines that come are presses of keys, for the demo that is driven by them.
"""

from __future__ import annotations

import os
import runpy
import signal
import sys
import threading
import time
from queue import SimpleQueue
from typing import TYPE_CHECKING

from studio.course.turtlesim.keyboard import take_keys_from

if TYPE_CHECKING:
    from collections.abc import Callable

_CHUNK = 1024
_LINE_MAX = 64
_AFTER_SIGTERM_S = 2.0


def main() -> None:
    """Run the module that is the first argument; the others are its own."""
    module = sys.argv[1]
    keys: SimpleQueue[str] = SimpleQueue()
    take_keys_from(keys)
    # Its own: a demo that ends does not wait for a line.
    threading.Thread(target=_hold, args=(sys.stdin.fileno(), keys.put), daemon=True).start()
    sys.argv[1:] = sys.argv[2:]
    runpy.run_module(module, run_name="__main__", alter_sys=True)


def _hold(source: int, press: Callable[[str], None]) -> None:
    """Pass keys on until the other end is closed, then end this process."""
    read_lines(source, press)
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(_AFTER_SIGTERM_S)
    os._exit(1)


def read_lines(source: int, take: Callable[[str], None]) -> None:
    """Take each line of a file descriptor, up to its end; what is too long for one is dropped.

    Unbuffered: a thread that waits in a buffered file holds up the end of the interpreter.
    """
    rest = b""
    while chunk := os.read(source, _CHUNK):
        *lines, rest = (rest + chunk).split(b"\n")
        rest = rest[:_LINE_MAX]
        for line in lines:
            take(line[:_LINE_MAX].decode(errors="replace").strip())


if __name__ == "__main__":
    main()
