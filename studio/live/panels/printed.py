"""PrintedLines: the last that a process printed, by number."""

from __future__ import annotations

import codecs
from collections import deque
from itertools import islice
from typing import Final

LINES_MAX: Final = 200
LINE_MAX: Final = 2000
"""Characters; what is longer goes on as the next line."""


class PrintedLines:
    """Takes bytes as they come, and keeps whole lines; a process may never end one."""

    def __init__(self) -> None:
        self._lines: deque[str] = deque(maxlen=LINES_MAX)
        self._last = 0
        self._rest = ""
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")

    @property
    def last_words(self) -> str:
        """The last line that is not blank; empty: none came."""
        return next((line for line in reversed(self._lines) if line.strip()), "")

    def take(self, data: bytes) -> None:
        """Take what was printed."""
        *lines, rest = (self._rest + self._decoder.decode(data)).split("\n")
        for line in lines:
            self._keep(line.rstrip("\r"))
        while len(rest) >= LINE_MAX:
            self._keep(rest[:LINE_MAX])
            rest = rest[LINE_MAX:]
        self._rest = rest

    def end(self) -> None:
        """Take what stands without an end of line: nothing comes any more."""
        self.take(b"" if self._rest == "" else b"\n")

    def after(self, number: int) -> tuple[tuple[str, ...], int]:
        """Give the lines after that one which are kept, and the number of the newest of all."""
        missing = max(0, self._last - number)
        begin = max(0, len(self._lines) - missing)
        return tuple(islice(self._lines, begin, None)), self._last

    def _keep(self, line: str) -> None:
        for start in range(0, max(1, len(line)), LINE_MAX):
            self._lines.append(line[start : start + LINE_MAX])
            self._last += 1
