"""Publishing to a topic, and driving a robot with velocity commands."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.calls import Name, Yaml
from studio.protocol.message import Command, Event, Message

RATE_MAX_HZ = 1000.0


class Publish(Command):
    """Publish a message; those who follow publications receive what becomes of it."""

    type: Literal["publish"] = "publish"
    name: Name
    message_type: Name
    text: Yaml = ""
    rate_hz: float = Field(default=0.0, ge=0, le=RATE_MAX_HZ)
    """0: once, as soon as somebody listens or after a second."""
    reliable: bool = True
    latched: bool = False
    """Kept for those who come late, for as long as it is published."""
    depth: int = Field(default=10, ge=1, le=10_000)


class StopPublishing(Command):
    """Publish it no more; those of that number, or all."""

    type: Literal["stop_publishing"] = "stop_publishing"
    operation: int = 0
    """0: all."""


class PublicationView(Message):
    """What is or was published."""

    operation: int
    name: str
    message_type: str
    text: str
    rate_hz: float
    reliable: bool
    latched: bool
    depth: int
    state: Literal["running", "done", "stopped", "failed"]
    sent: int
    listeners: int
    """The number of subscriptions of the topic."""
    began_s: float
    """Seconds since the epoch, by the studio's clock."""
    trouble: str


class Publications(Event):
    """Publications, the oldest first; all that are kept, or those that changed."""

    type: Literal["publications"] = "publications"
    whole: bool
    operations: tuple[PublicationView, ...]


class Drive(Command):
    """Drive at a velocity until the next command, or until none came for half a second.

    The next command for the topic replaces it; when its page is silent or gone, the robot stops.
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
