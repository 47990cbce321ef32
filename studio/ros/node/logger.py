"""Logger: what nodes say, written to the terminal as rclpy does, and published on /rosout."""

from __future__ import annotations

import sys
import threading
import time
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

_COLOURS = {30: "\033[33m", 40: "\033[31m", 50: "\033[31m", 10: "\033[32m"}
_PLAIN = "\033[0m"


class LoggingSeverity(IntEnum):
    """How grave an entry is; the numbers are those of rcl_interfaces/msg/Log."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


@dataclass(frozen=True, slots=True)
class Entry:
    """One thing that was said, when, and where in the code."""

    severity: LoggingSeverity
    time_ns: int
    name: str
    text: str
    file: str
    function: str
    line: int


_Place = tuple[str, int]


class _Families:
    """Levels and listeners of loggers by name; a logger without its own takes its parent's."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.levels: dict[str, LoggingSeverity] = {"": LoggingSeverity.INFO}
        self.listeners: dict[str, list[Callable[[Entry], None]]] = {}

    def effective(self, name: str) -> LoggingSeverity:
        while name:
            level = self.levels.get(name, LoggingSeverity.UNSET)
            if level:
                return level
            name = name.rpartition(".")[0]
        return self.levels[""]

    def listeners_of(self, name: str) -> list[Callable[[Entry], None]]:
        with self.lock:
            while name:
                if name in self.listeners:
                    return list(self.listeners[name])
                name = name.rpartition(".")[0]
        return []


_families = _Families()


class Logger:
    """Says things in the name of a node, or of a part of it."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._lock = threading.Lock()
        self._said: dict[_Place, float] = {}

    def get_child(self, name: str) -> Logger:
        """Give the logger of a part."""
        return get_logger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: LoggingSeverity | int) -> None:
        """Say nothing that is less grave; UNSET leaves it to the parent."""
        with _families.lock:
            _families.levels[self.name] = LoggingSeverity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """Give the least severity that is said."""
        return _families.effective(self.name)

    def is_enabled_for(self, severity: LoggingSeverity | int) -> bool:
        """Whether something so grave is said."""
        return severity >= self.get_effective_level()

    def debug(self, message: object, **when: bool | float | None) -> bool:
        """Say a detail; `once`, `skip_first` and `throttle_duration_sec` tell when."""
        return self._log(LoggingSeverity.DEBUG, message, **when)

    def info(self, message: object, **when: bool | float | None) -> bool:
        """Say what happens."""
        return self._log(LoggingSeverity.INFO, message, **when)

    def warning(self, message: object, **when: bool | float | None) -> bool:
        """Say what may be wrong."""
        return self._log(LoggingSeverity.WARN, message, **when)

    def warn(self, message: object, **when: bool | float | None) -> bool:
        """Say what may be wrong."""
        return self._log(LoggingSeverity.WARN, message, **when)

    def error(self, message: object, **when: bool | float | None) -> bool:
        """Say what is wrong."""
        return self._log(LoggingSeverity.ERROR, message, **when)

    def fatal(self, message: object, **when: bool | float | None) -> bool:
        """Say what ends the node."""
        return self._log(LoggingSeverity.FATAL, message, **when)

    def log(
        self, message: object, severity: LoggingSeverity | int, **when: bool | float | None
    ) -> bool:
        """Say something; whether it was said."""
        return self._log(LoggingSeverity(severity), message, **when)

    def _log(
        self,
        severity: LoggingSeverity,
        message: object,
        *,
        once: bool | float | None = False,
        skip_first: bool | float | None = False,
        throttle_duration_sec: float | None = None,
    ) -> bool:
        if not self.is_enabled_for(severity):
            return False
        frame = sys._getframe(2)  # pyright: ignore[reportPrivateUsage]
        place = (frame.f_code.co_filename, frame.f_lineno)
        if (once or skip_first or throttle_duration_sec) and not self._is_due(
            place, bool(once), bool(skip_first), throttle_duration_sec or 0.0
        ):
            return False
        _say(_entry(severity, self.name, str(message), frame))
        return True

    def _is_due(self, place: _Place, once: bool, skip_first: bool, throttle_s: float) -> bool:  # noqa: FBT001
        """Whether a place in the code that does not always speak may speak now."""
        now_s = time.monotonic()
        with self._lock:
            last_s = self._said.get(place)
            if last_s is None:
                # A first one that is skipped counts as not said for throttling, as in rclpy.
                self._said[place] = -throttle_s if skip_first else now_s
                return not skip_first
            if once and last_s > 0:
                return False
            if now_s - last_s < throttle_s:
                return False
            self._said[place] = now_s
            return True


_loggers: dict[str, Logger] = {}


def get_logger(name: str = "") -> Logger:
    """Give the logger of a name, the same each time."""
    with _families.lock:
        return _loggers.setdefault(name, Logger(name))


def own_level(name: str) -> LoggingSeverity:
    """Give the level that a logger was given, UNSET where its parent's counts."""
    return own_levels().get(name, LoggingSeverity.UNSET)


def own_levels() -> dict[str, LoggingSeverity]:
    """Give the levels of all loggers that were given one."""
    with _families.lock:
        return dict(_families.levels)


def listen_to(name: str, listener: Callable[[Entry], None]) -> Callable[[], None]:
    """Tell what a logger and its children say; give what ends it."""
    with _families.lock:
        _families.listeners.setdefault(name, []).append(listener)

    def stop() -> None:
        with _families.lock:
            rest = _families.listeners.get(name, [])
            if listener in rest:
                rest.remove(listener)
            if not rest:
                _families.listeners.pop(name, None)

    return stop


def line_of(entry: Entry) -> str:
    """Write an entry as the terminal shows it."""
    seconds, rest_ns = divmod(entry.time_ns, NANOSECONDS)
    return f"[{entry.severity.name}] [{seconds}.{rest_ns:09d}] [{entry.name}]: {entry.text}"


def _entry(severity: LoggingSeverity, name: str, text: str, frame: FrameType) -> Entry:
    code = frame.f_code
    return Entry(
        severity, time.time_ns(), name, text, code.co_filename, code.co_name, frame.f_lineno
    )


def _say(entry: Entry) -> None:
    line = line_of(entry)
    colour = _COLOURS.get(entry.severity) if sys.stderr.isatty() else None
    sys.stderr.write(f"{colour}{line}{_PLAIN}\n" if colour else f"{line}\n")
    sys.stderr.flush()
    for listener in _families.listeners_of(entry.name):
        listener(entry)
