"""Running: how each demo begins and ends, so that Ctrl-C is no accident."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import studio.ros.client as rclpy
from studio.ros.client import ExternalShutdownException

if TYPE_CHECKING:
    from collections.abc import Generator


@contextmanager
def until_stopped(args: list[str] | None = None) -> Generator[None]:
    """Join the wire for what stands within; Ctrl-C and a shutdown end it without a traceback."""
    try:
        with rclpy.init(args=args):
            yield
    except (KeyboardInterrupt, ExternalShutdownException):
        return
