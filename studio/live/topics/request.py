"""Request: what is wanted of a topic, how it fits those who publish it, and how that stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

DEPTH_MAX: Final = 1_000
"""Of what somebody chooses."""
EVERY_DEPTH: Final = 4_096
"""So long may a subscriber be busy with other work: four seconds of a thousand messages each."""
WAITING_BYTES_MAX: Final = 64 << 20
"""Of one subscriber's queue."""

StateKind: TypeAlias = Literal[
    "not_connected", "connection_lost", "no_publisher", "other_type", "other_form", "refused",
    "receiving",
]  # fmt: skip


class Endpoint(NamedTuple):
    """A publisher or a subscription of somebody.

    `node` is a full name, `own` tells whether it is the studio's, `type_hash` is as keys carry it.
    """

    node: str
    own: bool
    type_name: str
    type_hash: str
    qos: QoSProfile


@dataclass(frozen=True, slots=True)
class Request:
    """What is wanted of a topic.

    Attributes:
        topic: In full.
        types: Of messages that can be used, the best first; empty: whatever is published.
        newest_only: Whether an older message is of no worth once there is a newer one.
        reliable: As somebody chose; None: as fits the publishers.
        latched: Whether messages from before are asked for (transient local); None: as fits.
        depth: The history's; None: as deep as a queue of this kind needs.
        usually: `reliable` and `latched` while nobody publishes and nobody chose.
        as_known_here: Whether the bytes are read here, so that the type's form must be ours.
        at_once: Whether somebody waits for each message.
        waiting_max: Messages that wait to be taken; then the oldest are given up.
    """

    topic: str
    types: tuple[str, ...] = ()
    newest_only: bool = False
    reliable: bool | None = None
    latched: bool | None = None
    depth: int | None = None
    usually: tuple[bool, bool] = (True, False)
    as_known_here: bool = False
    at_once: bool = False
    waiting_max: int = EVERY_DEPTH


class Fit(NamedTuple):
    """The type and the QoS with which a request is subscribed.

    `type_hash` is as keys carry it; None where no publisher shows one and the type is not known.
    """

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
            depth=self.depth,
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )


@dataclass(frozen=True, slots=True)
class SubscriptionState:
    """How a subscription stands.

    Attributes:
        kind: The first thing that is in the way; `receiving`: nothing is.
        fit: How it is subscribed; None: it is not.
        publishers: Of the topic, of any type.
        types: Under which it is published.
        reason: Why it was refused, in a sentence.
    """

    topic: str
    kind: StateKind = "not_connected"
    fit: Fit | None = None
    publishers: int = 0
    types: tuple[str, ...] = ()
    reason: str = ""

    @property
    def sentence(self) -> str:
        """What is in the way; empty: nothing is."""
        if self.kind == "refused":
            return self.reason
        wanted = self.fit.type_name if self.fit else "anything else"
        return _SENTENCES[self.kind].format(
            topic=self.topic, types=", ".join(self.types), wanted=wanted
        )


_SENTENCES: Final[dict[StateKind, str]] = {
    "not_connected": "There is no connection with a ROS 2 system.",
    "connection_lost": (
        "The router of ROS 2 is not there any more: it is joined again once it runs."
    ),
    "no_publisher": "Nobody publishes {topic}: start its node.",
    "other_type": "{topic} is published as {types}, and not as {wanted}.",
    "other_form": (
        "{topic} is published with a {wanted} of another form, so its bytes cannot be read here: "
        "run both sides with the same distribution of ROS 2."
    ),
    "receiving": "",
}


def fit_request(
    request: Request,
    publishers: Sequence[Endpoint],
    before: Fit | None,
    own_hash: Callable[[str], str | None],
) -> Fit | None:
    """Fit a request to those who publish, unless somebody chose otherwise.

    A topic that is latched by one is asked for what it said before; reliably, if all send so. While
    nobody publishes it is subscribed as most do: somebody who says one thing and is gone is heard
    only where nothing has to be opened anew. When all are gone, it stays subscribed as it was.

    Args:
        request: What is wanted.
        publishers: Of the topic, of any type.
        before: How it was subscribed until now.
        own_hash: Gives the hash of a type as publishers show it who have it as it is known here;
            None: it is not known.

    Returns:
        How to subscribe; None while it is not known with which type.
    """
    name = _type_of(request, publishers)
    fitting = [one for one in publishers if one.type_name == name]
    if not fitting and before is not None and _takes(request, before.type_name):
        return before
    if not name:
        return None
    reliable, latched = _offered(fitting) if fitting else request.usually
    type_hash = fitting[0].type_hash if fitting else own_hash(name)
    return Fit(
        name,
        own_hash(name) if request.as_known_here else type_hash,
        reliable if request.reliable is None else request.reliable,
        latched if request.latched is None else request.latched,
        _depth(request, fitting),
    )


def _type_of(request: Request, publishers: Sequence[Endpoint]) -> str:
    """The best that is published; else the best that is wanted, or nothing."""
    published = {one.type_name for one in publishers}
    if not request.types:
        return publishers[0].type_name if publishers else ""
    return next((one for one in request.types if one in published), request.types[0])


def _takes(request: Request, type_name: str) -> bool:
    return not request.types or type_name in request.types


def _offered(fitting: Sequence[Endpoint]) -> tuple[bool, bool]:
    reliable = all(one.qos.reliability is not ReliabilityPolicy.BEST_EFFORT for one in fitting)
    return reliable, any(map(_is_latched, fitting))


def _is_latched(endpoint: Endpoint) -> bool:
    return endpoint.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def _depth(request: Request, fitting: Sequence[Endpoint]) -> int:
    if request.depth is not None:
        return min(max(1, request.depth), DEPTH_MAX)
    if not request.newest_only:
        return EVERY_DEPTH
    return min(DEPTH_MAX, max(1, sum(map(_is_latched, fitting))))
