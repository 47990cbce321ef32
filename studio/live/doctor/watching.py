"""Watching: listens to a ROS 2 system for the Doctor, as long as somebody asks what was heard.

It imports Zenoh (through `ros`), so it is imported when somebody asks.
"""

from __future__ import annotations

import math
import threading
import time
from collections import defaultdict
from typing import TYPE_CHECKING, Final

from studio.errors import CdrError, RosNameError, StudioError
from studio.live.doctor.parameter_changes import ParameterChanges
from studio.live.doctor.seen import (
    Header,
    Heard,
    HeardClock,
    HeardFrames,
    HeardTopic,
    Offset,
    called,
    short,
)
from studio.live.doctor.topic_watch import LeastOffset, Reading, TopicWatch
from studio.live.topics.topic_rates import TOPICS_MAX, TopicRates
from studio.ros.columns.transforms import TransformCodec
from studio.ros.names import is_hidden
from studio.ros.profiles import NO_HASH
from studio.ros.qos import DurabilityPolicy
from studio.ros.tokens import DataKey
from studio.ros.wire.bridges.bridge import sender_gid
from studio.tf.buffer import TransformBuffer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.live.doctor.seen import Ends, System
    from studio.ros.attachment import Attachment
    from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
    from studio.ros.node.context import Context
    from studio.ros.types.library import TypeLibrary
    from studio.tf.transforms import Notice

_CLOCK: Final = "/clock"
_TF, _TF_STATIC, _EVENTS, _LOG = "/tf", "/tf_static", "/parameter_events", "/rosout"
_UNPACED: Final = frozenset({_TF_STATIC, _EVENTS, _LOG})
"""They come when something happens, and are silent otherwise."""
_HEADER: Final = "std_msgs/msg/Header"
_SINCE: Final = "the Doctor began to listen"
_BYTES_MAX: Final = 8_000_000
"""So much a second is received beside what others do; a camera beyond it is heard now and then."""
_FRAMES_MAX: Final = 2_000
_FRAME_LETTERS_MAX: Final = 300
"""More than TF takes, so that a frame is compared whole."""
_NOTICES_MAX: Final = 40
_NOTICE_S: Final = 60.0
"""What was amiss on /tf and is not for so long was mended; /tf_static says its own only once."""
_CLOCKS_MAX: Final = 16
_NODES_NAMED: Final = 8


