"""Bridge: a bridge to DDS as it is now, made of its tokens and of what it tells; no I/O."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.ros.tokens import EndpointKind, gid_of
from studio.ros.wire.bridges.admin import (
    BRIDGE_NODE,
    Bounds,
    DdsNode,
    Rules,
    Settings,
    Told,
)
from studio.ros.wire.bridges.dialect import Route, RouteKind, route_ends

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.ros.qos import QoSProfile

_FAST_DDS: Final = "010f"
"""The vendor, which begins the GUID of each participant (DDSI-RTPS 2.5, 8.3.3.1 and 9.3.1.5)."""


@dataclass(frozen=True, slots=True)
class BridgedEnd:
    """A publisher, subscription, service or client of a DDS node, as a bridge passes it on.

    Attributes:
        identity: By which it is known; no other end has the same.
        node: Full name of its node, with the bridge's namespace in front.
        participant: The DDS participant; empty: the bridge did not tell whose it is.
        type_hash: Empty where DDS does not tell it, as before Iron and for most services.
    """

    identity: str
    kind: EndpointKind
    name: str
    type_name: str
    type_hash: str
    qos: QoSProfile
    node: str
    participant: str


@dataclass(frozen=True, slots=True)
class Bridge:
    """A bridge as it is now.

    Attributes:
        zid: Its Zenoh session.
        name: How people tell it from others: its namespace, else the machine of its nodes.
        version: Such as `1.10.0`; empty: it does not tell it.
        settings: How it was started; None: it does not tell.
        hosts: Names of the machines of its DDS nodes, in order.
        nodes: Full names of its nodes, in order.
        ends: What it passes on, without what another bridge shows as well.
        withheld: What its nodes have and it does not pass on: kind and name of each.
        is_used: Whether its domain is that of the session.
        twin: The name of a bridge that shows some of the same nodes; empty: none does.
    """

    zid: str
    name: str
    version: str
    settings: Settings | None
    hosts: tuple[str, ...]
    nodes: tuple[tuple[str, str], ...]
    """Participant and full name."""
    ends: tuple[BridgedEnd, ...]
    withheld: tuple[tuple[RouteKind, str], ...]
    is_used: bool
    twin: str

    @property
    def fast_dds_nodes(self) -> tuple[str, ...]:
        """Full names of nodes on Fast DDS: the bridge brings their topics only.

        It writes the headers of requests as Cyclone DDS does, so that services, actions and
        parameters of others get no answer (eclipse-zenoh/zenoh-plugin-ros2dds, issue 492).
        """
        return tuple(path for participant, path in self.nodes if participant.startswith(_FAST_DDS))

    @property
    def rules(self) -> Rules | None:
        """Its allow or deny list."""
        return self.settings.rules if self.settings else None


@dataclass(slots=True)
class Met:
    """What is known of a bridge that shows its token, before it is made a `Bridge`.

    Attributes:
        routes: By their tokens.
        told: What it answered last.
        asked: Whether it was asked.
        is_late: Whether it was slow to answer the last time.
        is_silent: Whether no answer came then: it was killed or cut off, and is still shown.
    """

    zid: str
    routes: dict[str, Route] = field(default_factory=dict[str, Route])
    told: Told = field(default_factory=Told)
    asked: bool = False
    is_late: bool = False
    is_silent: bool = False

    def hear(self, told: Told | None, *, is_whole: bool) -> None:
        """Take what it answered; of half an answer only what is no less than what is known."""
        self.asked = True
        self.is_silent = told is None and not is_whole
        if told is not None and (is_whole or len(told.nodes) >= len(self.told.nodes)):
            self.told = told


class Sender(NamedTuple):
    """The publisher of a sample: its GID, and the hash of its type as far as DDS told it."""

    gid: bytes
    type_hash: str


def senders_of(
    bridges: tuple[Bridge, ...], doubles: Mapping[str, frozenset[str]]
) -> dict[tuple[str, str], Sender | None]:
    """Return publishers by bridge and topic; None where another bridge has it, too."""
    found: dict[tuple[str, str], Sender | None] = {
        (zid, topic): None for zid, topics in doubles.items() for topic in topics
    }
    for bridge in bridges:
        for end in bridge.ends:
            if end.kind is EndpointKind.PUBLISHER:
                place = (bridge.zid, end.name)
                same = found.get(place)
                is_first = place not in found
                name = end.identity if is_first else f"{bridge.zid}/{end.name}"
                told = end.type_hash if is_first or (same and same.type_hash) else ""
                found[place] = Sender(gid_of(name), told)
    return found


def bridges_of(met: list[Met], domain: int) -> tuple[tuple[Bridge, ...], dict[str, frozenset[str]]]:
    """Return bridges, and by bridge the topics whose samples another one brings as well.

    Of several bridges in one DDS domain the first shows its nodes. They also see each other as a
    node with everything that they pass on, which is no node of a robot.
    """
    own_nodes = {BRIDGE_NODE} | {one.told.settings.node_name for one in met if one.told.settings}
    names = _names(met, own_nodes)
    shown: dict[tuple[str, str], str] = {}
    found: list[Bridge] = []
    ends_max = Bounds.of_each(len(met)).ends
    doubles: dict[str, frozenset[str]] = {}
    for one in met:
        settings = one.told.settings
        prefix = _prefix(settings)
        is_used = settings is None or settings.domain == domain
        nodes = _robot_nodes(one, own_nodes)
        twins = [node for node in nodes if (node.participant, prefix) in shown]
        fresh = [node for node in nodes if (node.participant, prefix) not in shown]
        for node in fresh if is_used else ():
            shown[node.participant, prefix] = names[one.zid]
        ends, doubles[one.zid] = _ends(one, fresh, prefix, ends_max)
        found.append(
            Bridge(
                zid=one.zid,
                name=names[one.zid],
                version=one.told.version,
                settings=settings,
                hosts=_hosts(one, nodes),
                nodes=tuple(sorted((node.participant, prefix + node.path) for node in fresh)),
                ends=ends,
                withheld=_withheld(one, nodes, prefix),
                is_used=is_used,
                twin=shown[twins[0].participant, prefix] if twins else "",
            )
        )
    return tuple(found), doubles


def _prefix(settings: Settings | None) -> str:
    return "" if settings is None else settings.namespace.rstrip("/")


def _robot_nodes(met: Met, own_nodes: set[str]) -> list[DdsNode]:
    return [node for node in met.told.nodes if node.path.rpartition("/")[2] not in own_nodes]


def _hosts(met: Met, nodes: Iterable[DdsNode]) -> tuple[str, ...]:
    return tuple(sorted({met.told.hosts.get(node.participant, "") for node in nodes} - {""}))


def _names(met: list[Met], own_nodes: set[str]) -> dict[str, str]:
    """Name bridges, each otherwise than the others."""
    plain = {one.zid: _name(one, own_nodes) for one in met}
    often = Counter(plain.values())
    return {zid: name if often[name] == 1 else f"{name} ({zid[:6]})" for zid, name in plain.items()}


def _name(met: Met, own_nodes: set[str]) -> str:
    if prefix := _prefix(met.told.settings):
        return prefix
    hosts = _hosts(met, _robot_nodes(met, own_nodes))
    return hosts[0] if len(hosts) == 1 else f"bridge {met.zid[:6]}"


def _ends(
    met: Met, fresh: list[DdsNode], prefix: str, ends_max: int
) -> tuple[tuple[BridgedEnd, ...], frozenset[str]]:
    """Return the ends of nodes that no other bridge shows, and topics that only others have."""
    of_route = _nodes_by_route(fresh)
    of_all = _nodes_by_route(met.told.nodes)
    settings = met.told.settings
    own = DdsNode("", f"/{settings.node_name if settings else BRIDGE_NODE}", ())
    ends: list[BridgedEnd] = []
    doubles: set[str] = set()
    for route in met.routes.values():
        local = route.name.removeprefix(prefix)
        nodes = of_route.get((route.kind, local), [])
        if not nodes and (route.kind, local) in of_all:
            if route.kind is RouteKind.PUBLISHER:
                doubles.add(route.name)
            continue
        for node in (nodes or [own])[: max(0, ends_max - len(ends))]:
            ends += _ends_of(met, route, node, prefix)
    return tuple(sorted(ends, key=lambda end: end.identity)), frozenset(doubles)


def _nodes_by_route(nodes: Iterable[DdsNode]) -> dict[tuple[RouteKind, str], list[DdsNode]]:
    found: dict[tuple[RouteKind, str], list[DdsNode]] = {}
    for node in nodes:
        for kind, name, _ in node.ends:
            found.setdefault((kind, name), []).append(node)
    return found


def _ends_of(met: Met, route: Route, node: DdsNode, prefix: str) -> Iterable[BridgedEnd]:
    for end in route_ends(route):
        local = end.name.removeprefix(prefix)
        dds = met.told.dds_ends.get((node.participant, RouteKind(end.kind.value), local))
        is_topic = end.kind.value in {"MP", "MS"}
        yield BridgedEnd(
            identity=f"{met.zid}/{node.participant}{node.path}/{end.kind}{end.name}",
            kind=end.kind,
            name=end.name,
            type_name=end.type_name,
            type_hash=(dds.type_hash if dds else "") or end.type_hash,
            qos=dds.qos if dds and is_topic else end.qos,
            node=prefix + node.path,
            participant=node.participant,
        )


def _withheld(met: Met, nodes: list[DdsNode], prefix: str) -> tuple[tuple[RouteKind, str], ...]:
    """Return what nodes have and no route is for."""
    routed = {(route.kind, route.name) for route in met.routes.values()}
    all_of = {(kind, prefix + name) for node in nodes for kind, name, _ in node.ends}
    return tuple(sorted(all_of - routed))
