"""HearingDesk: hears topics for browsers, and hands on what came as it came.

That is done 60 times in a second, and at once where a browser waits for it.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias

from studio.live.panels.hearing_frames import Tick
from studio.protocol.hearing import Hear, Leave, NotHeard

if TYPE_CHECKING:
    from collections.abc import Iterable

    from pydantic import BaseModel

    from studio.live.connection.desk import WireDesk
    from studio.live.panels.hearing_channels import Channel
    from studio.live.panels.hearing_frames import Chunk
    from studio.protocol.hearing import Heard, Wish

_log = logging.getLogger(__name__)
_TICK_S: Final = 1 / 60
_LOOK_EVERY_S: Final = 0.5
WISHES_MAX: Final = 200
"""Of one browser."""

_Key: TypeAlias = tuple[object, ...]


class Hearer(Protocol):
    """The sending end of one browser's data lane."""

    def say(self, message: BaseModel, /) -> None:
        """Queue one message in words."""
        ...

    def take(self, tick: Tick, /) -> None:
        """Queue what came; it never waits."""
        ...


class _Browser:
    """What one browser hears: channels by its own numbers, and what it was told of each."""

    def __init__(self, hearer: Hearer) -> None:
        self.hearer = hearer
        self.wishes: dict[int, Channel] = {}
        self.numbers: tuple[int, ...] = ()
        """Of its channels, each once and in their order: looked at in every tick."""
        self._told: dict[int, Heard] = {}

    def tell(self) -> None:
        """Tell how each wish stands, where that is news."""
        for wish, channel in self.wishes.items():
            news = channel.state.model_copy(update={"wish": wish})
            if self._told.get(wish) != news:
                self._told[wish] = news
                self.hearer.say(news)

    def hear(self, wish: int, channel: Channel) -> None:
        self.wishes[wish] = channel
        self._number()

    def forget(self, wish: int) -> None:
        self.wishes.pop(wish, None)
        self._told.pop(wish, None)
        self._number()

    def _number(self) -> None:
        self.numbers = tuple(sorted({one.number for one in self.wishes.values()}))


class HearingDesk:
    """Of the loop. What nobody wishes to hear any more is let go of at the next look."""

    def __init__(self, wire: WireDesk) -> None:
        self._wire = wire
        self._browsers: dict[Hearer, _Browser] = {}
        self._channels: dict[_Key, Channel] = {}
        self._numbers = itertools.count(1)
        self._ticking: asyncio.Task[None] | None = None
        self._listening = asyncio.Lock()
        self._looked_s = 0.0
        self._closed = self._is_woken = False

    def attach(self, hearer: Hearer) -> None:
        """A data lane was opened."""
        self._browsers[hearer] = _Browser(hearer)

    def detach(self, hearer: Hearer) -> None:
        """It was closed: what it alone heard ends."""
        self._browsers.pop(hearer, None)
        self._looked_s = 0.0

    def wish(self, hearer: Hearer, wish: Wish) -> None:
        """Carry out what a browser wishes; how that stands is told to it."""
        browser = self._browsers.get(hearer)
        if browser is None or self._closed:
            return
        self._looked_s = 0.0
        match wish:
            case Leave():
                browser.forget(wish.wish)
            case Hear() if len(browser.wishes) >= WISHES_MAX:
                reason = f"{WISHES_MAX} topics are heard by this page: close a panel first."
                hearer.say(NotHeard(wish=wish.wish, reason=reason))
            case Hear():
                self._hear(browser, wish)

    async def let_go(self) -> None:
        """Let go of the connection; wishes stay, and are heard again when there is one."""
        async with self._listening:
            await asyncio.gather(*(asyncio.to_thread(one.listen, None) for one in self._all()))
        self._tell()

    async def close(self) -> None:
        """Hear nothing more."""
        self._closed = True
        if self._ticking is not None:
            self._ticking.cancel()
            await asyncio.gather(self._ticking, return_exceptions=True)
        self._browsers.clear()
        await self.let_go()

    def _all(self) -> tuple[Channel, ...]:
        return tuple(self._channels.values())

    def _hear(self, browser: _Browser, wish: Hear) -> None:
        from studio.live.panels.hearing_channels import Channel  # noqa: PLC0415 - imports zenoh

        browser.forget(wish.wish)
        key = tuple(wish.model_dump(exclude={"wish"}).values())
        wake = partial(self._wake, asyncio.get_running_loop())
        channel = self._channels.get(key)
        if channel is None:
            channel = self._channels[key] = Channel(next(self._numbers), wish, wake)
        browser.hear(wish.wish, channel)
        browser.tell()
        if kept := channel.kept():
            browser.hearer.take(Tick((kept,)))
        if self._ticking is None or self._ticking.done():
            self._ticking = asyncio.create_task(self._tick())

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        while self._channels:
            began_s = loop.time()
            try:
                if began_s - self._looked_s >= _LOOK_EVERY_S:
                    self._looked_s = began_s
                    await self._look()
                self._hand_on(self._all(), loop.time())
            except Exception:  # noqa: BLE001 - one topic that fails must not silence the others
                _log.exception("A tick of the data lane failed.")
            await asyncio.sleep(max(0.0, began_s + _TICK_S - loop.time()))

    async def _look(self) -> None:
        """Hear what is wished as fits who publishes now, and nothing else."""
        async with self._listening:
            wished = {number for each in self._browsers.values() for number in each.numbers}
            for key, channel in tuple(self._channels.items()):
                if channel.number not in wished:
                    del self._channels[key]
                    await asyncio.to_thread(channel.close)
            await asyncio.to_thread(_listen_all, self._all(), self._wire)
        self._tell()

    def _tell(self) -> None:
        for browser in self._browsers.values():
            browser.tell()

    def _wake(self, loop: asyncio.AbstractEventLoop) -> None:
        """Something is to be handed on at once; of the drain's thread."""
        if not self._is_woken and not loop.is_closed():
            self._is_woken = True
            loop.call_soon_threadsafe(self._hand_on_at_once, loop)

    def _hand_on_at_once(self, loop: asyncio.AbstractEventLoop) -> None:
        self._is_woken = False  # before it is taken: what comes from now on wakes again
        self._hand_on([one for one in self._all() if one.is_at_once], loop.time())

    def _hand_on(self, channels: Iterable[Channel], now_s: float) -> None:
        """Give every browser what came for it; those that hear the same share one frame."""
        chunks: dict[int, Chunk] = {}
        for channel in channels:
            if (chunk := channel.take(now_s)) is not None:
                chunks[channel.number] = chunk
        if not chunks:
            return
        groups: dict[tuple[int, ...], list[Hearer]] = {}
        for hearer, browser in self._browsers.items():
            if heard := tuple(number for number in browser.numbers if number in chunks):
                groups.setdefault(heard, []).append(hearer)
        for numbers, hearers in groups.items():
            tick = Tick(tuple(chunks[number] for number in numbers))
            for hearer in hearers:
                hearer.take(tick)


def _listen_all(channels: tuple[Channel, ...], wire: WireDesk) -> None:
    for channel in channels:
        channel.listen(wire.current)
