"""BrowserTopics: hands topics on to the data lanes of browsers, as the bytes that came.

That is done 60 times in a second, and at once where a browser waits for it.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import secrets
import time
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias

from studio.live.topics.frames import Tick, chunk_of
from studio.live.topics.request import Request
from studio.protocol.subscriptions import NotSubscribed, Subscribe, SubscriptionView, Unsubscribe

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from pydantic import BaseModel

    from studio.live.topics.frames import Chunk
    from studio.live.topics.request import StateKind
    from studio.live.topics.source import TopicSource
    from studio.protocol.subscriptions import SubscriptionCommand, SubscriptionStatus
    from studio.ros.node.samples import RawSample

_log = logging.getLogger(__name__)
_TICK_S: Final = 1 / 60
_TICK_SLACK_S: Final = 0.004
"""A tick that comes a little early is the one that was meant."""
SUBSCRIPTIONS_MAX: Final = 200
"""Limit for one browser."""
_FIRST_CHANNEL_LIMIT: Final = 1 << 31
_STATES: Final[dict[StateKind, SubscriptionStatus]] = {
    "not_connected": "not_connected",
    "connection_lost": "not_connected",
    "no_publisher": "no_publisher",
    "other_type": "other_type",
    "other_form": "other_type",
    "refused": "refused",
    "receiving": "receiving",
}

_Key: TypeAlias = tuple[object, ...]


class DataLaneEnd(Protocol):
    """The sending end of one browser's data lane."""

    def send(self, message: BaseModel, /) -> None:
        """Queue one JSON message."""
        ...

    def take(self, tick: Tick, /) -> None:
        """Queue what came; it never waits."""
        ...

    def sees(self, document: str, /) -> bool:
        """Whether its person may look at a document."""
        ...


class _Channel:
    """A topic as some browsers want it: one subscription, each message framed once for all."""

    def __init__(
        self,
        number: int,
        command: Subscribe,
        source: TopicSource,
        arrived: Callable[[], object],
        changed: Callable[[], object],
    ) -> None:
        self.number, self._command, self._arrived = number, command, arrived
        self._keeps_all = command.mode == "every"
        self.is_at_once = command.pace == "at_once"
        self._due_s = 0.0
        self._subscription = source.subscribe(
            Request(
                command.topic,
                (command.type_name,) if command.type_name else (),
                newest_only=not self._keeps_all,
                reliable=command.reliable,
                latched=command.latched,
                depth=command.depth,
                at_once=self.is_at_once,
            ),
            arrived=self._send_if_due if self.is_at_once else None,
            changed=changed,
        )
        self.close = self._subscription.close

    def state(self, subscription: int) -> SubscriptionView:
        """Return the state of a subscription, by the number that the browser gave it."""
        state = self._subscription.state
        kind = _STATES[state.kind]
        fit = None if kind == "not_connected" else state.fit
        return SubscriptionView(
            subscription=subscription,
            channel=self.number,
            state=kind,
            type_name=fit.type_name if fit else "",
            types=state.types,
            publishers=state.publishers,
            reliable=fit is not None and fit.reliable,
            latched=fit is not None and fit.latched,
            depth=fit.depth if fit else 0,
            reason=state.reason,
        )

    def take(self, now_s: float) -> Chunk | None:
        """Return the messages that are due."""
        if now_s < self._due_s or not (samples := self._subscription.take()):
            return None
        if not self._keeps_all:
            self._due_s = now_s + 1 / self._command.most_hz - _TICK_SLACK_S
        return self._chunk(samples)

    def kept(self) -> Chunk | None:
        """Return the latched messages, for a browser that subscribes later."""
        kept = self._subscription.kept()
        return self._chunk(kept) if kept else None

    def _chunk(self, samples: Sequence[RawSample]) -> Chunk:
        # Where only the newest counts, the others are not lost but passed over.
        lost = self._subscription.lost if self._keeps_all else 0
        return chunk_of(self.number, samples, lost, keeps_all=self._keeps_all)

    def _send_if_due(self) -> None:
        """Send what is due at once, in a thread of the source; the rest goes with a tick."""
        if time.monotonic() >= self._due_s:
            self._arrived()


class _Browser:
    """The channels of one browser by its own numbers, and the states sent of each."""

    def __init__(self, lane: DataLaneEnd, most: int) -> None:
        self._lane, self.most = lane, most
        self.commands: dict[int, Subscribe] = {}
        self.channels: dict[int, _Channel] = {}
        self.numbers: tuple[int, ...] = ()
        """Of its channels, each once and in order: read in every tick."""
        self._sent: dict[int, SubscriptionView] = {}

    def send_states(self) -> None:
        """Send the states that changed."""
        for subscription, channel in self.channels.items():
            view = channel.state(subscription)
            if self._sent.get(subscription) != view:
                self._sent[subscription] = view
                self._lane.send(view)

    def put(self, command: Subscribe, channel: _Channel) -> None:
        self.commands[command.subscription] = command
        self.channels[command.subscription] = channel
        self._number()

    def remove(self, subscription: int) -> None:
        self.commands.pop(subscription, None)
        self.channels.pop(subscription, None)
        self._sent.pop(subscription, None)
        self._number()

    def _number(self) -> None:
        self.numbers = tuple(sorted({one.number for one in self.channels.values()}))


