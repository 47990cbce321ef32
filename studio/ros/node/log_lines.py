"""How log entries are written on the terminal, by the variables that ROS's own loggers read."""

from __future__ import annotations

import os
import re
import sys
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final, TextIO

from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.logger import Entry

FORMAT: Final = "RCUTILS_CONSOLE_OUTPUT_FORMAT"
COLORIZED: Final = "RCUTILS_COLORIZED_OUTPUT"
USE_STDOUT: Final = "RCUTILS_LOGGING_USE_STDOUT"
_TOKEN: Final = re.compile(r"\{(\w+)\}")
_PLAIN: Final = "\033[0m"
_COLOURS: Final = {10: "\033[32m", 20: _PLAIN, 30: "\033[33m", 40: "\033[31m", 50: "\033[31m"}


def _time(entry: Entry) -> str:
    seconds, rest_ns = divmod(entry.time_ns, NANOSECONDS)
    return f"{seconds}.{rest_ns:09d}"


def _date(entry: Entry) -> str:
    local = datetime.fromtimestamp(entry.time_ns // NANOSECONDS, tz=UTC).astimezone()
    return f"{local:%Y-%m-%d %H:%M:%S}.{entry.time_ns % NANOSECONDS // 1_000_000:03d}"


_TOKENS: Final[dict[str, Callable[[Entry], str]]] = {
    "severity": lambda entry: entry.severity.name,
    "name": lambda entry: entry.name,
    "message": lambda entry: entry.text,
    "function_name": lambda entry: entry.function,
    "file_name": lambda entry: entry.file,
    "line_number": lambda entry: str(entry.line),
    "time": _time,
    "time_as_nanoseconds": lambda entry: str(entry.time_ns),
    "date_time_with_ms": _date,
}


def line_of(entry: Entry) -> str:
    """Write an entry as RCUTILS_CONSOLE_OUTPUT_FORMAT says; unknown tokens stay as they are."""
    form = os.environ.get(FORMAT)
    if not form:
        return f"[{entry.severity.name}] [{_time(entry)}] [{entry.name}]: {entry.text}"

    def filled(found: re.Match[str]) -> str:
        write = _TOKENS.get(found[1])
        return found[0] if write is None else write(entry)

    return _TOKEN.sub(filled, form)


def write_line(entry: Entry) -> None:
    """Print an entry on stderr, or on stdout where that is asked for."""
    out = sys.stdout if os.environ.get(USE_STDOUT) == "1" else sys.stderr
    line = line_of(entry)
    out.write(f"{_COLOURS.get(entry.severity, '')}{line}{_PLAIN}\n" if _is_coloured(out)
              else f"{line}\n")  # fmt: skip
    out.flush()


def _is_coloured(out: TextIO) -> bool:
    asked = os.environ.get(COLORIZED)
    return asked == "1" if asked in {"0", "1"} else out.isatty()
