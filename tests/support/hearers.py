"""Browsers that hear: they keep what their data lane is given, read by the layout of its frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from studio.live.topics.frames import FRAME_HEAD, MESSAGE_HEAD
from studio.protocol.subscriptions import NotSubscribed, SubscriptionView

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pydantic import BaseModel

    from studio.live.topics.frames import Tick


class Came(NamedTuple):
    """One message of a frame."""

    channel: int
    payload: bytes
    received_ns: int
    sent_ns: int
    lost: int


def read_frame(frame: bytes) -> tuple[int, list[Came]]:
    """How many messages were given up, and those that are in it."""
    version, count, dropped = FRAME_HEAD.unpack_from(frame)
    assert version == 1
    found = list(_messages(frame))
    assert len(found) == count
    return dropped, found


def _messages(frame: bytes) -> Iterator[Came]:
    at = FRAME_HEAD.size
    while at < len(frame):
        channel, length, received_ns, sent_ns, lost = MESSAGE_HEAD.unpack_from(frame, at)
        begin = at + MESSAGE_HEAD.size
        assert (begin + 4) % 8 == 0, "the body of a CDR lies where arrays can be looked at"
        yield Came(channel, frame[begin : begin + length], received_ns, sent_ns, lost)
        at = begin + length + -(MESSAGE_HEAD.size + length) % 8


class KeepingHearer:
    """Keeps all that it is told and given."""

    def __init__(self) -> None:
        self.told: list[SubscriptionView] = []
        self.refused: list[NotSubscribed] = []
        self.came: list[Came] = []
        self.ticks: list[Tick] = []

    def send(self, message: BaseModel, /) -> None:
        if isinstance(message, SubscriptionView):
            self.told.append(message)
        if isinstance(message, NotSubscribed):
            self.refused.append(message)

    def take(self, tick: Tick, /) -> None:
        self.ticks.append(tick)
        self.came += read_frame(tick.frame())[1]

    def sees(self, document: str, /) -> bool:
        return document != "hidden"

    def state(self, subscription: int) -> str:
        """How a subscription stands, as it was told last."""
        return next(
            (one.state for one in reversed(self.told) if one.subscription == subscription), ""
        )
