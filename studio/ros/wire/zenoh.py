"""The door to Zenoh: what this library uses of it, with types where Zenoh's own are missing."""

from __future__ import annotations

import atexit
import contextlib
import logging
import os
import threading
import time
from typing import TYPE_CHECKING, Any, Final, Generic, Protocol, TypeVar, cast

import zenoh
import zenoh.ext
from zenoh import Config, Reply, Sample, Session, TransportEvent, ZError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = [
    "BATCH_MAX",
    "REPLIES_WAITING_MAX",
    "SAMPLES_WAITING_MAX",
    "Config",
    "Declaration",
    "Incoming",
    "Outgoing",
    "Querier",
    "Query",
    "ReadingThread",
    "Replies",
    "Reply",
    "Sample",
    "Session",
    "TransportEvent",
    "ZError",
    "admin_answers",
    "all_admin_answers",
    "ask",
    "close",
    "declare_publisher",
    "declare_querier",
    "declare_queryable",
    "declare_stream",
    "declare_subscription",
    "declare_token",
    "insert",
    "live_tokens",
    "open_zenoh",
    "read_config",
    "router_change",
    "token_change",
    "use_few_threads",
    "wait_for_thread",
    "watch_tokens",
    "watch_transports",
]

SAMPLES_WAITING_MAX: Final = 65_536
"""Limit of a queue that loses nothing; Zenoh allocates it only as samples come."""
REPLIES_WAITING_MAX: Final = 64
"""Limit for one request."""
BATCH_MAX: Final = 512
_HEARTBEAT_S: Final = 0.5
_MATCHING_PAUSE_S: Final = 0.005
_CLOSE_TIMEOUT_S: Final = 1.0
_END_TIMEOUT_S: Final = 1.0
_EXIT_TIMEOUT_S: Final = 0.5
_RUNTIME_VARIABLE: Final = "ZENOH_RUNTIME"
_FEW_THREADS: Final = "(rx: (handover: app), app: (worker_threads: 1))"

ItemT = TypeVar("ItemT")
_log = logging.getLogger(__name__)
_late_threads: set[threading.Thread] = set()
"""Threads still inside Zenoh when nobody waited for them any longer."""


def use_few_threads() -> None:
    """Let one thread of Zenoh's receive everything; call it before Zenoh opens anything.

    By default it uses two, which wake each other for every sample: one takes a third less
    processor. A variable that is set for this process already, or an open session, is left alone.
    """
    os.environ.setdefault(_RUNTIME_VARIABLE, _FEW_THREADS)


def read_config(file: str | None = None) -> Config:
    """Read a configuration file of Zenoh's, or return its defaults.

    Raises:
        ZError: The file breaks Zenoh's rules.
        OSError: It cannot be read.
    """
    return zenoh.Config() if file is None else zenoh.Config.from_file(file)


def insert(config: Config, key: str, json5: str) -> None:
    """Set one key of a configuration.

    Raises:
        ZError: There is no such key, or it does not take this value.
    """
    cast("Any", config).insert_json5(key, json5)


def open_zenoh(config: Config) -> Session:
    """Open a session.

    Raises:
        ZError: Nobody answers where it connects, or it cannot listen where it should.
    """
    return zenoh.open(config)


def close(session: Session) -> None:
    """End a session and all that was declared on it, within a second; again is harmless.

    Zenoh waits for a peer that began a handshake and fell silent; that goes on without us.
    """
    if session.is_closed():
        return
    closing = threading.Thread(target=_close, args=(session,), name="zenoh-close", daemon=True)
    try:
        closing.start()
    except RuntimeError:  # since Python 3.12 none starts any more while the process ends
        _close(session)
    else:
        wait_for_thread(closing, _CLOSE_TIMEOUT_S)


def _close(session: Session) -> None:
    with contextlib.suppress(ZError):  # somebody was slower than Zenoh waits
        cast("Any", session).close()


def wait_for_thread(thread: threading.Thread, timeout_s: float = _END_TIMEOUT_S) -> None:
    """Wait so long for the end of a thread that may be inside Zenoh, and again as Python ends."""
    thread.join(timeout_s)
    if thread.is_alive():
        _late_threads.difference_update([one for one in _late_threads if not one.is_alive()])
        _late_threads.add(thread)


@atexit.register
def _wait_for_late_threads() -> None:
    """Wait again before the interpreter ends.

    Until Python 3.14 a thread that wants the interpreter back while it ends is unwound. Zenoh's
    frames catch that, and glibc then aborts the process ("exception not rethrown"). The wait is
    short: who is held for longer, by a peer that fell silent, is hardly back just then.
    """
    end_s = time.monotonic() + _EXIT_TIMEOUT_S
    for thread in tuple(_late_threads):
        thread.join(max(0.0, end_s - time.monotonic()))


