"""Messages about how often, how large and how old what others publish is."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from studio.protocol.displays import RosName
from studio.protocol.message import Command, Event, Message


class GetTopicRates(Command):
    """Ask for the rates of topics; they are measured for some seconds, so ask every second."""

    type: Literal["get_topic_rates"] = "get_topic_rates"
    topics: Annotated[tuple[RosName, ...], Field(max_length=200)]
    """Full names; those that are seen."""


class TopicRate(Message):
    """Rate of a topic."""

    name: str
    rate_hz: float
    """Messages in a second; 0 when none, or too few, come."""
    bytes_per_s: float
    age_s: float | None
    """Since the last message; None: none came since it is measured."""
    state: Literal["waiting", "live", "silent", "latched"]
    """`waiting`: nothing came, but that is not for long; `latched`: it speaks once, and did."""


class TopicRates(Event):
    """Answer to `get_topic_rates`: those that somebody publishes, and for which there is room."""

    type: Literal["topic_rates"] = "topic_rates"
    request: int
    rates: tuple[TopicRate, ...]
