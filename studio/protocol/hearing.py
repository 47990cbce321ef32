"""Messages of the data lane: what a browser hears, and how that stands; what comes is binary."""

from __future__ import annotations

from typing import Annotated, Final, Literal, TypeAlias

from pydantic import Field, TypeAdapter

from studio.protocol.displays import RosName
from studio.protocol.message import Message

WISH_LIMIT: Final = 1 << 31
"""Of a browser's own numbers."""
DEPTH_MAX: Final = 1_000

WishNumber: TypeAlias = Annotated[int, Field(ge=0, lt=WISH_LIMIT)]


class Hear(Message):
    """Hear a topic from now on; what is None is chosen as fits its publishers."""

    type: Literal["hear"] = "hear"
    wish: WishNumber
    """Chosen by the browser; what is said of it repeats it."""
    topic: RosName
    type_name: RosName = ""
    """Of the messages that are wanted; empty: what is published."""
    mode: Literal["every", "newest"]
    """Every message as far as a bound, for plots; or the newest, for what is looked at."""
    most_hz: Annotated[float, Field(ge=1, le=60)] = 60
    """How often the newest is sent; of every message none is left out."""
    pace: Literal["tick", "at_once"] = "tick"
    """With the next tick, which costs least; or as soon as it comes, for what is waited for."""
    reliable: bool | None = None
    latched: bool | None = None
    depth: Annotated[int, Field(ge=1, le=DEPTH_MAX)] | None = None


class Leave(Message):
    """Hear it no more."""

    type: Literal["leave"] = "leave"
    wish: WishNumber


class AskBulk(Message):
    """Tell the key of the bulk lane that goes with this data lane."""

    type: Literal["ask_bulk"] = "ask_bulk"


class BulkKey(Message):
    """Opens `/bulk?key=` as long as this data lane is open, for large messages of what it hears."""

    type: Literal["bulk_key"] = "bulk_key"
    key: str


Wish: TypeAlias = Annotated[Hear | Leave, Field(discriminator="type")]
SaidOnLane: TypeAlias = Annotated[Hear | Leave | AskBulk, Field(discriminator="type")]
WISHES: Final[TypeAdapter[SaidOnLane]] = TypeAdapter(SaidOnLane)


HeardState: TypeAlias = Literal["not_connected", "no_publisher", "other_type", "refused", "hearing"]


class Heard(Message):
    """How a wish stands; told at first, and whenever that changes."""

    type: Literal["heard"] = "heard"
    wish: int
    channel: int
    """The number that its messages carry."""
    state: HeardState
    type_name: str
    """Of what is heard; empty: it is not known yet."""
    types: tuple[str, ...]
    """Those that are published."""
    publishers: int
    reliable: bool
    latched: bool
    depth: int
    reason: str
    """Why it cannot be heard, in a sentence; else empty."""


class NotHeard(Message):
    """A wish that was none, or one too many."""

    type: Literal["not_heard"] = "not_heard"
    wish: int
    reason: str
