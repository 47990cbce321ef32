"""Seen: the facts that all subjects conclude from; a part of which nothing is known is None."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.live.doctor.pace import PaceNow
    from studio.problems import Problem
    from studio.protocol.connection import WireReport
    from studio.protocol.displays import DisplayState
    from studio.protocol.doctor import Finding
    from studio.ros.graph.diagnosis import UnseenNodes
    from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
    from studio.ros.profiles import WireProfile
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.bridges.bridge import Bridge
    from studio.ros.wire.bridges.dialect import RouteKind
    from studio.tf.report import FrameReport
    from studio.tf.transforms import Notice

NAME_MAX: Final = 160
"""Letters of a name that are shown; those of peers may have any length."""
NAMED_MAX: Final = 6
"""So many names stand in one sentence or drawing."""
OF_ONE_CODE_MAX: Final = 30
"""So many findings of one code are shown: a thousand topics with one fault need no thousand."""


class Ends(NamedTuple):
    """Both ends of a topic: publishers and subscriptions; or of a service: servers and clients."""

    senders: tuple[GraphEndpoint, ...]
    receivers: tuple[GraphEndpoint, ...]


@dataclass(frozen=True, slots=True)
class System:
    """The graph of a domain at one moment, and how it is reached.

    Attributes:
        endpoint: Of the router.
        is_connected: Whether it is there.
        has_own_router: Whether this process started it.
        own: Sessions of the studio, whose nodes are its own.
        malformed: How many tokens were none, and what was wrong with the last.
        hash_of: The hash of a type as a distribution has it in keys; None: it has no such type.
        form_of: The same as it is computed, also where keys of the distribution hold none.
        zenoh: Its version here.
        bridges: To DDS, also those of other domains.
    """

    endpoint: str
    domain: int
    profile: WireProfile
    is_connected: bool
    has_own_router: bool
    own: frozenset[str]
    nodes: tuple[GraphNode, ...]
    topics: Mapping[str, Ends]
    services: Mapping[str, Ends]
    malformed: tuple[int, str]
    types: TypeLibrary
    hash_of: Callable[[str, str], str | None]
    form_of: Callable[[str, str], str | None]
    zenoh: str
    bridges: tuple[Bridge, ...]

    def is_own(self, end: GraphEndpoint) -> bool:
        """Whether an endpoint is of the studio."""
        return end.node.zid in self.own

    @property
    def fast_dds(self) -> frozenset[str]:
        """Nodes of which a bridge brings topics only, and no answer."""
        return frozenset(path for one in self.bridges for path in one.fast_dds_nodes)

    @property
    def others(self) -> tuple[GraphNode, ...]:
        """The nodes that are not the studio's."""
        return tuple(one for one in self.nodes if one.zid not in self.own)


@dataclass(frozen=True, slots=True)
class Header:
    """The newest header of a topic.

    Attributes:
        stamp_ns: As the message has it.
        sent_ns: By the clock of its sender, as its attachment has it; of what comes from DDS, when
            a bridge passed it on, by that one's clock.
        received_ns: By the clock of this machine.
        sender: The node that sent it; empty: it is not known.
    """

    stamp_ns: int
    frame: str
    sent_ns: int
    received_ns: int
    sender: str


@dataclass(frozen=True, slots=True)
class Offset:
    """How much later than they were sent samples of one process came, by two clocks.

    Attributes:
        least_ns: Negative where the sender's clock is ahead of this machine's.
        bridge: The bridge to DDS whose clock it is; empty: it is that of the nodes.
    """

    process: str
    nodes: tuple[str, ...]
    least_ns: int
    samples: int
    bridge: str = ""


@dataclass(frozen=True, slots=True)
class HeardTopic:
    """What came on one topic.

    Attributes:
        type_name: As it is published.
        listened_s: Since when it is listened to.
        samples: How many came.
        pace: How they come; None while the topic rests, because it is too heavy to be heard always.
        header: The newest; None: its messages have none, or none came.
        not_understood: Samples whose attachment is not of rmw_zenoh as it is now.
    """

    topic: str
    type_name: str
    listened_s: float
    samples: int
    pace: PaceNow | None
    header: Header | None
    has_header: bool
    not_understood: int


@dataclass(frozen=True, slots=True)
class HeardClock:
    """The time on /clock, and when it came, by the clock of this machine."""

    now_ns: int
    received_ns: int


@dataclass(frozen=True, slots=True)
class HeardFrames:
    """TF as it was heard.

    Attributes:
        reports: Of each frame.
        roots: Of each tree, the largest first.
        notices: On transforms that were left out, or that are worth knowing.
        now_ns: When this was so, by the clock of this machine.
        more: Frames that are left out.
    """

    reports: tuple[FrameReport, ...]
    roots: tuple[str, ...]
    notices: tuple[Notice, ...]
    now_ns: int
    more: int = 0


@dataclass(frozen=True, slots=True)
class ChangedParameter:
    """A parameter that has another value than before.

    Attributes:
        started: With which value it was declared; None: that was not heard.
        gid: Of the publisher of its node's events, by which this life of the node is known.
    """

    node: str
    name: str
    value: str
    started: str | None
    gid: bytes


class HeardParameters(NamedTuple):
    """What was heard of parameters, for how long, and since when, as the end of "since ..."."""

    changed: tuple[ChangedParameter, ...] = ()
    listened_s: float = 0.0
    since: str = ""


