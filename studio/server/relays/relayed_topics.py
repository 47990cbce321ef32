"""The relay's end of topics: subscribes at the origin once what many browsers want."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Annotated, Final, TypeAlias

from pydantic import Field, TypeAdapter, ValidationError

from studio.errors import RelayLineError
from studio.live.topics.browsers import SUBSCRIPTIONS_MAX
from studio.live.topics.frames import Tick
from studio.protocol.roles import owner_of
from studio.protocol.subscriptions import (
    NotSubscribed,
    Subscribe,
    SubscriptionView,
    Unsubscribe,
)
from studio.server.relays.messages import AskTopic
from studio.server.relays.origin_topics import RELAY_SUBSCRIPTIONS_MAX
from studio.server.relays.shared_topics import RelayBrowser, SharedTopic, not_connected
from studio.server.relays.topic_frames import chunks_of_frame

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.live.topics.browsers import DataLaneEnd
    from studio.live.topics.frames import Chunk
    from studio.protocol.subscriptions import SubscriptionCommand
    from studio.server.relays.messages import TopicTick
    from studio.server.relays.shared_topics import TopicKey

_AGAIN_MAX: Final = 40
"""So many subscriptions may be open for latched messages alone; the others wait for these."""
TOPICS_MAX: Final = RELAY_SUBSCRIPTIONS_MAX - _AGAIN_MAX
_KEPT_BYTES: Final = 64 << 20
"""Limit of the latched messages that are held; of more, each browser's are asked for."""
_STATE_LIMIT_BYTES: Final = 64 << 10

_State: TypeAlias = Annotated[SubscriptionView | NotSubscribed, Field(discriminator="type")]
_STATES: Final[TypeAdapter[_State]] = TypeAdapter(_State)


