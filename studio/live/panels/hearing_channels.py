"""Channels: topics that are heard for browsers, each once for all who wish it in the same way."""

from __future__ import annotations

import time
from collections import deque
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.errors import StudioError, UnknownTypeError
from studio.live.panels.hearing_frames import Chunk, chunk_of
from studio.protocol.hearing import DEPTH_MAX, Heard
from studio.ros.node.subscription import RawSubscription
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.live.connection.link import WireLink
    from studio.protocol.hearing import Hear, HeardState
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.samples import RawSample

_KEPT_BYTES: Final = 16 << 20
"""Of a latched topic, for those who come later."""
_EVERY_DEPTH: Final = 4_096
"""So long may the loop be busy with other work: four seconds of a thousand messages each."""
_TICK_SLACK_S: Final = 0.004
"""A tick that comes a little early is the one that was meant."""


class Way(NamedTuple):
    """What is heard on the wire, and how."""

    type_name: str
    type_hash: str | None
    reliable: bool
    latched: bool
    depth: int

    @property
    def qos(self) -> QoSProfile:
        """As a subscription shows it."""
        reliable, latched = self.reliable, self.latched
        return QoSProfile(
            history=HistoryPolicy.KEEP_LAST,
            depth=self.depth,
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=(DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE),
        )


class Channel:
    """One topic as some browsers wish to hear it; of the loop, but for `listen` and `close`.

    `wake` is called in another thread when something came that is to be handed on at once.
    """

    def __init__(self, number: int, wish: Hear, wake: Callable[[], object]) -> None:
        self.number, self.wish, self._wake = number, wish, wake
        self.is_at_once = wish.pace == "at_once"
        self.keeps_all = wish.mode == "every"
        self.state = self._told("not_connected")
        self._link: WireLink | None = None
        self._way: Way | None = None
        self._heard: RawSubscription | None = None
        self._waiting: list[RawSample] = []
        self._due_s = 0.0
        self._lost_before = 0
        self._kept: deque[RawSample] = deque()
        self._kept_bytes = 0

    def listen(self, link: WireLink | None) -> None:
        """Hear as fits those who publish now; in a thread, for it may wait."""
        if link is None or not link.is_connected:
            self.close()
            self.state = self._told("not_connected")
            return
        if link is not self._link:  # what was heard by another connection comes no more
            self.close()
            self._link = link
        publishers = _publishers(link, self.wish.topic)
        way = _way_of(self.wish, publishers, self._way, lambda name: _own_hash(link, name))
        if way != self._way or (way is not None and self._heard is None):
            self.close()
            self._way = way
            self._open(link, way, publishers)
        else:
            self.state = self._told_of(way, publishers)

    def close(self) -> None:
        """Hear nothing; in a thread, for it may wait."""
        heard, self._heard = self._heard, None
        self._kept.clear()
        self._kept_bytes = 0
        if heard is not None:
            self._lost_before += heard.lost
            heard.close()

    def take(self, now_s: float) -> Chunk | None:
        """What came and is due now."""
        heard = self._heard
        if heard is None:
            return None
        if came := heard.take():
            self._keep(came)
            self._waiting = [*self._waiting, *came] if self.keeps_all else came[-1:]
        if not self._waiting or now_s < self._due_s:
            return None
        if not self.keeps_all:
            self._due_s = now_s + 1 / self.wish.most_hz - _TICK_SLACK_S
        samples, self._waiting = self._waiting, []
        return self._chunk(samples)

    def kept(self) -> Chunk | None:
        """What a latched topic told before, for one who comes now."""
        return self._chunk(tuple(self._kept)) if self._kept else None

    def _chunk(self, samples: Sequence[RawSample]) -> Chunk:
        # Where only the newest counts, the others are not lost but passed over.
        lost = self._lost_before + self._heard.lost if self._heard and self.keeps_all else 0
        return chunk_of(self.number, samples, lost, keeps_all=self.keeps_all)

    def _keep(self, came: Sequence[RawSample]) -> None:
        if self._way is None or not self._way.latched:
            return
        self._kept.extend(came)
        self._kept_bytes += sum(len(one.payload) for one in came)
        while len(self._kept) > self._way.depth or (
            len(self._kept) > 1 and self._kept_bytes > _KEPT_BYTES
        ):
            self._kept_bytes -= len(self._kept.popleft().payload)

    def _open(self, link: WireLink, way: Way | None, publishers: Sequence[GraphEndpoint]) -> None:
        self.state = self._told_of(way, publishers)
        if way is None:
            return
        try:
            self._heard = RawSubscription(
                link.node, self.wish.topic, way.type_name, way.type_hash, way.qos
            )
            if self.is_at_once:
                self._heard.wait_for(self._arrived)
        except StudioError as error:
            self.state = self._told("refused", way, publishers, str(error))

    def _arrived(self) -> None:
        """Of the drain's thread; what is not due yet goes with a tick."""
        if time.monotonic() >= self._due_s:
            self._wake()

    def _told_of(self, way: Way | None, publishers: Sequence[GraphEndpoint]) -> Heard:
        if not publishers:
            return self._told("no_publisher", way)
        if way is None or all(one.type_name != way.type_name for one in publishers):
            return self._told("other_type", way, publishers)
        return self._told("hearing", way, publishers)

    def _told(
        self,
        state: HeardState,
        way: Way | None = None,
        publishers: Sequence[GraphEndpoint] = (),
        reason: str = "",
    ) -> Heard:
        """How it stands; the number of the wish is filled in for each browser."""
        return Heard(
            wish=0,
            channel=self.number,
            state=state,
            type_name=way.type_name if way else "",
            types=tuple(dict.fromkeys(one.type_name for one in publishers)),
            publishers=len(publishers),
            reliable=way is not None and way.reliable,
            latched=way is not None and way.latched,
            depth=way.depth if way else 0,
            reason=reason,
        )


