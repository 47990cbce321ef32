"""Reports what there is at a router and why nodes are not seen, without joining the graph.

It imports Zenoh (through `ros`), so it is imported when a report is asked for.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.errors import NoRouterError, TokenError
from studio.live.connection.bridges import bridge_views
from studio.live.connection.plan import planned_wire
from studio.protocol.connection import DomainView, Verdict, WireReport
from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes, unseen_nodes
from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.messages import types_of
from studio.ros.names import split_action_part
from studio.ros.profiles import NO_HASH, PROFILES
from studio.ros.tokens import ADMIN_SPACE, EndpointKind, NodeToken, parse_token
from studio.ros.wire.endpoints import ProbeResult, parse_endpoint, probe
from studio.ros.wire.session import open_session
from studio.ros.wire.zenoh import live_tokens

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from studio.ros.wire.bridges.bridge import Bridge
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.settings import WireSettings
    from studio.settings import WireChoice

_QUERY_TIMEOUT_S: Final = 3.0
_TOPICS: Final = {EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION}
_LOOKS: Final = 4
_LOOK_PAUSE_S: Final = 0.15
_SHOWN_MAX: Final = 20
_TYPES_MAX: Final = 400
"""At most so many types are compared with every distribution: it is slow, and they suffice."""


@dataclass(slots=True)
class Census:
    """Who is there, by their liveliness tokens and by what bridges to DDS tell.

    Attributes:
        nodes: Number of other nodes by domain, also of those on DDS.
        endpoints: Of others in the domain examined, one for each form of a type.
        bridges: Bridges to DDS, of every domain.
        unseen: Number of processes that publish in that domain and have no node in the graph.
    """

    nodes: Counter[int] = field(default_factory=Counter[int])
    endpoints: dict[tuple[str, str], GraphEndpoint] = field(
        default_factory=dict[tuple[str, str], GraphEndpoint]
    )
    bridges: tuple[Bridge, ...] = ()
    unseen: int = 0

    def take(self, token: str, domain: int, own: Collection[str]) -> None:
        """Count one token, unless it is of the studio's own or none of ROS."""
        try:
            parsed = parse_token(token)
        except TokenError:
            return
        node = parsed if isinstance(parsed, NodeToken) else parsed.node
        if node.zid in own:
            return
        if isinstance(parsed, NodeToken):
            self.nodes[node.domain] += 1
        elif node.domain == domain:
            self._take_form(GraphEndpoint.of(token, parsed, GraphNode.of(parsed.node)))

    def take_bridges(self, bridges: tuple[Bridge, ...], domain: int) -> None:
        """Count the nodes behind bridges; one that does not tell its domain has the `domain`."""
        self.bridges = bridges
        for bridge in bridges:
            settings = bridge.settings
            self.nodes[settings.domain if settings else domain] += len(bridge.nodes)
            for end in bridge.ends if bridge.is_used else ():
                # Before Iron, DDS tells no hash of topics; of services and actions, mostly none.
                if end.type_hash or (end.kind in _TOPICS and not split_action_part(end.name)):
                    node = GraphNode.behind(bridge, end.participant, end.node)
                    self._take_form(GraphEndpoint.behind(end, node))

    def _take_form(self, end: GraphEndpoint) -> None:
        form = (end.type_name, end.type_hash)
        if form not in self.endpoints and len(self.endpoints) < _TYPES_MAX:
            self.endpoints[form] = end


def examine(choice: WireChoice, own: Collection[str], request: int = 0) -> WireReport:
    """Report what there is at a place; takes some seconds, so call it in a thread.

    Args:
        choice: The place; a router is never started.
        own: Sessions of the studio, whose nodes do not count.
        request: The number of the request that is answered.

    Raises:
        WireSettingsError: The settings are not valid.
    """
    settings = planned_wire(choice)
    answer = _answer_at(settings)
    if answer is ProbeResult.NOBODY:
        return _report(settings, "no_router", request, starts=_starts(choice, settings))
    if answer is ProbeResult.OTHER:
        return _report(settings, "foreign", request)
    try:
        with open_session(settings, types_of(settings.profile.distro)) as wire:
            census = count(wire, own)
            unseen = unseen_nodes(wire)
            census.unseen = unseen.count if unseen else 0
    except NoRouterError:
        verdict = "no_router" if answer is ProbeResult.UNKNOWN else "not_admitted"
        return _report(settings, verdict, request)
    return _judged(settings, census, request)