class RelayedTopics:
    """The topics of an origin, for the data lanes of a relay's browsers.

    Nothing is asked for before the first `renew`, and nothing between a `reset` and the next.

    Args:
        ask: Puts a message on the line.
        ticket_of: Gives the ticket of a lane's person.
    """

    def __init__(
        self,
        ask: Callable[[AskTopic], object],
        ticket_of: Callable[[DataLaneEnd], str] = lambda _: "",
    ) -> None:
        self._ask, self._ticket_of = ask, ticket_of
        self._browsers: dict[DataLaneEnd, RelayBrowser] = {}
        self._topics: dict[TopicKey, SharedTopic] = {}
        self._numbers = itertools.count(1)
        self._asked: dict[int, SharedTopic] = {}
        """By the numbers of subscriptions at the origin."""
        self._again_open = 0
        self._again_later: dict[SharedTopic, None] = {}
        self._is_up = False
        self._channels: dict[int, list[SharedTopic]] = {}
        self._keeps_all: dict[int, bool] = {}
        self._kept_bytes = 0
        self._groups: dict[frozenset[int], list[DataLaneEnd]] | None = None
        """Browsers by the channels that they are sent; None: they changed."""

    # What browsers ask for

    def attach(self, lane: DataLaneEnd, most: int = SUBSCRIPTIONS_MAX) -> None:
        """Add a data lane, which may have so many subscriptions at most."""
        self._browsers[lane] = RelayBrowser(lane, most)

    def detach(self, lane: DataLaneEnd) -> None:
        """Remove a closed lane, and end what it alone subscribed."""
        if (browser := self._browsers.pop(lane, None)) is not None:
            for subscription in tuple(browser.topics):
                self._leave(browser, subscription)

    def carry_out(self, lane: DataLaneEnd, command: SubscriptionCommand) -> None:
        """Subscribe or unsubscribe for a browser, and send it the state, once that is known."""
        if (browser := self._browsers.get(lane)) is None:
            return
        if isinstance(command, Unsubscribe):
            self._leave(browser, command.subscription)
            return
        key = tuple(command.model_dump(exclude={"subscription"}).values())
        if reason := self._why_not(browser, command, key):
            lane.send(NotSubscribed(subscription=command.subscription, reason=reason))
        else:
            self._join(browser, command, key)

    # What comes on the line

    def reset(self) -> None:
        """The line was lost: tell the browsers, and forget what the origin said."""
        self._is_up = False
        for topic in self._topics.values():
            channel = 0 if topic.view is None else topic.view.channel
            for browser, subscription in topic.users:
                browser.lane.send(not_connected(subscription, channel))
        self._forget_answers()

    def renew(self) -> None:
        """There is a line, whose other end has nothing subscribed: ask for all that is wanted."""
        self._is_up = True
        self._forget_answers()
        for topic in tuple(self._topics.values()):
            self._subscribe(topic)

    def take_state(self, text: bytes) -> None:
        """Take the state of a subscription.

        Raises:
            RelayLineError: It is none.
        """
        if len(text) > _STATE_LIMIT_BYTES:
            raise RelayLineError(f"the state of a topic has {len(text)} bytes.")
        try:
            told = _STATES.validate_json(text)
        except ValidationError:
            raise RelayLineError("what it tells of a topic is no state.") from None
        topic = self._asked.get(told.subscription)
        if topic is None:
            return
        if told.subscription == topic.again:
            if isinstance(told, NotSubscribed):
                self._end_again(topic)
                self._let_in(topic, tuple(topic.users), None)
        elif isinstance(told, NotSubscribed):
            self._refuse(topic, told.reason)
        else:
            self._set_view(topic, told)

    def take_tick(self, tick: TopicTick) -> None:
        """Take messages, and hand them on.

        Raises:
            RelayLineError: It is no frame.
        """
        chunks = chunks_of_frame(tick.frame, self._keeps_all)
        if tick.kept_for >= 0:
            self._take_kept(tick.kept_for, chunks)
            return
        for channel in chunks:
            for topic in self._channels[channel]:
                self._make_stale(topic)
        self._hand_on(chunks)

    def _hand_on(self, chunks: dict[int, Chunk]) -> None:
        """Send every browser its messages; browsers with the same channels share one tick."""
        if self._groups is None:
            self._groups = {}
            for lane, browser in self._browsers.items():
                if channels := browser.channels:
                    self._groups.setdefault(channels, []).append(lane)
        ordered = sorted(chunks)
        ticks: dict[tuple[int, ...], Tick] = {}
        for channels, lanes in self._groups.items():
            wanted = tuple(one for one in ordered if one in channels)
            if not wanted:
                continue
            if (tick := ticks.get(wanted)) is None:
                tick = ticks[wanted] = Tick(tuple(chunks[one] for one in wanted))
            for lane in lanes:
                lane.take(tick)

    def _take_kept(self, number: int, chunks: dict[int, Chunk]) -> None:
        topic = self._asked.get(number)
        if topic is None or topic.view is None:
            return
        chunk = chunks.get(topic.view.channel)
        users = tuple(topic.users)
        if number == topic.again:
            # Those who were there before had it all.
            users = tuple(one for one in users if one[1] in one[0].waiting)
            self._end_again(topic)
        else:
            topic.is_answered = True
        self._keep(topic, chunk)
        self._again_later.pop(topic, None)
        self._let_in(topic, users, chunk)

    def _let_in(
        self, topic: SharedTopic, users: Iterable[tuple[RelayBrowser, int]], chunk: Chunk | None
    ) -> None:
        """Give some users the latched messages, and from now on what comes."""
        lanes: dict[DataLaneEnd, None] = {}
        for browser, subscription in users:
            browser.waiting.discard(subscription)
            lanes[browser.lane] = None
        self._groups = None
        if chunk is not None:
            tick = Tick((chunk,))
            for lane in lanes:
                lane.take(tick)

    def _set_view(self, topic: SharedTopic, view: SubscriptionView) -> None:
        before = topic.view
        if view == before:
            return
        if before is None or before.channel != view.channel:
            self._take_off(topic)
            self._channels.setdefault(view.channel, []).append(topic)
            self._keeps_all[view.channel] = topic.command.mode == "every"
            self._groups = None
        self._make_stale(topic)
        topic.view = view
        for browser, subscription in topic.users:
            topic.send_view(browser, subscription)

    # Joining and leaving

    def _why_not(self, browser: RelayBrowser, command: Subscribe, key: TopicKey) -> str:
        """Return why it cannot be subscribed, in a sentence; empty: it can."""
        if len(browser.topics) >= browser.most:
            return f"{browser.most} topics are shown already: close a panel first."
        if command.document and not browser.lane.sees(command.document):
            return "There is no such document."
        if key not in self._topics and len(self._topics) >= TOPICS_MAX:
            return f"{TOPICS_MAX} topics are shown by all pages of this relay: close a panel first."
        return ""

    def _join(self, browser: RelayBrowser, command: Subscribe, key: TopicKey) -> None:
        subscription = command.subscription
        topic = self._topics.get(key) or SharedTopic(key, command)
        self._leave(browser, subscription, but=topic)
        topic.users[(browser, subscription)] = None
        browser.topics[subscription] = topic
        browser.waiting.add(subscription)
        if not self._is_up:
            browser.lane.send(not_connected(subscription, 0))
        if key not in self._topics:
            self._topics[key] = topic
            if self._is_up:
                self._subscribe(topic)
            return
        topic.send_view(browser, subscription)
        if topic.view is None or not topic.is_answered:
            return  # the latched messages are on their way
        if topic.has_kept or not topic.view.latched:
            self._let_in(topic, ((browser, subscription),), topic.kept)
        elif topic.again < 0:
            self._again_later[topic] = None
            self._ask_again()

    def _leave(
        self, browser: RelayBrowser, subscription: int, but: SharedTopic | None = None
    ) -> None:
        """End a subscription of a browser; `but` is kept though nobody has it any more."""
        if (topic := browser.topics.pop(subscription, None)) is None:
            return
        del topic.users[(browser, subscription)]
        browser.waiting.discard(subscription)
        self._groups = None
        if not topic.users and topic is not but:
            self._tell(topic, Unsubscribe(subscription=topic.number))
            self._remove(topic)

    def _refuse(self, topic: SharedTopic, reason: str) -> None:
        for browser, subscription in tuple(topic.users):
            del browser.topics[subscription]
            browser.waiting.discard(subscription)
            browser.lane.send(NotSubscribed(subscription=subscription, reason=reason))
        topic.users.clear()
        self._remove(topic)

    def _remove(self, topic: SharedTopic) -> None:
        self._end_again(topic)
        self._again_later.pop(topic, None)
        self._make_stale(topic)
        self._take_off(topic)
        self._asked.pop(topic.number, None)
        del self._topics[topic.key]
        self._groups = None

    def _take_off(self, topic: SharedTopic) -> None:
        """Send its channel's messages to it no more."""
        if topic.view is None:
            return
        channel = topic.view.channel
        others = [one for one in self._channels[channel] if one is not topic]
        if others:
            self._channels[channel] = others
        else:
            del self._channels[channel], self._keeps_all[channel]

    # What is asked of the origin

    def _subscribe(self, topic: SharedTopic) -> None:
        topic.number = next(self._numbers)
        self._ask_for(topic, topic.number)

    def _ask_again(self) -> None:
        """Have latched messages sent again, those of as many topics as may be at once."""
        while self._again_later and self._again_open < _AGAIN_MAX:
            topic = next(iter(self._again_later))
            del self._again_later[topic]
            self._again_open += 1
            topic.again = next(self._numbers)
            self._ask_for(topic, topic.again)

    def _end_again(self, topic: SharedTopic) -> None:
        if topic.again < 0:
            return
        self._tell(topic, Unsubscribe(subscription=topic.again))
        del self._asked[topic.again]
        topic.again = -1
        self._again_open -= 1
        self._ask_again()

    def _ask_for(self, topic: SharedTopic, number: int) -> None:
        self._asked[number] = topic
        self._tell(topic, topic.command.model_copy(update={"subscription": number}))

    def _tell(self, topic: SharedTopic, command: SubscriptionCommand) -> None:
        if not self._is_up or command.subscription < 0:
            return
        ticket = ""
        if isinstance(command, Subscribe) and owner_of(command.document):
            ticket = next((self._ticket_of(browser.lane) for browser, _ in topic.users), "")
        self._ask(AskTopic(command.model_dump_json().encode(), ticket))

    def _forget_answers(self) -> None:
        for topic in self._topics.values():
            topic.forget()
        self._asked.clear()
        self._again_later.clear()
        self._channels.clear()
        self._keeps_all.clear()
        self._again_open = self._kept_bytes = self.dropped = 0
        self._groups = None

    # Latched messages

    def _keep(self, topic: SharedTopic, chunk: Chunk | None) -> None:
        self._make_stale(topic)
        size = 0 if chunk is None else chunk.size
        if self._kept_bytes + size <= _KEPT_BYTES:
            self._kept_bytes += size
            topic.keep(chunk)

    def _make_stale(self, topic: SharedTopic) -> None:
        if topic.kept is not None:
            self._kept_bytes -= topic.kept.size
        topic.make_stale()