class Declaration(Protocol):
    """A declaration of a session, valid until it is undeclared or the session is closed."""

    def undeclare(self) -> None:
        """Take it back; a second time is an error of Zenoh's."""
        ...


class _Source(Protocol):
    @property
    def handler(self) -> Any: ...  # noqa: ANN401
    def undeclare(self) -> None: ...


class Incoming(Generic[ItemT]):
    """A subscriber or queryable and its queue; one thread reads, any thread may undeclare.

    Zenoh's own may not be read and undeclared at the same time, their handlers may.
    """

    def __init__(self, source: object) -> None:
        self._source = cast("_Source", source)
        self._handler = cast("zenoh.Handler[ItemT]", self._source.handler)
        self._undeclared = threading.Lock()

    def try_recv(self) -> ItemT | None:
        """Take the oldest item, None when there is none or no more will come."""
        try:
            return self._handler.try_recv()
        except ZError:
            return None

    def take(self, most: int) -> list[ItemT]:
        """Take what waits, the oldest first, and at most so many."""
        taken: list[ItemT] = []
        receive = self._handler.try_recv
        try:
            while len(taken) < most and (item := receive()) is not None:
                taken.append(item)
        except ZError:  # no more will come
            pass
        return taken

    def __iter__(self) -> Iterator[ItemT]:
        """Wait for one item after the other, without holding the interpreter, until the end."""
        return iter(self._handler)

    def undeclare(self) -> None:
        """Take it back, which ends iterating; again is harmless."""
        if self._undeclared.acquire(blocking=False):
            with contextlib.suppress(ZError):  # its session has ended
                self._source.undeclare()