def _publishers(link: WireLink, topic: str) -> list[GraphEndpoint]:
    try:
        return link.graph.publishers(topic)
    except StudioError:  # no topic is named so, which is said when it is to be heard
        return []


def _own_hash(link: WireLink, type_name: str) -> str | None:
    """What publishers show who have the type as it is known here; None: it is not."""
    wire = link.node.wire
    try:
        return wire.profile.type_hash(wire.types.hash_of(type_name))
    except UnknownTypeError:
        return None


def _way_of(
    wish: Hear,
    publishers: Sequence[GraphEndpoint],
    before: Way | None,
    own_hash: Callable[[str], str | None],
) -> Way | None:
    """Hear as fits those who publish, unless somebody chose otherwise; None: nobody knows how.

    While nobody publishes, it is heard as most do: somebody who says one thing and is gone is
    heard only where nothing has to be opened anew. When all are gone, it is heard as before.
    """
    name = wish.type_name or (publishers[0].type_name if publishers else "")
    fitting = [one for one in publishers if one.type_name == name]
    if not fitting and before is not None and name in {"", before.type_name}:
        return before
    if not name:
        return None
    reliable = all(one.qos.reliability is not ReliabilityPolicy.BEST_EFFORT for one in fitting)
    latched = any(one.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for one in fitting)
    return Way(
        name,
        fitting[0].type_hash if fitting else own_hash(name),
        reliable if wish.reliable is None else wish.reliable,
        latched if wish.latched is None else wish.latched,
        _depth_of(wish, fitting),
    )


def _depth_of(wish: Hear, fitting: Sequence[GraphEndpoint]) -> int:
    if wish.depth is not None:
        return wish.depth
    if wish.mode == "every":
        return _EVERY_DEPTH
    latched = [one for one in fitting if one.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL]
    return 1 if not latched else min(DEPTH_MAX, max(1, len(latched)))
