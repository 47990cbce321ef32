"""The typed door to Zenoh: what the rooms of ros use of it, with types where its own are silent."""

from __future__ import annotations

import contextlib
import threading
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar, cast

import zenoh
import zenoh.ext

if TYPE_CHECKING:
    from collections.abc import Iterator

SAMPLES_WAITING_MAX = 65_536
"""Of a queue that loses nothing; Zenoh makes room for them only as they come."""
_HEARTBEAT_S = 0.5
_CLOSE_TIMEOUT_S = 1.0

ItemT = TypeVar("ItemT")


class Declared(Protocol):
    """What stands on a session until it is taken back, or the session is closed."""

    def undeclare(self) -> None:
        """Take it back; a second time is an error of Zenoh's."""
        ...


class _Source(Protocol):
    @property
    def handler(self) -> Any: ...  # noqa: ANN401
    def undeclare(self) -> None: ...


class Incoming(Generic[ItemT]):
    """What collects samples or queries; read by one thread, taken back by any.

    Zenoh's own may not be read and taken back at the same time, their handlers may.
    """

    def __init__(self, source: object) -> None:
        self._source = cast("_Source", source)
        self._handler = cast("zenoh.Handler[ItemT]", self._source.handler)
        self._taken_back = threading.Lock()

    def try_recv(self) -> ItemT | None:
        """Take the oldest one, None when there is none or no more will come."""
        try:
            return self._handler.try_recv()
        except zenoh.ZError:
            return None

    def take(self, most: int) -> list[ItemT]:
        """Take what waits, the oldest first, and no more than so many."""
        taken: list[ItemT] = []
        receive = self._handler.try_recv
        try:
            while len(taken) < most and (item := receive()) is not None:
                taken.append(item)
        except zenoh.ZError:  # no more will come
            pass
        return taken

    def __iter__(self) -> Iterator[ItemT]:
        """Wait for one after the other, without holding the interpreter, until the end."""
        return iter(self._handler)

    def undeclare(self) -> None:
        """Take it back, which ends iterating; again is harmless."""
        if self._taken_back.acquire(blocking=False):
            with contextlib.suppress(zenoh.ZError):  # its session has ended
                self._source.undeclare()


class Outgoing(Declared, Protocol):
    """A publisher, advanced or not."""

    def put(self, payload: bytes | bytearray, *, attachment: bytes | None = None) -> None:
        """Send one sample."""
        ...


class Asking(Declared, Protocol):
    """A querier: asks every complete queryable of its key."""

    def get(
        self,
        handler: zenoh.handlers.FifoChannel[zenoh.Reply],
        *,
        payload: bytes | bytearray,
        attachment: bytes,
        cancellation_token: zenoh.CancellationToken | None = None,
    ) -> zenoh.Handler[zenoh.Reply]:
        """Send a request; the handler ends after the last reply or the time-out."""
        ...


class Asked(Protocol):
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
        self, key_expr: zenoh.KeyExpr | str, payload: bytes | bytearray, *, attachment: bytes
    ) -> None:
        """Answer on the key of the query."""
        ...

    def reply_err(self, payload: bytes) -> None:
        """Answer that it failed, which rmw_zenoh never does."""
        ...

    def drop(self) -> None:
        """Say that no more replies come."""
        ...


def queue() -> zenoh.handlers.FifoChannel[Any]:
    """Make a queue that loses nothing; whoever reads it must not be slow."""
    return zenoh.handlers.FifoChannel(SAMPLES_WAITING_MAX)


def declare_token(session: zenoh.Session, token: str) -> Declared:
    """Show a node or endpoint to all who watch, for as long as what is given back is kept."""
    return cast("Declared", session.liveliness().declare_token(token))


def watch_tokens(session: zenoh.Session, tokens: str) -> Incoming[zenoh.Sample]:
    """Collect the tokens of a key expression, those that stand first."""
    return Incoming(session.liveliness().declare_subscriber(tokens, queue(), history=True))