class ReadingThread(Generic[ItemT]):
    """Passes what comes in to a function, in batches, until it is closed.

    It sleeps in Zenoh until something comes, so that it costs nothing and is never late. Zenoh's
    own threads only fill the queue: a slow function holds up nobody else. A batch that cannot be
    handled is logged, and the next one is read.
    """

    def __init__(
        self, name: str, source: Incoming[ItemT], handle: Callable[[list[ItemT]], None]
    ) -> None:
        self._source, self._handle = source, handle
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Undeclare the source and end; again is harmless, and so is a session that has ended."""
        self._source.undeclare()
        if self._thread is not threading.current_thread():
            wait_for_thread(self._thread, _END_TIMEOUT_S)

    def _run(self) -> None:
        for first in self._source:
            batch = [first]
            while len(batch) < BATCH_MAX and (item := self._source.try_recv()) is not None:
                batch.append(item)
            try:
                self._handle(batch)
            except Exception:  # noqa: BLE001 - a listener of any room may raise anything
                _log.exception("%s could not take what came", self._thread.name)


class Outgoing(Declaration, Protocol):
    """A publisher, advanced or not."""

    def put(self, payload: bytes | bytearray, *, attachment: bytes | None = None) -> None:
        """Send one sample."""
        ...


class Querier(Declaration, Protocol):
    """Asks every complete queryable of its key."""

    def get(
        self,
        handler: zenoh.handlers.FifoChannel[Reply],
        *,
        payload: bytes | bytearray,
        attachment: bytes | None,
        cancellation_token: zenoh.CancellationToken | None = None,
    ) -> zenoh.Handler[Reply]:
        """Send a request; the handler ends after the last reply or the time-out."""
        ...


class Replies:
    """The replies to one request, as they come."""

    def __init__(
        self, querier: Querier, payload: bytes | bytearray, attachment: bytes | None
    ) -> None:
        """Send the request."""
        self._token = zenoh.CancellationToken()
        self._handler: zenoh.Handler[Reply] | None = querier.get(
            zenoh.handlers.FifoChannel(REPLIES_WAITING_MAX),
            payload=payload,
            attachment=attachment,
            cancellation_token=self._token,
        )

    def try_recv(self) -> Reply | None:
        """Take the oldest reply, None when there is none.

        Raises:
            ZError: The last reply was taken, the time is over, or the request was given up.
        """
        handler = self._handler
        if handler is None:
            raise ZError("the request was given up")
        return handler.try_recv()

    def cancel(self) -> None:
        """Give the request up; again is harmless."""
        # Zenoh waits here for its thread, which waits for room where replies come without end.
        self._handler = None
        cast("Any", self._token).cancel()  # whose return is not typed


class Query(Protocol):
    """A query that a queryable received; `drop` it, answered or not, else its asker waits."""

    @property
    def key_expr(self) -> zenoh.KeyExpr:
        """The data key."""
        ...

    @property
    def payload(self) -> zenoh.ZBytes | None:
        """The request as CDR."""
        ...

    @property
    def attachment(self) -> zenoh.ZBytes | None:
        """Number, time and sender of the request."""
        ...

    def reply(
        self,
        key_expr: zenoh.KeyExpr | str,
        payload: bytes | bytearray,
        *,
        attachment: bytes | None,
    ) -> None:
        """Answer on the key of the query."""
        ...

    def reply_err(self, payload: bytes) -> None:
        """Answer that it failed, which rmw_zenoh never does."""
        ...

    def drop(self) -> None:
        """Mark the end of the replies."""
        ...


def declare_publisher(
    session: Session,
    key: str,
    *,
    blocking: bool,
    reliable: bool,
    kept: int | None = None,
    is_for_others: bool = False,
) -> Outgoing:
    """Declare a publisher as rmw_zenoh does.

    Args:
        session: Where to declare.
        key: The data key.
        blocking: Wait when the network is slow; else samples are dropped.
        reliable: How samples travel.
        kept: How many samples late subscriptions get, None for none (volatile).
        is_for_others: Whether only other sessions get them.
    """
    detection = kept is not None and reliable
    return cast(
        "Outgoing",
        zenoh.ext.declare_advanced_publisher(
            session,
            key,
            congestion_control=_congestion(blocking=blocking),
            reliability=zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
            cache=None if kept is None else zenoh.ext.CacheConfig(max_samples=_room(kept)),
            publisher_detection=kept is not None,
            allowed_destination=zenoh.Locality.REMOTE if is_for_others else None,
            sample_miss_detection=_miss_detection() if detection else None,
        ),
    )


def _miss_detection() -> zenoh.ext.MissDetectionConfig:
    return zenoh.ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=_HEARTBEAT_S)


def _room(depth: int) -> int:
    """Bound a depth: it comes from peers, too, who may write any number."""
    return max(1, min(depth, SAMPLES_WAITING_MAX))


def _congestion(*, blocking: bool) -> zenoh.CongestionControl:
    return zenoh.CongestionControl.BLOCK if blocking else zenoh.CongestionControl.DROP


def declare_stream(
    session: Session,
    key: str,
    timeout_s: float,
    is_wanted: Callable[[], bool] = lambda: True,
) -> Outgoing:
    """Declare a publisher of messages that are sent as they are, once somebody subscribes them.

    Args:
        session: Where to declare.
        key: The data key.
        timeout_s: So long is waited for who subscribes it.
        is_wanted: Whether it is still waited for.

    Raises:
        ZError: Nobody did in time.
    """
    found = session.declare_publisher(
        key,
        congestion_control=zenoh.CongestionControl.BLOCK,
        reliability=zenoh.Reliability.RELIABLE,
        express=True,
    )
    end_s = time.monotonic() + timeout_s
    while not cast("Any", found).matching_status.matching:
        if time.monotonic() > end_s or not is_wanted():
            cast("Declaration", found).undeclare()
            raise ZError(f"nobody subscribes {key}")
        time.sleep(_MATCHING_PAUSE_S)
    return cast("Outgoing", found)


def ask(session: Session, key: str, payload: bytes, timeout_s: float) -> bytes | None:
    """Ask whoever answers a key; None when nobody did in time."""
    replies = session.get(key, _queue(), payload=payload, timeout=timeout_s)
    for reply in cast("Iterator[Reply]", replies):
        if reply.ok is not None:
            return reply.ok.payload.to_bytes()
    return None


def declare_subscription(
    session: Session,
    key: str,
    capacity: int,
    *,
    reliable: bool,
    wanted: int | None = None,
    is_of_others: bool = False,
) -> Incoming[Sample]:
    """Declare a subscriber as rmw_zenoh does, with a ring that keeps the newest samples.

    Args:
        session: Where to declare.
        key: The data key.
        capacity: How many samples the ring holds.
        reliable: Whether lost samples are asked for again (only with `wanted`).
        wanted: How many samples that were sent before it wants, None for none (volatile).
        is_of_others: Whether only samples of other sessions come.
    """
    ring: zenoh.handlers.RingChannel[Sample] = zenoh.handlers.RingChannel(_room(capacity))
    origin = zenoh.Locality.REMOTE if is_of_others else None
    if wanted is None:
        return Incoming(session.declare_subscriber(key, ring, allowed_origin=origin))
    recovery = zenoh.ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
    found = zenoh.ext.declare_advanced_subscriber(
        session,
        key,
        ring,
        history=zenoh.ext.HistoryConfig(detect_late_publishers=True, max_samples=_room(wanted)),
        recovery=recovery if reliable else None,
        subscriber_detection=True,
        allowed_origin=origin,
    )
    return Incoming(found)


def declare_queryable(
    session: Session, key: str, capacity: int, *, is_of_others: bool = False
) -> Incoming[Query]:
    """Declare a complete queryable whose oldest query is dropped when `capacity` is reached."""
    ring: zenoh.handlers.RingChannel[zenoh.Query] = zenoh.handlers.RingChannel(_room(capacity))
    origin = zenoh.Locality.REMOTE if is_of_others else None
    return Incoming(session.declare_queryable(key, ring, complete=True, allowed_origin=origin))


def declare_querier(
    session: Session, key: str, timeout_s: float, *, is_for_bridge: bool = False
) -> Querier:
    """Declare a querier that takes every reply as it comes.

    Servers of rmw_zenoh are complete queryables; those of bridges to DDS are not, and one suffices.
    """
    best, every = zenoh.QueryTarget.BEST_MATCHING, zenoh.QueryTarget.ALL_COMPLETE
    return cast(
        "Querier",
        session.declare_querier(
            key,
            target=best if is_for_bridge else every,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=timeout_s,
            allowed_destination=zenoh.Locality.REMOTE if is_for_bridge else None,
        ),
    )


def declare_token(session: Session, token: str) -> Declaration:
    """Show a node or endpoint to all who watch, for as long as the declaration is kept."""
    return cast("Declaration", session.liveliness().declare_token(token))


def watch_tokens(session: Session, tokens: str) -> Incoming[Sample]:
    """Collect changes of the tokens of a key expression, those alive first."""
    return Incoming(session.liveliness().declare_subscriber(tokens, _queue(), history=True))


def token_change(sample: Sample) -> tuple[str, bool]:
    """Return which token a sample of `watch_tokens` is about, and whether it is alive."""
    return str(sample.key_expr), sample.kind != zenoh.SampleKind.DELETE


def live_tokens(session: Session, tokens: str, timeout_s: float) -> Iterator[str]:
    """Ask for the tokens alive now; ends with the last answer or the time-out."""
    replies = session.liveliness().get(tokens, _queue(), timeout=timeout_s)
    for reply in cast("Iterator[Reply]", replies):
        if reply.ok is not None:
            yield str(reply.ok.key_expr)


def admin_answers(session: Session, key: str, timeout_s: float) -> Iterator[tuple[str, bytes]]:
    """Ask Zenoh's admin space; ends with the last answer or the time-out."""
    for reply in cast("Iterator[Reply]", session.get(key, _queue(), timeout=timeout_s)):
        if reply.ok is not None:
            yield str(reply.ok.key_expr), reply.ok.payload.to_bytes()


