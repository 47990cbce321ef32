"""Ear: one topic that a display listens to, and how that is chosen by who publishes it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from studio.displays.display import Received
from studio.errors import InterfaceError
from studio.live.displays.mailbox import Mailbox
from studio.live.displays.reasons import OnWire
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.displays.display import TopicRole
    from studio.live.displays.display_list import Listening
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.samples import MessageInfo, RawCallback
    from studio.ros.types.library import TypeLibrary

_DEPTH_MAX: Final = 1_000


class Hearing(Protocol):
    """What an ear needs of the connection."""

    def hear(
        self, type_name: str, topic: str, take: RawCallback, qos: QoSProfile
    ) -> Callable[[], None]:
        """Hear a topic's messages as bytes; gives what ends that."""
        ...


class Wish(NamedTuple):
    """What to listen to, and how."""

    topic: str
    type_name: str
    reliable: bool
    latched: bool
    depth: int


class Ear:
    """Listens from its making until `close`; both in a thread, for both may wait.

    Raises:
        StudioError: The topic cannot be named so, or its type is not known.
    """

    def __init__(self, hearing: Hearing, wish: Wish, role: TopicRole) -> None:
        self.wish = wish
        self.mailbox = Mailbox(newest_only=role.newest_only)
        self.close = hearing.hear(wish.type_name, wish.topic, self._take, _qos(wish))

    def _take(self, data: bytes, info: MessageInfo) -> None:
        self.mailbox.post(Received(self.wish.type_name, data, info["received_timestamp"]))


def wish_for(
    role: TopicRole,
    topic: str,
    chosen: Listening,
    publishers: Sequence[GraphEndpoint],
    before: Wish | None = None,
) -> Wish:
    """Listen as fits those who publish, unless somebody chose otherwise.

    A topic that is latched by one is asked for what it said before; reliably, if all send so. When
    all are gone, it is listened to as `before`: they may come back.
    """
    name, latched, reliable = role.types[0], role.latched, role.reliable
    if fitting := [one for one in publishers if one.type_name in role.types]:
        name = min((one.type_name for one in fitting), key=role.types.index)
        latched = any(_is_latched(one.qos) for one in fitting)
        reliable = all(one.qos.reliability is not ReliabilityPolicy.BEST_EFFORT for one in fitting)
    elif before is not None:
        name, latched, reliable = before.type_name, before.latched, before.reliable
    return Wish(
        role.topic(topic),
        name,
        reliable if chosen.reliable is None else chosen.reliable,
        latched if chosen.latched is None else chosen.latched,
        min(max(1, chosen.depth or role.depth), _DEPTH_MAX),
    )


def on_wire(
    role: TopicRole, publishers: Sequence[GraphEndpoint], types: TypeLibrary, *, connected: bool
) -> OnWire:
    """What is known of those who publish the topic of a role."""
    fitting = [one for one in publishers if one.type_name in role.types]
    return OnWire(
        connected=True,
        lost=not connected,
        publishers=len(publishers),
        types=tuple(dict.fromkeys(one.type_name for one in publishers)),
        foreign_hash=bool(fitting) and all(_is_foreign(one, types) for one in fitting),
    )


def _is_foreign(endpoint: GraphEndpoint, types: TypeLibrary) -> bool:
    """Whether its type has another form than here; Humble's tokens carry no hash."""
    if not endpoint.type_hash.startswith("RIHS01_"):
        return False
    try:
        return types.hash_of(endpoint.type_name) != endpoint.type_hash
    except InterfaceError:
        return False


def _is_latched(qos: QoSProfile) -> bool:
    return qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def _qos(wish: Wish) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=wish.depth,
        reliability=(
            ReliabilityPolicy.RELIABLE if wish.reliable else ReliabilityPolicy.BEST_EFFORT
        ),
        durability=(
            DurabilityPolicy.TRANSIENT_LOCAL if wish.latched else DurabilityPolicy.VOLATILE
        ),
    )