class Watching:
    """Listens to the topics of a system, within bounds, and to TF, time and parameters.

    Thread-safe; what nobody asks for some seconds ends by itself.

    Args:
        context: Of the session to listen by.
        types: Message types that are known.
        clock: Seconds that never go back.
        parameters: What somebody else hears of parameters; None: it listens itself.
    """

    def __init__(
        self,
        context: Context,
        types: TypeLibrary,
        clock: Callable[[], float] = time.monotonic,
        parameters: ParameterChanges | None = None,
    ) -> None:
        self._context, self._types, self._clock = context, types, clock
        self._lock = threading.Lock()
        self._rates = TopicRates(self._watch, _BYTES_MAX)
        self._system: System | None = None
        self._own_parameters = ParameterChanges(lambda: types, _SINCE, clock)
        self._parameters = parameters or self._own_parameters
        self._begin()

    def _begin(self) -> None:
        """Know nothing yet, but which parameters were changed before."""
        self._began_s = self._clock()
        self._watches: dict[str, TopicWatch] = {}
        self._frames, self._times = _Frames(self._name_of, self._clock), _Times()

    def heard(self, system: System) -> Heard:
        """Return what was heard, and go on listening to what is published now."""
        topics, left_out = _chosen(system)
        with self._lock:
            self._system = system
            if self._watches and not self._rates.measured:
                self._begin()  # nobody asked for a while: what was heard then is not so any more
            flows = self._rates.flows(topics)
            watches = {name: self._watches[name] for name in flows if name in self._watches}
            for gone in set(self._watches) - set(topics):
                self._watches.pop(gone).close()
        return Heard(
            listened_s=self._clock() - self._began_s,
            topics={
                name: self._heard_topic(one, system.topics[name]) for name, one in watches.items()
            },
            left_out=left_out,
            clock=self._times.heard() if _CLOCK in topics else None,
            frames=self._frames.heard(),
            parameters=self._parameters.heard(),
            offsets=tuple(self._offsets(watches.values(), system.own)),
        )

    @property
    def listens_to(self) -> tuple[str, ...]:
        """Topics that are received at this moment."""
        return self._rates.measured

    def close(self) -> None:
        """Listen no more."""
        with self._lock:
            self._rates.clear()

    def _watch(self, topic: str, kept_s: float) -> TopicWatch | None:
        """Begin to listen to a topic; the lock is held."""
        ends = self._system.topics.get(topic) if self._system else None
        if ends is None or not ends.senders:
            return None
        publisher = ends.senders[0]
        takers = {
            _TF: self._frames.take,
            _TF_STATIC: self._frames.take_static,
            _CLOCK: self._times.take,
            _EVENTS: self._take_event,
        }
        try:
            watch = TopicWatch(
                self._context,
                topic,
                kept_s,
                Reading(
                    has_header(self._types, publisher.type_name),
                    takers.get(topic),
                    _latched_key(ends.senders, self._context) if topic == _TF_STATIC else "",
                ),
                self._clock,
            )
        except RosNameError:  # found among the malformed tokens
            return None
        self._watches[topic] = watch
        return watch

    def _take_event(self, payload: bytes, sent: Attachment, _received_ns: int) -> None:
        if self._parameters is self._own_parameters:
            self._parameters.take(payload, sent.gid)

    def _heard_topic(self, watch: TopicWatch, ends: Ends) -> HeardTopic:
        header, is_paced = watch.header(), watch.topic not in _UNPACED
        is_latched = any(
            one.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for one in ends.senders
        )
        return HeardTopic(
            topic=watch.topic,
            type_name=ends.senders[0].type_name if ends.senders else "",
            listened_s=watch.listened_s,
            samples=watch.samples,
            pace=watch.pace() if is_paced and not is_latched else None,
            header=header
            and Header(
                header.stamp_ns,
                short(header.frame, _FRAME_LETTERS_MAX),
                header.sent_ns,
                header.received_ns,
                self._name_of(header.gid),
            ),
            has_header=watch.has_header,
            not_understood=watch.not_understood,
        )

    def _offsets(self, watches: Iterable[TopicWatch], own: frozenset[str]) -> Iterable[Offset]:
        """Return the least offset of each process of others, of all its topics."""
        found: dict[str, list[tuple[LeastOffset, GraphNode]]] = defaultdict(list)
        for watch in watches:
            for gid, offset in watch.offsets().items():
                end = self._context.graph.endpoint_of_gid(gid)
                if end is not None and end.node.zid not in own:
                    found[end.node.zid].append((offset, end.node))
        for process, offsets in found.items():
            yield Offset(
                process,
                tuple(dict.fromkeys(node.path for _, node in offsets))[:_NODES_NAMED],
                min(one.least_ns for one, _ in offsets),
                sum(one.samples for one, _ in offsets),
                offsets[0][1].bridge,
            )

    def _name_of(self, gid: bytes) -> str:
        found = self._context.graph.endpoint_of_gid(gid)
        return found.node.path if found else self._bridge_of(gid)

    def _bridge_of(self, gid: bytes) -> str:
        """Name the bridge that passed on a transform of one of several nodes on DDS."""
        for bridge in self._system.bridges if self._system else ():
            if gid in {sender_gid(bridge.zid, topic) for topic in (_TF, _TF_STATIC)}:
                return f"a node behind the {called(bridge)}"
        return ""