def all_admin_answers(
    session: Session, key: str, timeout_s: float, *, most: int, most_bytes: int
) -> tuple[list[tuple[str, bytes]], bool]:
    """Ask Zenoh's admin space, and take what comes as fast as it does.

    Args:
        session: That asks.
        key: What is asked for, a key expression.
        timeout_s: So long is waited for the last answer.
        most: So many answers are taken,
        most_bytes: and so many bytes of keys and values: who answers may send any amount.

    Returns:
        Keys and values, and whether they are all there are.
    """
    taken: list[tuple[str, bytes]] = []
    is_whole = True
    for reply in cast("Iterator[Reply]", session.get(key, _queue(), timeout=timeout_s)):
        if reply.ok is None:  # the time is over
            is_whole = False
            continue
        answered, payload = str(reply.ok.key_expr), reply.ok.payload
        most_bytes -= len(answered) + len(payload)
        if len(taken) >= most or most_bytes < 0:
            return taken, False  # Zenoh passes over what comes yet
        taken.append((answered, payload.to_bytes()))
    return taken, is_whole


def watch_transports(session: Session) -> Incoming[TransportEvent]:
    """Collect what opens and closes between this session and others, what is open first."""
    return Incoming(session.info.declare_transport_events_listener(_queue(), history=True))


def router_change(event: TransportEvent) -> tuple[str, bool] | None:
    """Return which router an event is about, and whether it is linked now; None for a peer."""
    if event.transport.whatami != zenoh.WhatAmI.ROUTER:
        return None
    return str(event.transport.zid), event.kind != zenoh.SampleKind.DELETE


def _queue() -> zenoh.handlers.FifoChannel[Any]:
    """Make a queue that loses nothing; its reader must not be slow."""
    return zenoh.handlers.FifoChannel(SAMPLES_WAITING_MAX)
