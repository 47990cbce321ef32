"""Bridge: a bridge to DDS as it is now, made of its tokens and of what it tells; no I/O."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace
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
    from collections.abc import Iterable, Mapping, Set

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


def sender_gid(zid: str, topic: str) -> bytes:
    """Return the GID of samples of which nobody knows which node behind a bridge sent them."""
    return gid_of(f"{zid}/{topic}")


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
                gid = gid_of(end.identity) if is_first else sender_gid(*place)
                told = end.type_hash if is_first or (same and same.type_hash) else ""
                found[place] = Sender(gid, told)
    return found


_Way = tuple[str, str, RouteKind, str]
"""Participant, namespace of the bridge, kind and name: what two bridges may both pass on."""


def bridges_of(met: list[Met], domain: int) -> tuple[tuple[Bridge, ...], dict[str, frozenset[str]]]:
    """Return bridges, and by bridge the topics whose samples another one brings as well.

    Of what several bridges pass on of one DDS node, that of the first counts. They also see each
    other as a node with everything that they pass on, which is no node of a robot.
    """
    nodes = {one.zid: _robot_nodes(one, met) for one in met}
    names = dict(_names(met, nodes))
    ends_max = Bounds.of_each(len(met)).ends
    homes: dict[tuple[str, str], Met] = {}
    before: set[_Way] = set()
    found: list[Bridge] = []
    doubles: dict[str, frozenset[str]] = {}
    for one in met:
        settings, prefix, own = one.told.settings, _prefix(one), nodes[one.zid]
        is_used = settings is None or settings.domain == domain
        ends, doubles[one.zid] = _ends(one, own, before, ends_max)
        first = next((homes[p] for node in own if (p := (node.participant, prefix)) in homes), None)
        found.append(
            Bridge(
                zid=one.zid,
                name=names[one.zid],
                version=one.told.version,
                settings=settings,
                hosts=_hosts(one, own),
                nodes=tuple(
                    sorted(
                        (node.participant, prefix + node.path)
                        for node in own
                        if (node.participant, prefix) not in homes
                    )
                ),
                ends=ends,
                withheld=_withheld(one, own, before),
                is_used=is_used,
                twin=names[first.zid] if first and _is_twin(one, first, own, before) else "",
            )
        )
        if is_used:
            before.update(_ways(one, own))
            for node in own:
                homes.setdefault((node.participant, prefix), one)
    return _without_withheld_elsewhere(found, before), doubles


def _without_withheld_elsewhere(bridges: list[Bridge], ways: Set[_Way]) -> tuple[Bridge, ...]:
    """Leave out of what is withheld what another bridge passes on after all."""
    passed = {(kind, space + name) for _, space, kind, name in ways}
    return tuple(
        replace(one, withheld=tuple(end for end in one.withheld if end not in passed))
        if one.is_used
        else one
        for one in bridges
    )


def _is_twin(one: Met, first: Met, own: list[DdsNode], before: Set[_Way]) -> bool:
    """Whether it passes on what the first does; with lists they may share the work."""
    rules = [met.told.settings.rules for met in (one, first) if met.told.settings]
    return any(way in before for way in _ways(one, own)) or not any(rules)


def _ways(met: Met, nodes: list[DdsNode]) -> Iterable[_Way]:
    """Return what it passes on of nodes."""
    of_route, prefix = _nodes_by_route(nodes), _prefix(met)
    # A stranger may show a thousand routes of one name, with other types or QoS.
    routed = {(route.kind, route.name.removeprefix(prefix)) for route in met.routes.values()}
    for kind, local in routed:
        for node in of_route.get((kind, local), ()):
            yield node.participant, prefix, kind, local


def _prefix(met: Met) -> str:
    settings = met.told.settings
    return "" if settings is None else settings.namespace.rstrip("/")


def _robot_nodes(met: Met, all_met: list[Met]) -> list[DdsNode]:
    """Return its nodes without those by which it sees the other bridges of its domain."""
    settings = met.told.settings
    bridges = {
        f"{_prefix(one)}/{other.node_name}"
        for one in all_met
        if (other := one.told.settings) and settings and other.domain == settings.domain
    }
    return [node for node in met.told.nodes if node.path not in bridges]


def _hosts(met: Met, nodes: Iterable[DdsNode]) -> tuple[str, ...]:
    return tuple(sorted({met.told.hosts.get(node.participant, "") for node in nodes} - {""}))


def _names(met: list[Met], nodes: Mapping[str, list[DdsNode]]) -> Iterable[tuple[str, str]]:
    """Name bridges by their sessions, each otherwise than the others."""
    plain = {one.zid: _name(one, nodes[one.zid]) for one in met}
    often = Counter(plain.values())
    for zid, name in plain.items():
        yield zid, name if often[name] == 1 else f"{name} ({zid[:6]})"


def _name(met: Met, nodes: list[DdsNode]) -> str:
    hosts = _hosts(met, nodes)
    return _prefix(met) or (hosts[0] if len(hosts) == 1 else f"bridge {met.zid[:6]}")


def _ends(
    met: Met, nodes: list[DdsNode], before: Set[_Way], ends_max: int
) -> tuple[tuple[BridgedEnd, ...], frozenset[str]]:
    """Return the ends that no bridge before passes on, and topics that only others have."""
    of_route, prefix = _nodes_by_route(nodes), _prefix(met)
    of_all = _nodes_by_route(met.told.nodes)
    settings = met.told.settings
    own = DdsNode("", f"/{settings.node_name if settings else BRIDGE_NODE}", ())
    ends: list[BridgedEnd] = []
    doubles: set[str] = set()
    fresh_of: dict[tuple[RouteKind, str], list[DdsNode]] = {}
    for route in met.routes.values():
        local = route.name.removeprefix(prefix)
        place = (route.kind, local)
        if place not in fresh_of:
            having = of_route.get(place, [])
            fresh_of[place] = [
                node for node in having if (node.participant, prefix, *place) not in before
            ]
        fresh = fresh_of[place]
        if not fresh and place in of_all:
            if route.kind is RouteKind.PUBLISHER:
                doubles.add(route.name)
            continue
        for node in (fresh or [own])[: max(0, ends_max - len(ends))]:
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
        is_topic = end.kind in {EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION}
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


def _withheld(
    met: Met, nodes: list[DdsNode], before: Set[_Way]
) -> tuple[tuple[RouteKind, str], ...]:
    """Return what nodes have, no route is for, and no bridge before passes on."""
    prefix = _prefix(met)
    routed = {(route.kind, route.name) for route in met.routes.values()}
    all_of = {
        (kind, prefix + name)
        for node in nodes
        for kind, name, _ in node.ends
        if (node.participant, prefix, kind, name) not in before
    }
    return tuple(sorted(all_of - routed))
