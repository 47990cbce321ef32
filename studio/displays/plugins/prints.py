"""What a plug-in prints, with its name before each line; bounded, so that it floods no terminal."""

from __future__ import annotations

import os
import sys
import threading
import time
from typing import TYPE_CHECKING, Final, cast

if TYPE_CHECKING:
    from io import TextIOWrapper

_LINES_MAX: Final = 100
"""In ten seconds."""
_SPAN_S: Final = 10.0
_LINE_MAX: Final = 500
_READ_BYTES: Final = 1 << 16


def prefix_prints(name: str) -> None:
    """From now on, whatever this process prints goes to where stderr went, line by line."""
    terminal = os.dup(2)
    reader, writer = os.pipe()
    os.dup2(writer, 2)
    os.dup2(writer, 1)
    os.close(writer)
    for stream in (sys.stdout, sys.stderr):
        cast("TextIOWrapper", stream).reconfigure(line_buffering=True)
    prints = _Prints(f"[display {name}] ".encode(), terminal)
    threading.Thread(target=prints.pass_on, args=(reader,), daemon=True).start()


class _Prints:
    """Lines of one process on their way to the terminal."""

    def __init__(self, prefix: bytes, terminal: int) -> None:
        self._prefix, self._terminal = prefix, terminal
        self._since_s, self._count, self._left_out = 0.0, 0, 0

    def pass_on(self, reader: int) -> None:
        """Read until the process ends."""
        rest = b""
        while data := os.read(reader, _READ_BYTES):
            *lines, rest = (rest + data).split(b"\n")
            for line in lines:
                self._line(line)
            if len(rest) > _LINE_MAX:
                self._line(rest)
                rest = b""

    def _line(self, line: bytes) -> None:
        now_s = time.monotonic()
        if now_s - self._since_s > _SPAN_S:
            self._say_left_out()
            self._since_s, self._count = now_s, 0
        self._count += 1
        if self._count > _LINES_MAX:
            if not self._left_out:
                self._write(b"... prints too much: what follows is left out")
            self._left_out += 1
            return
        self._write(line[:_LINE_MAX])

    def _say_left_out(self) -> None:
        if self._left_out:
            self._write(b"... %d lines were left out" % self._left_out)
            self._left_out = 0

    def _write(self, line: bytes) -> None:
        os.write(self._terminal, self._prefix + line.rstrip() + b"\n")