class _Frames:
    """TF in a buffer of its own; taken in by the drain's thread."""

    def __init__(self, name_of: Callable[[bytes], str], clock: Callable[[], float]) -> None:
        self._buffer, self._codecs = TransformBuffer(), (TransformCodec(), TransformCodec())
        self._name_of, self._clock = name_of, clock
        self._notices: dict[str, tuple[Notice, float]] = {}
        """By their sentences, the newest last, each with the time until which it counts."""

    def take(self, payload: bytes, sent: Attachment, _received_ns: int) -> None:
        """Take a message of /tf."""
        self._put(payload, sent, static=False)

    def take_static(self, payload: bytes, sent: Attachment, _received_ns: int) -> None:
        """Take a message of /tf_static."""
        self._put(payload, sent, static=True)

    def heard(self) -> HeardFrames:
        """Return all that is known of frames now."""
        reports, now_s = self._buffer.report(most=_FRAMES_MAX), self._clock()
        return HeardFrames(
            tuple(reports),
            tuple(self._buffer.roots()),
            tuple(one for one, until_s in tuple(self._notices.values()) if now_s < until_s),
            time.time_ns(),
            max(0, self._buffer.count() - len(reports)),
        )

    def _put(self, payload: bytes, sent: Attachment, *, static: bool) -> None:
        try:
            columns = self._codecs[static].decode(payload)
        except CdrError:
            return  # its type says why, among the types
        publisher = self._name_of(sent.gid) or sent.gid.hex()
        until_s = math.inf if static else self._clock() + _NOTICE_S
        for one in self._buffer.put(columns, static=static, publisher=publisher):
            self._notices.pop(one.sentence, None)
            self._notices[one.sentence] = one, until_s
        while len(self._notices) > _NOTICES_MAX:
            self._notices.pop(next(iter(self._notices)))


class _Times:
    """The time on /clock, of each that publishes one."""

    def __init__(self) -> None:
        self._newest: dict[bytes, tuple[int, int]] = {}

    def take(self, payload: bytes, sent: Attachment, received_ns: int) -> None:
        """Take a message of /clock."""
        if len(payload) < 12:
            return
        order = "little" if payload[1] & 1 else "big"
        sec = int.from_bytes(payload[4:8], order, signed=True)
        now_ns = sec * 1_000_000_000 + int.from_bytes(payload[8:12], order)
        if sent.gid in self._newest or len(self._newest) < _CLOCKS_MAX:
            self._newest[sent.gid] = now_ns, received_ns

    def heard(self) -> HeardClock | None:
        """Return the time that came last; None: none came."""
        newest = list(self._newest.values())
        if not newest:
            return None
        now_ns, received_ns = max(newest, key=lambda one: one[1])
        return HeardClock(now_ns, received_ns)


def has_header(types: TypeLibrary, type_name: str) -> bool:
    """Whether messages of a type begin with a header, as far as the type is known."""
    try:
        fields = types.find(type_name).fields
    except StudioError:
        return False
    return bool(fields) and fields[0].type.base == _HEADER


def _latched_key(publishers: tuple[GraphEndpoint, ...], context: Context) -> str:
    """Return the key of rmw_zenoh's publishers; a bridge to DDS has one that is known by itself."""
    one = next((end for end in publishers if not end.node.bridge), publishers[0])
    type_hash = one.type_hash or NO_HASH
    return str(DataKey(context.wire.domain, one.name, one.type_name, type_hash))


def _chosen(system: System) -> tuple[list[str], int]:
    """Return the topics to listen to, those of TF and time first, and how many are left out."""
    first = [_TF, _TF_STATIC, _CLOCK, _EVENTS]
    others = [
        name
        for name, ends in system.topics.items()
        if name not in first and name != _LOG and not is_hidden(name)
        if any(not system.is_own(one) for one in ends.senders)
    ]
    # Those with headers say more; nothing else distinguishes one from another.
    others.sort(
        key=lambda name: not has_header(system.types, system.topics[name].senders[0].type_name)
    )
    there = [name for name in first if name in system.topics and system.topics[name].senders]
    chosen = [*there, *others]
    return chosen[:TOPICS_MAX], max(0, len(chosen) - TOPICS_MAX)