class BrowserTopics:
    """The subscriptions of all browsers' data lanes, and what they receive.

    Used on the event loop only.

    Args:
        source: The topics of what runs now.

    Attributes:
        source_of: Gives those that a document shows; None: those of what runs now.
    """

    def __init__(self, source: TopicSource) -> None:
        self._source = source
        self.source_of: Callable[[str], TopicSource | None] = lambda _: None
        self._browsers: dict[DataLaneEnd, _Browser] = {}
        self._channels: dict[_Key, _Channel] = {}
        # A page that a relay serves stays while the studio is started anew: a number of before
        # would mean another topic to it.
        self._numbers = itertools.count(1 + secrets.randbelow(_FIRST_CHANNEL_LIMIT))
        self._ticking: asyncio.Task[None] | None = None
        self._is_woken = self._is_sending = self._closed = False

    def attach(self, lane: DataLaneEnd, most: int = SUBSCRIPTIONS_MAX) -> None:
        """Add a data lane, which may have so many subscriptions at most."""
        self._browsers[lane] = _Browser(lane, most)

    def detach(self, lane: DataLaneEnd) -> None:
        """Remove a closed lane, and end what it alone subscribed."""
        self._browsers.pop(lane, None)
        self._close_unwanted()

    def carry_out(self, lane: DataLaneEnd, command: SubscriptionCommand) -> None:
        """Subscribe or unsubscribe for a browser, and send it the state."""
        browser = self._browsers.get(lane)
        if browser is None or self._closed:
            return
        match command:
            case Unsubscribe():
                browser.remove(command.subscription)
            case Subscribe() if len(browser.channels) >= browser.most:
                reason = f"{browser.most} topics are shown already: close a panel first."
                lane.send(NotSubscribed(subscription=command.subscription, reason=reason))
            case Subscribe() if command.document and not lane.sees(command.document):
                reason = "There is no such document."
                lane.send(NotSubscribed(subscription=command.subscription, reason=reason))
            case Subscribe():
                self._put(lane, browser, command)
        self._close_unwanted()

    def switch(self, document: str) -> None:
        """A document shows another time: subscribe again what was subscribed for it."""
        for lane, browser in tuple(self._browsers.items()):
            for command in tuple(browser.commands.values()):
                if command.document == document:
                    self._put(lane, browser, command)
        self._close_unwanted()

    async def close(self) -> None:
        """Hand nothing more on."""
        self._closed = True
        if self._ticking is not None:
            self._ticking.cancel()
            await asyncio.gather(self._ticking, return_exceptions=True)
        self._browsers.clear()
        self._close_unwanted()

    def _put(self, lane: DataLaneEnd, browser: _Browser, command: Subscribe) -> None:
        source = (command.document and self.source_of(command.document)) or self._source
        # Of documents that show what runs now all share a channel.
        key = (id(source), *command.model_dump(exclude={"subscription", "document"}).values())
        if channel := self._channels.get(key):
            # To those who wait for it first, and to whoever subscribes it once more: what is kept
            # would come to this one twice.
            self._hand_on((channel,), asyncio.get_running_loop().time())
        else:
            channel = self._open(key, command, source)
        browser.remove(command.subscription)
        browser.put(command, channel)
        browser.send_states()
        if kept := channel.kept():
            lane.take(Tick((kept,), kept_for=command.subscription))
        if self._ticking is None or self._ticking.done():
            self._ticking = asyncio.create_task(self._tick())

    def _open(self, key: _Key, command: Subscribe, source: TopicSource) -> _Channel:
        loop = asyncio.get_running_loop()

        def arrived() -> None:
            if not self._is_woken and not loop.is_closed():
                self._is_woken = True
                loop.call_soon_threadsafe(self._hand_on_at_once, loop)

        def changed() -> None:
            if not self._is_sending and not loop.is_closed():
                self._is_sending = True
                loop.call_soon_threadsafe(self._send_states)

        number = next(self._numbers)
        channel = self._channels[key] = _Channel(number, command, source, arrived, changed)
        return channel

    def _close_unwanted(self) -> None:
        wanted = {number for one in self._browsers.values() for number in one.numbers}
        for key, channel in tuple(self._channels.items()):
            if channel.number not in wanted:
                del self._channels[key]
                channel.close()

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        while self._channels:
            began_s = loop.time()
            try:
                self._hand_on(self._channels.values(), began_s)
            except Exception:  # noqa: BLE001 - one topic that fails must not silence the others
                _log.exception("A tick of the data lane failed.")
            await asyncio.sleep(max(0.0, began_s + _TICK_S - loop.time()))

    def _send_states(self) -> None:
        self._is_sending = False  # before sending: what changes from now on is sent again
        for browser in self._browsers.values():
            browser.send_states()

    def _hand_on_at_once(self, loop: asyncio.AbstractEventLoop) -> None:
        self._is_woken = False  # before it is taken: what comes from now on wakes again
        self._hand_on((one for one in self._channels.values() if one.is_at_once), loop.time())

    def _hand_on(self, channels: Iterable[_Channel], now_s: float) -> None:
        """Send every browser its messages; browsers with the same channels share one frame."""
        chunks: dict[int, Chunk] = {}
        for channel in channels:
            if (chunk := channel.take(now_s)) is not None:
                chunks[channel.number] = chunk
        if not chunks:
            return
        groups: dict[tuple[int, ...], list[DataLaneEnd]] = {}
        for lane, browser in self._browsers.items():
            if wanted := tuple(number for number in browser.numbers if number in chunks):
                groups.setdefault(wanted, []).append(lane)
        for numbers, lanes in groups.items():
            tick = Tick(tuple(chunks[number] for number in numbers))
            for lane in lanes:
                lane.take(tick)
