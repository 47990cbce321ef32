"""Logger: what nodes log on the terminal and on /rosout, and the services that set its levels."""

from __future__ import annotations

import sys
import threading
import time
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, cast

from studio.errors import DestroyedError
from studio.ros import strictness
from studio.ros.duration import NANOSECONDS
from studio.ros.node.log_lines import write_line

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from studio.ros.node.clock import Clock
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

_Place = tuple[str, int, int]
"""File, line, and where in the bytecode: two calls of one line are two places."""
_loggers: dict[str, Logger] = {}
LEVELS_MAX = 1_000
"""Loggers with a level of their own: peers may invent names."""
NAME_CHARACTERS_MAX = 255
ROSOUT = "/rosout"
LOG_TYPE = "rcl_interfaces/msg/Log"


class LoggingSeverity(IntEnum):
    """Severity of an entry, by the numbers of rcl_interfaces/msg/Log."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


@dataclass(frozen=True, slots=True)
class Entry:
    """A message that was logged, when, and where in the code."""

    severity: LoggingSeverity
    time_ns: int
    name: str
    text: str
    file: str
    function: str
    line: int


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
    """Logs in the name of a node, or of a part of it."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._lock = threading.Lock()
        self._seen: dict[_Place, _Seen] = {}

    def get_child(self, name: str) -> Logger:
        """Return a logger of a part; what places in the code logged counts for itself.

        Raises:
            ValueError: The name is empty.
        """
        if not name:
            raise ValueError("a part needs a name: write get_child('part')")
        return Logger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: LoggingSeverity | int) -> None:
        """Log nothing that is less severe; UNSET leaves it to the parent."""
        with _families.lock:
            _families.levels[self.name] = LoggingSeverity(level)

    def get_effective_level(self) -> LoggingSeverity:
        """Return the least severity that is logged."""
        return _families.effective(self.name)

    def is_enabled_for(self, severity: LoggingSeverity | int) -> bool:
        """Whether entries of a severity are logged."""
        return severity >= self.get_effective_level()

    def debug(self, message: object, **when: object) -> bool:
        """Log a detail.

        `once`, `skip_first` and `throttle_duration_sec`, with `throttle_time_source_type` by a
        clock, limit how often a place in the code does so, each place for itself.
        """
        return self._log(LoggingSeverity.DEBUG, message, **when)

    def info(self, message: object, **when: object) -> bool:
        """Log what happens."""
        return self._log(LoggingSeverity.INFO, message, **when)

    def warning(self, message: object, **when: object) -> bool:
        """Log what may be wrong."""
        return self._log(LoggingSeverity.WARN, message, **when)

    def warn(self, message: object, **when: object) -> bool:
        """Log what may be wrong."""
        return self._log(LoggingSeverity.WARN, message, **when)

    def error(self, message: object, **when: object) -> bool:
        """Log what is wrong."""
        return self._log(LoggingSeverity.ERROR, message, **when)

    def fatal(self, message: object, **when: object) -> bool:
        """Log what ends the node."""
        return self._log(LoggingSeverity.FATAL, message, **when)

    def log(self, message: object, severity: LoggingSeverity | int, **when: object) -> bool:
        """Log a message, and return whether it was logged."""
        return self._log(LoggingSeverity(severity), message, **when)

    def _log(
        self,
        severity: LoggingSeverity,
        message: object,
        **when: object,
    ) -> bool:
        if not self.is_enabled_for(severity):
            return False
        if strictness.is_begun() and not isinstance(message, str):
            raise TypeError(
                f"a log takes a text, and {message!r:.60} is {type(message).__name__}: "
                'write str(...) or f"{...}"'
            )
        name = str(when.pop("name", self.name))
        frame = sys._getframe(2)  # pyright: ignore[reportPrivateUsage]
        if (when or strictness.is_begun()) and not self._is_due(
            frame, _Asked(severity, name, _When(**cast("dict[str, Any]", when)))
        ):
            return False
        _write(_entry(severity, name, str(message), frame))
        return True

    def _is_due(self, frame: FrameType, asked: _Asked) -> bool:
        """Whether a place in the code that does not always log may log now.

        Raises:
            ValueError: It asked for something else before.
        """
        place = (frame.f_code.co_filename, frame.f_lineno, frame.f_lasti)
        with self._lock:
            seen = self._seen.get(place)
            if seen is None:
                seen = self._seen[place] = _Seen(asked)
            elif seen.asked != asked:
                raise ValueError(seen.asked.why_not(asked))
            return seen.is_due()


@dataclass(frozen=True, slots=True)
class _When:
    """How often a place in the code logs."""

    once: bool | None = False
    skip_first: bool | None = False
    throttle_duration_sec: float | None = 0.0
    throttle_time_source_type: Clock | None = None

    def __post_init__(self) -> None:
        clock: Any = self.throttle_time_source_type
        if clock is None:
            return
        if not self.throttle_duration_sec:
            raise TypeError("throttle_time_source_type needs throttle_duration_sec beside it")
        from studio.ros.node.clock import Clock  # noqa: PLC0415 - it logs itself, by its context

        if not isinstance(clock, Clock):
            raise ValueError(  # noqa: TRY004 - as rclpy
                f"throttle_time_source_type takes a clock, and {clock!r:.60} is none"
            )

    @property
    def filters(self) -> tuple[bool, bool, bool]:
        """Which of the limits count."""
        return (bool(self.once), bool(self.skip_first), bool(self.throttle_duration_sec))


