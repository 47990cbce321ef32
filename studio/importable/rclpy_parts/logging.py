"""The module rclpy.logging: loggers by name, and their levels."""

from __future__ import annotations

import os
from pathlib import Path

from studio.ros.node.logger import Logger, LoggingSeverity, own_level

__all__ = [
    "LoggingSeverity", "clear_config", "get_logger", "get_logger_effective_level",
    "get_logger_level", "get_logging_directory", "get_logging_severity_from_string", "initialize",
    "set_logger_level", "shutdown",
]  # fmt: skip


def initialize() -> None:
    """Do nothing: logging needs no beginning."""


def shutdown() -> None:
    """Do nothing: logging needs no end."""


def clear_config() -> None:
    """Do nothing: there is no file of a configuration."""


def get_logger(name: str) -> Logger:
    """Return a logger of its own: what `once` and the like let pass counts for each anew."""
    return Logger(name)


def set_logger_level(
    name: str, level: LoggingSeverity | int, *, detailed_error: bool = False
) -> None:
    """Log nothing less severe in the name of a logger and its children."""
    del detailed_error
    get_logger(name).set_level(LoggingSeverity(level))


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level that a logger was given, UNSET where its parent's counts."""
    return own_level(name)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the least severity that is logged."""
    return get_logger(name).get_effective_level()


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return a severity by its name, in letters of any size.

    Raises:
        RuntimeError: There is none of that name.
    """
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RuntimeError(f"{log_severity} is no severity of logs") from None


def get_logging_directory() -> Path:
    """Return where ROS keeps logs; the studio writes none."""
    home = os.environ.get("ROS_HOME", "~/.ros")
    return Path(os.environ.get("ROS_LOG_DIR") or f"{home}/log").expanduser()
