"""Messages of the data lane: subscribe to a topic, and its state. Samples are binary."""

from __future__ import annotations

from typing import Annotated, Final, Literal, TypeAlias

from pydantic import Field, TypeAdapter

from studio.protocol.displays import RosName
from studio.protocol.message import Message

SUBSCRIPTION_LIMIT: Final = 1 << 31
"""Limit of a browser's own numbers."""
DEPTH_MAX: Final = 1_000

SubscriptionNumber: TypeAlias = Annotated[int, Field(ge=0, lt=SUBSCRIPTION_LIMIT)]


class Subscribe(Message):
    """Subscribe a topic from now on; what is None is chosen as fits its publishers."""

    type: Literal["subscribe"] = "subscribe"
    subscription: SubscriptionNumber
    """Chosen by the browser; replies repeat it."""
    document: Annotated[str, Field(max_length=200)] = ""
    """Id of the open document whose time it is; empty: what comes now."""
    topic: RosName
    type_name: RosName = ""
    """Of the messages; empty: the type that is published."""
    mode: Literal["every", "newest"]
    """Every message, up to a bound, for plots; or only the newest, for views."""
    most_hz: Annotated[float, Field(ge=1, le=60)] = 60
    """Maximum rate of `newest`; with `every`, no message is left out."""
    pace: Literal["tick", "at_once"] = "tick"
    """With the next tick, which costs least; or as soon as it comes, for what is waited for."""
    reliable: bool | None = None
    latched: bool | None = None
    depth: Annotated[int, Field(ge=1, le=DEPTH_MAX)] | None = None


class Unsubscribe(Message):
    """Subscribe it no more."""

    type: Literal["unsubscribe"] = "unsubscribe"
    subscription: SubscriptionNumber


class AskBulk(Message):
    """Ask for the key of this data lane's bulk lane."""

    type: Literal["ask_bulk"] = "ask_bulk"


class BulkKey(Message):
    """Opens `/bulk?key=` as long as this data lane is open, for its large messages."""

    type: Literal["bulk_key"] = "bulk_key"
    key: str


SubscriptionCommand: TypeAlias = Annotated[Subscribe | Unsubscribe, Field(discriminator="type")]
LaneCommand: TypeAlias = Annotated[Subscribe | Unsubscribe | AskBulk, Field(discriminator="type")]
LANE_COMMANDS: Final[TypeAdapter[LaneCommand]] = TypeAdapter(LaneCommand)


SubscriptionStatus: TypeAlias = Literal[
    "not_connected", "no_publisher", "other_type", "refused", "receiving"
]


class SubscriptionView(Message):
    """State of a subscription; sent at first, and whenever it changes."""

    type: Literal["subscription"] = "subscription"
    subscription: int
    channel: int
    """The number that its messages carry."""
    state: SubscriptionStatus
    type_name: str
    """Of its messages; empty: it is not known yet."""
    types: tuple[str, ...]
    """The types published."""
    publishers: int
    reliable: bool
    latched: bool
    depth: int
    reason: str
    """Why it cannot be subscribed, in a sentence; else empty."""


class NotSubscribed(Message):
    """A command that was none, or one subscription too many."""

    type: Literal["not_subscribed"] = "not_subscribed"
    subscription: int
    reason: str