def count(wire: WireSession, own: Collection[str]) -> Census:
    """Count who is there in every domain, and behind bridges to DDS.

    A router that was just joined may show only a part at first, or nothing: so it is looked at
    until two looks have found the same.
    """
    census = _counted(wire, own)
    for _ in range(_LOOKS):
        time.sleep(_LOOK_PAUSE_S)
        before, census = census, _counted(wire, own)
        found = census.nodes, len(census.bridges)
        if any(found) and found == (before.nodes, len(before.bridges)):
            break
    return census


def _counted(wire: WireSession, own: Collection[str]) -> Census:
    census = Census()
    for token in set(live_tokens(wire.zenoh, f"{ADMIN_SPACE}/*/**", _QUERY_TIMEOUT_S)):
        census.take(token, wire.domain, own)
    wire.bridges.settle(_QUERY_TIMEOUT_S)
    census.take_bridges(wire.bridges.current, wire.domain)
    return census


def seen_distros(endpoints: Iterable[GraphEndpoint], hashes: DistroHashes) -> tuple[str, ...]:
    """Return the distributions that most of these types match; empty if nothing decides it.

    On DDS, those before Iron tell no hashes: of these that is Humble.
    """
    forms = [(one.type_name, one.type_hash or NO_HASH) for one in endpoints]
    fitting = {
        distro: sum(hashes(distro, name) == form for name, form in forms) for distro in PROFILES
    }
    most = max(fitting.values(), default=0)
    return tuple(distro for distro, fits in fitting.items() if most and fits == most)


def _answer_at(settings: WireSettings) -> ProbeResult:
    if len(settings.connect) != 1:
        return ProbeResult.UNKNOWN
    return probe(parse_endpoint(settings.connect[0]))


def _starts(choice: WireChoice, settings: WireSettings) -> bool:
    place = parse_endpoint(settings.connect[0])
    return choice.router != "off" and place.is_loopback and place.is_stream


def _judged(settings: WireSettings, census: Census, request: int) -> WireReport:
    """Return sentences on what a census means."""
    ends = census.endpoints.values()
    hashes = DistroHashes(types_of(settings.profile.distro))
    foreign = foreign_hashes(ends, settings.profile, hashes)
    return _report(
        settings,
        _verdict(settings.domain, census, is_foreign=bool(foreign)),
        request,
        census=census,
        distros=seen_distros(ends, hashes),
        types=tuple(name for one in foreign for name in one.types)[:_SHOWN_MAX],
    )


def _verdict(domain: int, census: Census, *, is_foreign: bool) -> Verdict:
    if census.unseen:
        return "unseen"
    if census.nodes[domain]:
        return "other_distro" if is_foreign else "fine"
    if census.nodes.total():
        return "other_domain"
    return "bridge" if census.bridges else "alone"


def _report(  # noqa: PLR0913 - the fields of one answer
    settings: WireSettings,
    verdict: Verdict,
    request: int,
    *,
    starts: bool = False,
    census: Census | None = None,
    distros: tuple[str, ...] = (),
    types: tuple[str, ...] = (),
) -> WireReport:
    nodes = census.nodes if census else Counter[int]()
    domains = [DomainView(domain=one, nodes=nodes[one]) for one in sorted(nodes) if nodes[one]]
    return WireReport(
        request=request,
        endpoint=", ".join(settings.connect),
        domain=settings.domain,
        distro=settings.profile.distro,
        verdict=verdict,
        starts_router=starts,
        nodes=nodes[settings.domain],
        domains=tuple(domains[:_SHOWN_MAX]),
        distros=distros,
        types=types,
        unseen=census.unseen if census else 0,
        bridges=bridge_views(census.bridges) if census else (),
    )
