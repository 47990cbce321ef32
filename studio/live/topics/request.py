"""Request: a subscription to be made, its fit to the publishers, and its state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

DEPTH_MAX: Final = 1_000
"""Limit of a depth that a user chooses."""
EVERY_DEPTH: Final = 4_096
"""So long a subscriber may be busy: four seconds of a thousand messages each."""
WAITING_BYTES_MAX: Final = 64 << 20
"""Limit of one subscriber's queue."""

StateKind: TypeAlias = Literal[
    "not_connected", "connection_lost", "no_publisher", "other_type", "other_form", "refused",
    "receiving",
]  # fmt: skip


class Endpoint(NamedTuple):
    """A publisher or a subscription.

    `node` is a full name, `own` is true for the studio's, `type_hash` is as in liveliness tokens.
    """

    node: str
    own: bool
    type_name: str
    type_hash: str
    qos: QoSProfile


@dataclass(frozen=True, slots=True)
class Request:
    """A subscription to be made.

    Attributes:
        topic: Full name.
        types: Types that can be used, the best first; empty: whatever is published.
        newest_only: Whether an older message is of no use once there is a newer one.
        reliable: As a user chose; None: as fits the publishers.
        latched: Whether earlier messages are wanted (transient local); None: as fits.
        depth: Of the history; None: as deep as a queue of this kind needs.
        usually: `reliable` and `latched` while nobody publishes and no user chose.
        as_known_here: Whether the messages are decoded, so that the type's hash must be ours.
        at_once: Whether each message is waited for.
        waiting_max: Length of the queue; when full, the oldest are dropped.
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
        """The QoS of the subscription."""
        reliable, latched = self.reliable, self.latched
        return QoSProfile(
            depth=self.depth,
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )


@dataclass(frozen=True, slots=True)
class SubscriptionState:
    """State of a subscription.

    Attributes:
        kind: The first problem; `receiving`: there is none.
        fit: Type and QoS; None: not subscribed.
        publishers: Of the topic, of any type.
        types: Types published.
        reason: Why it was refused, in a sentence.
        is_live: Whether it is of what runs now, and not of a recording.
    """

    topic: str
    kind: StateKind = "not_connected"
    fit: Fit | None = None
    publishers: int = 0
    types: tuple[str, ...] = ()
    reason: str = ""
    is_live: bool = True

    @property
    def sentence(self) -> str:
        """The problem in a sentence; empty: there is none."""
        if self.kind == "refused":
            return self.reason
        wanted = self.fit.type_name if self.fit else "anything else"
        sentences = _SENTENCES if self.is_live else _SENTENCES | _OF_RECORDINGS
        return sentences[self.kind].format(
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
_OF_RECORDINGS: Final[dict[StateKind, str]] = {
    "no_publisher": "{topic} is not in the recording.",
    "other_type": "{topic} was recorded as {types}, and not as {wanted}.",
    "other_form": (
        "{topic} was recorded with a {wanted} of another form, which is not shown: start the "
        "studio with the distribution of ROS 2 that it was recorded with, as ROS_DISTRO=humble."
    ),
}


def fit_request(
    request: Request,
    publishers: Sequence[Endpoint],
    before: Fit | None,
    own_hash: Callable[[str], str | None],
) -> Fit | None:
    """Fit a request to the publishers, unless a user chose otherwise.

    If one publisher is latched, earlier messages are asked for; reliable, if all are. While nobody
    publishes, the usual QoS is used, for a publisher that sends one message and ends is received
    only if nothing has to be subscribed again. When all are gone, the fit stays.

    Args:
        request: The subscription to be made.
        publishers: Of the topic, of any type.
        before: The fit until now.
        own_hash: Returns the hash that publishers with our definition of a type show; None: the
            type is not known.

    Returns:
        Type and QoS; None while the type is not known.
    """
    name = _type_of(request, publishers)
    fitting = [one for one in publishers if one.type_name == name]
    if not fitting and before is not None and _takes(request, before.type_name):
        return before
    if not name:
        return None
    reliable, latched = _offered(fitting) if fitting else request.usually
    type_hash = _hash_of(fitting, own_hash(name)) if fitting else own_hash(name)
    return Fit(
        name,
        own_hash(name) if request.as_known_here else type_hash,
        reliable if request.reliable is None else request.reliable,
        latched if request.latched is None else request.latched,
        _depth(request, fitting),
    )


def _hash_of(fitting: Sequence[Endpoint], own: str | None) -> str:
    """Return the hash that publishers tell; of nodes on DDS that tell none, our own."""
    return next((one.type_hash for one in fitting if one.type_hash), own or "")


def _type_of(request: Request, publishers: Sequence[Endpoint]) -> str:
    """Return the best that is published; else the best that is wanted, or nothing."""
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
