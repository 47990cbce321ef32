"""The relay's copies of lanes: what pages that come later, or are told again, are sent."""

from __future__ import annotations

import asyncio
import itertools
from collections import OrderedDict
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError, OriginAwayError, RelayLineError
from studio.protocol.documents import Gone
from studio.protocol.listeners import send
from studio.protocol.roles import owner_of
from studio.server.relays.messages import (
    MOMENT,
    STUDIO_LANE,
    CloseLane,
    Frame,
    OpenLane,
    Refresh,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.protocol.listeners import Listener
    from studio.server.relays.messages import LaneFrame, LaneSnapshot, Up

FOLLOWED: Final = frozenset({"view", "focus"})
"""Keys of what only those are shown who follow the presenter."""
_KEPT_BYTES: Final = 256 << 10
"""Of frames since a snapshot, at least: a snapshot is asked for again once they are larger."""
_SINCE_BYTES_MAX: Final = 128 << 20
"""The snapshot that was asked for does not come, then."""
_EACH_BYTES: Final = 300
"""What a frame takes besides its bytes."""
_LANES_MAX: Final = 2_000
_OPENING_S: Final = 30.0
_IDLE_S: Final = 60.0
_FOLLOW: Final = "!"
"""Before the names of what pages follow; others are documents."""


class LaneCopy:
    """A lane as the relay has it: the last snapshot, what came since, and who is sent more."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.listeners: dict[Listener, None] = {}
        self.waiting: dict[Listener, None] = {}
        """Those who want it once it is there; who leaves meanwhile is not among them."""
        self.followers: dict[Listener, None] = {}
        """Those of them who follow the presenter."""
        self.is_there = asyncio.Event()
        self.trouble = ""
        """Why there is no such lane."""
        self.idle_since_s = asyncio.get_running_loop().time()
        self.ticket = ""
        """Of the person for whom it was opened last; empty: all may see it."""
        self._snapshot: tuple[Frame, ...] = ()
        self._since: OrderedDict[str | int, Frame] = OrderedDict()
        self._numbers = itertools.count()
        self._snapshot_bytes = self._since_bytes = 0
        self.refreshing = False

    def frames(self) -> Iterable[Frame]:
        """Return all that a new page is sent."""
        return itertools.chain(self._snapshot, self._since.values())

    def take_snapshot(self, frames: tuple[Frame, ...]) -> None:
        """Begin anew; pages that are here have it already if it was asked for only to keep less."""
        self._snapshot = frames
        self._snapshot_bytes = sum(len(one.data) for one in frames)
        self._since.clear()
        self._since_bytes = 0
        self.trouble = ""
        if self.refreshing:
            self.refreshing = False
        else:
            for frame in frames:
                self._post(frame)
        self.is_there.set()

    def take(self, frame: Frame) -> bool:
        """Pass a frame on; answers whether a snapshot would be smaller than what is kept.

        Raises:
            RelayLineError: A snapshot was asked for, and far more came instead.
        """
        if frame.key == MOMENT:
            self._post(frame)
            return False
        key = frame.key or next(self._numbers)
        if before := self._since.pop(key, None):
            self._since_bytes -= len(before.data)
        if not frame.data:  # what had this key holds no more
            self._snapshot = tuple(one for one in self._snapshot if one.key != key)
            self._snapshot_bytes = sum(len(one.data) for one in self._snapshot)
            return False
        self._since[key] = frame
        self._since_bytes += len(frame.data)
        if self._since_bytes + _EACH_BYTES * len(self._since) > _SINCE_BYTES_MAX:
            raise RelayLineError("changes come without end, and not the state that was asked for.")
        self._post(frame)
        if self.refreshing or self._since_bytes <= max(self._snapshot_bytes, _KEPT_BYTES):
            return False
        self.refreshing = True
        return True

    def add(self, listener: Listener) -> None:
        """Send a page the whole state, and every change from then on."""
        self.listeners[listener] = None
        for frame in self.frames():
            if frame.key not in FOLLOWED:
                listener.post(frame.data, binary=frame.binary, key=frame.key or None)

    def remove(self, listener: Listener) -> None:
        """Send a page no more."""
        self.followers.pop(listener, None)
        self.waiting.pop(listener, None)
        if self.listeners.pop(listener, self) is None and not self.listeners:
            self.idle_since_s = asyncio.get_running_loop().time()

    def follow(self, listener: Listener, *, following: bool) -> None:
        """Show a page what the presenter looks at, or no longer."""
        self.followers.pop(listener, None)
        if not following:
            return
        self.followers[listener] = None
        for frame in self.frames():
            if frame.key in FOLLOWED:
                listener.post(frame.data, binary=frame.binary, key=frame.key)

    def _post(self, frame: Frame) -> None:
        pages = self.followers if frame.key in FOLLOWED else self.listeners
        data, binary, key = frame.data, frame.binary, frame.key or None
        key = None if key == MOMENT else key
        for page in tuple(pages):
            page.post(data, binary=binary, key=key)


class RelayedLanes:
    """All lanes of a room at a relay; used on the event loop only.

    Args:
        send: To the origin; nothing happens while it is away.
        ticket_for: Gives the ticket of somebody who may see a document.
    """

    def __init__(self, send: Callable[[Up], object], ticket_for: Callable[[str], str]) -> None:
        self._send, self._ticket_for = send, ticket_for
        self._lanes: dict[str, LaneCopy] = {}
        self.studio = self._lanes[STUDIO_LANE] = LaneCopy(STUDIO_LANE)
        self.frame_count = 0

    async def watch(self, name: str, listener: Listener) -> None:
        """Send a page a lane, as soon as it is there.

        Raises:
            CommandError: There is no such lane.
        """
        if name not in self._lanes and len(self._lanes) >= _LANES_MAX:
            raise CommandError("More is open at this relay than it may show: close a page.")
        lane = self._lanes.get(name)
        if lane is None:
            lane = self._lanes[name] = LaneCopy(name)
            self._ask_for(lane)
        elif not lane.ticket and self._ticket_for(name):
            self._ask_for(lane)  # it was shown to all so far, and is this person's own
        lane.waiting[listener] = None
        try:
            await asyncio.wait_for(lane.is_there.wait(), _OPENING_S)
        except TimeoutError:
            if self._lanes.get(name) is lane:
                self.close(name, str(OriginAwayError()))
            raise OriginAwayError from None
        finally:
            is_wanted = lane.waiting.pop(listener, lane) is None
        if lane.trouble:
            raise CommandError(lane.trouble)
        if is_wanted:
            lane.add(listener)

    def leave(self, listener: Listener) -> None:
        """Send a page no more of documents."""
        for name, lane in self._lanes.items():
            if lane is not self.studio and not name.startswith(_FOLLOW):
                lane.remove(listener)

    def unfollow(self, name: str, listener: Listener) -> None:
        """Send a page no more of what it follows."""
        if lane := self._lanes.get(name):
            lane.remove(listener)

    def forget(self, listener: Listener) -> None:
        """A page was closed."""
        for lane in self._lanes.values():
            lane.remove(listener)

    def renew(self) -> None:
        """The origin is there again: open all lanes anew, for what was missed."""
        for lane in tuple(self._lanes.values()):
            lane.refreshing = False
            self._ask_for(lane)

    def take_snapshot(self, message: LaneSnapshot) -> None:
        """Take the whole state of a lane."""
        if lane := self._lanes.get(message.lane):
            lane.take_snapshot(message.frames)

    def take_frame(self, message: LaneFrame) -> None:
        """Take what is new on a lane."""
        lane = self._lanes.get(message.lane)
        if lane is not None and lane.is_there.is_set():
            self.frame_count += 1
            if lane.take(message.frame):
                self._send(Refresh(message.lane))

    def close(self, name: str, reason: str) -> None:
        """There is no such lane, or no more; pages keep what they have.

        It is opened again for somebody who may see it, if it was opened for somebody else.
        """
        lane = self._lanes.get(name)
        if lane is None or lane is self.studio:
            return
        self._let_go(lane)
        if lane.listeners and self._ticket_for(name) not in {"", lane.ticket}:
            self._ask_for(lane)
            return
        lane.trouble = reason
        lane.is_there.set()
        del self._lanes[name]

    def review(self) -> None:
        """Roles, or what is shown, are others: send nobody what they may not see any more."""
        for lane in self._lanes.values():
            if owner_of(lane.name):
                self._let_go(lane)

    def _let_go(self, lane: LaneCopy) -> None:
        for listener in tuple(lane.listeners):
            if not listener.sees(lane.name):
                lane.remove(listener)
                send(listener, Gone(document=lane.name))

    def close_idle(self) -> None:
        """End lanes that nobody has had open for a while."""
        now_s = asyncio.get_running_loop().time()
        for name, lane in tuple(self._lanes.items()):
            is_idle = not lane.listeners and now_s - lane.idle_since_s > _IDLE_S
            if is_idle and lane is not self.studio and lane.is_there.is_set():
                del self._lanes[name]
                self._send(CloseLane(name))

    def give_up(self, reason: str) -> None:
        """The origin is away for long: who waits for a lane that never came is told."""
        for name, lane in tuple(self._lanes.items()):
            if not lane.is_there.is_set() and lane is not self.studio:
                self.close(name, reason)

    def _ask_for(self, lane: LaneCopy) -> None:
        lane.ticket = self._ticket_for(lane.name)
        self._send(OpenLane(lane.name, lane.ticket))