@dataclass(frozen=True, slots=True)
class Heard:
    """What listening found.

    Attributes:
        listened_s: Since its beginning.
        left_out: Topics that are not listened to, for there are too many.
    """

    listened_s: float
    topics: Mapping[str, HeardTopic]
    left_out: int
    clock: HeardClock | None
    frames: HeardFrames
    parameters: HeardParameters
    offsets: tuple[Offset, ...]


class Unrouted(NamedTuple):
    """An end of the studio that a bridge to DDS does not pass on, though one on DDS waits for it.

    `kind` and `name` are those by which the bridge knows it: of an action all parts are one.
    """

    own: GraphEndpoint
    other: GraphEndpoint
    kind: RouteKind
    name: str


@dataclass(frozen=True, slots=True)
class Answers:
    """What routers and nodes answered.

    Attributes:
        nodes_by_domain: Others' nodes.
        unseen: Processes whose nodes the router does not show.
        routers: Zenoh's version of each router that can be reached, by its id.
        sessions: Zenoh's version of each process that tells it, by its id.
        lost: Processes that told it before, and do no more; bridges to DDS, too.
        asked: Nodes that were asked whether they answer.
        silent: Those of them that did not.
        unrouted: What bridges to DDS should pass on for the studio, and do not.
        announcing: Sessions that bridges to DDS hear of; nodes of rmw_zenoh_cpp are in none.
    """

    nodes_by_domain: Mapping[int, int]
    unseen: UnseenNodes | None
    routers: Mapping[str, str]
    sessions: Mapping[str, str]
    asked: int
    silent: tuple[str, ...]
    lost: frozenset[str] = frozenset()
    unrouted: tuple[Unrouted, ...] = ()
    announcing: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Interface:
    """A network interface of this machine; None: that is not known here."""

    name: str
    is_up: bool | None
    is_loopback: bool | None
    has_multicast: bool | None


@dataclass(frozen=True, slots=True)
class Here:
    """This machine: its interfaces, and the variables of ROS's environment that are set."""

    interfaces: tuple[Interface, ...] = ()
    variables: Mapping[str, str] = field(default_factory=dict[str, str])


class SeenDisplay(NamedTuple):
    """A display of the document, and how it is; `state` None: it was not drawn yet."""

    id: str
    name: str
    state: DisplayState | None


@dataclass(frozen=True, slots=True)
class SeenDocument:
    """The open document.

    Attributes:
        id: Of the document.
        root: The root link of its robot; empty: it has none.
        fixed_frame: The one in use.
        fixed_trouble: Why nothing can be drawn in the fixed frame; empty: all can.
    """

    id: str
    title: str
    links: frozenset[str] = frozenset()
    root: str = ""
    fixed_frame: str = ""
    fixed_trouble: str = ""
    displays: tuple[SeenDisplay, ...] = ()
    problems: tuple[Problem, ...] = ()


class SeenBrowser(NamedTuple):
    """What draws the 3D view of the browser that asks."""

    renderer: str
    draws_by_software: bool


class Unanswered(NamedTuple):
    """A call or goal of the studio that was not answered; `why` is a sentence."""

    is_action: bool
    name: str
    why: str


@dataclass(frozen=True, slots=True)
class Seen:
    """All that is known."""

    here: Here = Here()
    place: WireReport | None = None
    """What there is where the studio would connect, while it is not connected."""
    system: System | None = None
    heard: Heard | None = None
    answers: Answers | None = None
    document: SeenDocument | None = None
    browser: SeenBrowser | None = None
    unanswered: tuple[Unanswered, ...] = ()


class Written:
    """Findings of one subject as they are made; beyond the limit of its code, the last comes again.

    Those beyond are only counted, and ten thousand need not be written for that.
    """

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._last: dict[str, Finding] = {}

    def __call__(self, code: str, write: Callable[[], Finding]) -> Finding:
        """Return the finding that `write` makes, or one like it."""
        self._counts[code] += 1
        if self._counts[code] <= OF_ONE_CODE_MAX:
            self._last[code] = write()
        return self._last[code]


@dataclass(frozen=True, slots=True)
class Looked:
    """What a subject looked at: how many things, and what they are in a few words."""

    count: int
    detail: str


def short(name: str, most: int = NAME_MAX) -> str:
    """Return a name that peers chose, cut in its middle where it is too long."""
    if len(name) <= most:
        return name
    half = (most - 1) // 2
    return f"{name[:half]}…{name[-half:]}"


def shown_nodes(ends: Iterable[GraphEndpoint]) -> tuple[str, ...]:
    """Return the first nodes of endpoints, each once."""
    return tuple(dict.fromkeys(short(one.node.path) for one in ends))[:NAMED_MAX]


def called(bridge: Bridge | str) -> str:
    """Return how a bridge to DDS is called in a sentence; one without a name is known by its id."""
    name = bridge if isinstance(bridge, str) else bridge.name
    return name if name.startswith("bridge ") else f"bridge {short(name)}"


def listed(names: Iterable[str], most: int = NAMED_MAX) -> str:
    """Return names in their order, each once, and how many more there are."""
    all_of_them = list(dict.fromkeys(names))
    more = len(all_of_them) - most
    shown = ", ".join(short(one) for one in all_of_them[:most])
    return f"{shown} and {more} more" if more > 0 else shown