def declare_publisher(
    session: zenoh.Session, key: str, *, blocking: bool, reliable: bool, kept: int | None = None
) -> Outgoing:
    """Declare as rmw_zenoh does.

    Args:
        session: Where to declare.
        key: The data key.
        blocking: Wait when the network is slow; else samples are dropped.
        reliable: How samples travel.
        kept: How many samples late subscriptions get, None for none (volatile).
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
            sample_miss_detection=_miss_detection() if detection else None,
        ),
    )


def _miss_detection() -> zenoh.ext.MissDetectionConfig:
    return zenoh.ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=_HEARTBEAT_S)


def _room(depth: int) -> int:
    """A depth comes from peers, too, who may write any number."""
    return max(1, min(depth, SAMPLES_WAITING_MAX))


def _congestion(*, blocking: bool) -> zenoh.CongestionControl:
    return zenoh.CongestionControl.BLOCK if blocking else zenoh.CongestionControl.DROP


def declare_subscription(
    session: zenoh.Session, key: str, capacity: int, *, reliable: bool, wanted: int | None = None
) -> Incoming[zenoh.Sample]:
    """Declare as rmw_zenoh does, into a ring that keeps the newest.

    Args:
        session: Where to declare.
        key: The data key.
        capacity: How many samples the ring holds.
        reliable: Whether lost samples are asked for again (only with `wanted`).
        wanted: How many samples that were sent before it wants, None for none (volatile).
    """
    ring: zenoh.handlers.RingChannel[zenoh.Sample] = zenoh.handlers.RingChannel(_room(capacity))
    if wanted is None:
        return Incoming(session.declare_subscriber(key, ring))
    recovery = zenoh.ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
    found = zenoh.ext.declare_advanced_subscriber(
        session,
        key,
        ring,
        history=zenoh.ext.HistoryConfig(detect_late_publishers=True, max_samples=_room(wanted)),
        recovery=recovery if reliable else None,
        subscriber_detection=True,
    )
    return Incoming(found)


def declare_queryable(session: zenoh.Session, key: str, capacity: int) -> Incoming[Asked]:
    """Declare a complete queryable whose oldest query is dropped when `capacity` is reached."""
    ring: zenoh.handlers.RingChannel[zenoh.Query] = zenoh.handlers.RingChannel(_room(capacity))
    return Incoming(session.declare_queryable(key, ring, complete=True))


def declare_querier(session: zenoh.Session, key: str, timeout_s: float) -> Asking:
    """Declare a querier that takes every reply as it comes."""
    return cast(
        "Asking",
        session.declare_querier(
            key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=timeout_s,
        ),
    )


def standing_tokens(session: zenoh.Session, tokens: str, timeout_s: float) -> Iterator[str]:
    """Ask for the tokens that stand now; ends with the last answer or the time-out."""
    replies = session.liveliness().get(tokens, queue(), timeout=timeout_s)
    for reply in cast("Iterator[zenoh.Reply]", replies):
        if reply.ok is not None:
            yield str(reply.ok.key_expr)


def admin_answers(
    session: zenoh.Session, key: str, timeout_s: float
) -> Iterator[tuple[str, bytes]]:
    """Ask Zenoh's admin space; ends with the last answer or the time-out."""
    for reply in cast("Iterator[zenoh.Reply]", session.get(key, queue(), timeout=timeout_s)):
        if reply.ok is not None:
            yield str(reply.ok.key_expr), reply.ok.payload.to_bytes()


def watch_transports(session: zenoh.Session) -> Incoming[zenoh.TransportEvent]:
    """Collect what opens and closes between this session and others, what is open first."""
    return Incoming(session.info.declare_transport_events_listener(queue(), history=True))


def insert(config: zenoh.Config, key: str, json5: str) -> None:
    """Set one key of Zenoh's configuration.

    Raises:
        zenoh.ZError: It has no such key, or not this value.
    """
    cast("Any", config).insert_json5(key, json5)


def close(session: zenoh.Session) -> None:
    """End a session and all that was declared on it, within a second; again is harmless.

    Zenoh waits for whoever began a handshake and fell silent; that goes on without us.
    """
    if session.is_closed():
        return
    closing = threading.Thread(target=_close, args=(session,), name="zenoh-close", daemon=True)
    try:
        closing.start()
    except RuntimeError:  # since Python 3.12 none starts any more while the process ends
        _close(session)
    else:
        closing.join(_CLOSE_TIMEOUT_S)


def _close(session: zenoh.Session) -> None:
    with contextlib.suppress(zenoh.ZError):  # it says that somebody was slower than it waits
        cast("Any", session).close()
