"""Running: how each demo begins and ends, so that Ctrl-C is no accident."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

import studio.ros.client as rclpy
from studio.errors import StudioError
from studio.ros.client import ExternalShutdownException

if TYPE_CHECKING:
    from collections.abc import Generator


@contextmanager
def until_stopped(args: list[str] | None = None, router: str = "auto") -> Generator[None]:
    """Open the default context for the body; Ctrl-C and a shutdown end it without a traceback.

    A StudioError ends it with its sentence.

    Given `args` become those of the command line, which the course's nodes read.
    """
    if args is not None:
        sys.argv[1:] = args
    try:
        with rclpy.init(args=args, router=router):
            yield
    except (KeyboardInterrupt, ExternalShutdownException):
        return
    except StudioError as error:
        raise SystemExit(str(error)) from None
