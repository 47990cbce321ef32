"""Exceptions of tf2 by the names that its users catch."""

from __future__ import annotations

from studio.errors import (
    ExtrapolationError,
    FrameError,
    TransformError,
    UnconnectedFramesError,
    UnknownFrameError,
)

TransformException = FrameError
LookupException = UnknownFrameError
ConnectivityException = UnconnectedFramesError
ExtrapolationException = ExtrapolationError
InvalidArgumentException = TransformError


class TimeoutException(FrameError):  # noqa: N818  # tf2's name
    """A wait took too long."""


def name_as_tf2() -> None:
    """Give the errors of frames the names that users of tf2 know; for this whole process."""
    for kind, name in (
        (FrameError, "TransformException"),
        (UnknownFrameError, "LookupException"),
        (UnconnectedFramesError, "ConnectivityException"),
        (ExtrapolationError, "ExtrapolationException"),
        (TransformError, "InvalidArgumentException"),
    ):
        kind.__module__, kind.__name__, kind.__qualname__ = "tf2", name, name
    TimeoutException.__module__ = "tf2"
