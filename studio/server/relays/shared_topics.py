"""What a relay holds of each topic that its browsers want, and of each of those browsers."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.protocol.subscriptions import SubscriptionView

if TYPE_CHECKING:
    from studio.live.topics.browsers import DataLaneEnd
    from studio.live.topics.frames import Chunk
    from studio.protocol.subscriptions import Subscribe

_KEPT_FRESH_S: Final = 5.0
"""A recording that is wound back says so by no message where nothing came before."""

TopicKey: TypeAlias = tuple[object, ...]


class RelayBrowser:
    """What one browser subscribed, by its own numbers.

    Attributes:
        waiting: Its subscriptions whose latched messages are on their way; no others go before.
    """

    def __init__(self, lane: DataLaneEnd, most: int) -> None:
        self.lane, self.most = lane, most
        self.topics: dict[int, SharedTopic] = {}
        self.waiting: set[int] = set()

    @property
    def channels(self) -> frozenset[int]:
        """The channels whose messages it is to be sent."""
        return frozenset(
            topic.view.channel
            for subscription, topic in self.topics.items()
            if subscription not in self.waiting and topic.view is not None
        )


class SharedTopic:
    """A topic as some browsers of a relay want it: one subscription at the origin.

    Attributes:
        number: The subscription's.
        again: That of another one, made for its latched messages alone; -1: there is none.
        users: Browsers, each with its own number of the subscription.
        view: How it stands, as the origin told; None: it has not yet.
        is_answered: Whether the latched messages came, or that there are none.
    """

    def __init__(self, key: TopicKey, command: Subscribe) -> None:
        self.key, self.command = key, command
        self.users: dict[tuple[RelayBrowser, int], None] = {}
        self.number = self.again = -1
        self.view: SubscriptionView | None = None
        self.is_answered = False
        self.kept: Chunk | None = None
        """The latched messages as they came last; None: there are none, or too many to hold."""
        self._kept_until_s: float | None = None

    def forget(self) -> None:
        """Of what was told nothing holds any more: it is to be subscribed anew."""
        self.number = self.again = -1
        self.view, self.is_answered = None, False
        self.make_stale()
        for browser, subscription in self.users:
            browser.waiting.add(subscription)

    @property
    def has_kept(self) -> bool:
        """Whether the origin would tell a new subscription what is kept here, and nothing else."""
        until_s = self._kept_until_s
        return until_s is not None and time.monotonic() < until_s

    def keep(self, chunk: Chunk | None) -> None:
        """Keep latched messages for browsers that subscribe later; None: there are none."""
        self.kept, self._kept_until_s = chunk, time.monotonic() + _KEPT_FRESH_S

    def make_stale(self) -> None:
        """Messages came since, or their publishers changed."""
        self.kept = self._kept_until_s = None

    def send_view(self, browser: RelayBrowser, subscription: int) -> None:
        """Tell a browser how it stands, if that is known."""
        if self.view is not None:
            browser.lane.send(self.view.model_copy(update={"subscription": subscription}))


def not_connected(subscription: int, channel: int) -> SubscriptionView:
    """Return the state of a subscription while the origin is away."""
    return SubscriptionView(
        subscription=subscription,
        channel=channel,
        state="not_connected",
        type_name="",
        types=(),
        publishers=0,
        reliable=False,
        latched=False,
        depth=0,
        reason="",
    )