@dataclass(frozen=True, slots=True)
class _Asked:
    """What a place in the code asks for, the same each time."""

    severity: LoggingSeverity
    name: str
    when: _When

    def why_not(self, other: _Asked) -> str:
        """Return what differs, in the words of rclpy."""
        if self.severity != other.severity:
            return "Logger severity cannot be changed between calls."
        if self.name != other.name:
            return "Logger name cannot be changed between calls."
        if self.when.filters != other.when.filters:
            return "Requested logging filters cannot be changed between calls."
        return "Logging filter parameters cannot be changed between calls."


@dataclass(slots=True)
class _Seen:
    """A place in the code that logged, or was kept from it."""

    asked: _Asked
    logged_ns: int | None = None
    was_skipped: bool = False
    was_logged: bool = False

    def is_due(self) -> bool:
        """Ask the limits in rclpy's order; what one lets pass counts for it, whatever follows."""
        when = self.asked.when
        if when.throttle_duration_sec and not self._is_over(when.throttle_duration_sec):
            return False
        if when.skip_first and not self.was_skipped:
            self.was_skipped = True
            return False
        if when.once and self.was_logged:
            return False
        self.was_logged = True
        return True

    def _is_over(self, duration_s: float) -> bool:
        clock = self.asked.when.throttle_time_source_type
        now_ns = time.monotonic_ns() if clock is None else clock.now().nanoseconds
        # A clock that is given begins at 0, as simulated time does.
        last_ns = self.logged_ns if clock is None else self.logged_ns or 0
        if last_ns is not None and now_ns < last_ns + duration_s * NANOSECONDS:
            return False
        self.logged_ns = now_ns
        return True


def get_logger(name: str = "") -> Logger:
    """Return the logger of a name, the same each time."""
    with _families.lock:
        return _loggers.setdefault(name, Logger(name))


def own_level(name: str) -> LoggingSeverity:
    """Return the level that a logger was given, UNSET where its parent's counts."""
    return own_levels().get(name, LoggingSeverity.UNSET)


def own_levels() -> dict[str, LoggingSeverity]:
    """Return the levels of all loggers that were given one."""
    with _families.lock:
        return dict(_families.levels)


def listen_to(name: str, listener: Callable[[Entry], None]) -> Callable[[], None]:
    """Call a listener with what a logger and its children log; return what ends that."""
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


def _entry(severity: LoggingSeverity, name: str, text: str, frame: FrameType) -> Entry:
    code = frame.f_code
    return Entry(
        severity, time.time_ns(), name, text, code.co_filename, code.co_name, frame.f_lineno
    )


def _write(entry: Entry) -> None:
    write_line(entry)
    for listener in _families.listeners_of(entry.name):
        listener(entry)


class LoggerServices:
    """The callbacks of `get_logger_levels` and `set_logger_levels`."""

    def __init__(self, types: TypeLibrary) -> None:
        self._level = types.message("rcl_interfaces/msg/LoggerLevel")
        self._result = types.message("rcl_interfaces/msg/SetLoggerLevelsResult")

    def get_levels(self, request: MessageValue, response: MessageValue) -> MessageValue:
        """Answer with the levels of loggers, 0 where a logger has none of its own."""
        response.levels = [
            self._level(name=name, level=int(own_level(name))) for name in request.names
        ]
        return response

    def set_levels(self, request: MessageValue, response: MessageValue) -> MessageValue:
        """Set the levels of loggers, and answer for each whether it was set."""
        response.results = [self._set_one(one) for one in request.levels]
        return response

    def _set_one(self, wanted: MessageValue) -> MessageValue:
        refusal = _refusal(wanted.name, int(wanted.level))
        if refusal is not None:
            return self._result(successful=False, reason=refusal)
        get_logger(wanted.name).set_level(int(wanted.level))
        return self._result(successful=True)


def _refusal(name: str, level: int) -> str | None:
    if level not in set(LoggingSeverity):
        return f"{level} is no level: give 0, 10, 20, 30, 40 or 50."
    if len(name) > NAME_CHARACTERS_MAX:
        return f"A logger has a name of at most {NAME_CHARACTERS_MAX} characters."
    if name not in own_levels() and len(own_levels()) >= LEVELS_MAX:
        return f"{LEVELS_MAX} loggers have a level of their own already."
    return None


class RosoutPublisher:
    """Publishes what a logger and its children log, until it is stopped."""

    def __init__(
        self, types: TypeLibrary, logger: Logger, publish: Callable[[MessageValue], None]
    ) -> None:
        self._log = types.message(LOG_TYPE)
        self._stamp = types.message("builtin_interfaces/msg/Time")
        self._send = publish
        self.stop = listen_to(logger.name, self._publish)

    def _publish(self, entry: Entry) -> None:
        seconds, rest_ns = divmod(entry.time_ns, NANOSECONDS)
        message = self._log(
            stamp=self._stamp(sec=seconds, nanosec=rest_ns),
            level=int(entry.severity),
            name=entry.name,
            msg=_sendable(entry.text),
            file=entry.file,
            function=entry.function,
            line=entry.line,
        )
        try:
            self._send(message)
        except DestroyedError:
            self.stop()


def _sendable(text: str) -> str:
    """Replace what UTF-8 has no bytes for, such as in names of files: a log never fails."""
    return text.encode(errors="replace").decode()
