"""Messages about a robot that somebody drives by hand from a page."""

from __future__ import annotations

from typing import Literal

from studio.protocol.calls import Name
from studio.protocol.message import Command


class Drive(Command):
    """Drive so fast until told otherwise, or until nothing is told for half a second.

    What comes next for the topic takes its place; who falls silent, or leaves, stands still.
    """

    type: Literal["drive"] = "drive"
    topic: Name
    stamped: bool = False
    """A `TwistStamped` with the time is sent, not a `Twist`."""
    x: float = 0.0
    """m/s, forward."""
    y: float = 0.0
    """m/s, to the left."""
    yaw: float = 0.0
    """rad/s, anticlockwise."""
