"""Signals, arguments and the middleware of a process, by rclpy's names."""

from __future__ import annotations

import sys
from enum import IntEnum
from typing import TYPE_CHECKING

from studio.ros.duration import NANOSECONDS
from studio.ros.node.arguments import parse_arguments
from studio.ros.node.context import default_context
from studio.ros.node.signals import SignalHandlerOptions, handlers

if TYPE_CHECKING:
    from collections.abc import Sequence

_RMW = "rmw_zenoh_cpp"


class ServiceIntrospectionState(IntEnum):
    """What of calls is published on the topic of events."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


def get_rmw_implementation_identifier() -> str:
    """Return the middleware that is spoken."""
    return _RMW


def get_available_rmw_implementations() -> set[str]:
    """Return the middlewares that there are."""
    return {_RMW}


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return arguments without those of ROS; without any given, those of the process."""
    return list(parse_arguments(sys.argv if args is None else args).rest)


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Return nanoseconds; -1 for ever, as None and what is below zero mean."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(timeout_sec * NANOSECONDS)


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """End the default context by these signals."""
    handlers.install(default_context(), options)


def uninstall_signal_handlers() -> None:
    """Put back the handlers from before."""
    handlers.uninstall()


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return which signals end contexts now."""
    return handlers.options
