"""What bridges to DDS should pass on for the studio and do not.

It imports Zenoh (through `ros`), so it is imported when somebody asks.
"""

from __future__ import annotations

import time
from collections import defaultdict
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Unrouted
from studio.ros.names import is_hidden
from studio.ros.tokens import EndpointKind, EndpointToken, parse_token
from studio.ros.wire.bridges.admin import read_routes
from studio.ros.wire.bridges.bridges import ANSWER_TIMEOUT_S
from studio.ros.wire.bridges.dialect import Route, RouteKind, announcement, parse_bridge_token
from studio.ros.wire.zenoh import admin_answers

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.live.doctor.seen import Ends, System
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.wire.session import WireSession

_LOOKS: Final = 4
_ON_ITS_WAY_S: Final = 0.5
"""A bridge makes a route within a second after an end was announced."""


def unrouted_ends(wire: WireSession, system: System) -> tuple[Unrouted, ...]:
    """Return the studio's ends that have DDS nodes on the other side, and no route to them.

    Bridges are asked again until a route that is on its way had its time.
    """
    missing = _wanted(wire, system)
    for look in range(_LOOKS):
        if not missing:
            break
        if look:
            time.sleep(_ON_ITS_WAY_S)
        missing = _without_route(wire, missing)
    return tuple(one for ends in missing.values() for one in ends.values())


def _without_route(
    wire: WireSession, wanted: Mapping[str, Mapping[tuple[RouteKind, str], Unrouted]]
) -> dict[str, dict[tuple[RouteKind, str], Unrouted]]:
    found: dict[str, dict[tuple[RouteKind, str], Unrouted]] = {}
    for bridge, ends in wanted.items():
        answers = list(admin_answers(wire.zenoh, f"@/{bridge}/ros2/route/**", ANSWER_TIMEOUT_S))
        routed = read_routes(answers, wire.zid)
        left = {place: one for place, one in ends.items() if place not in routed}
        if answers and left:  # of one that does not answer nothing is known
            found[bridge] = left
    return found


def _wanted(wire: WireSession, system: System) -> dict[str, dict[tuple[RouteKind, str], Unrouted]]:
    """Return, by bridge, what the studio announces and DDS nodes have the other end of."""
    found: dict[str, dict[tuple[RouteKind, str], Unrouted]] = defaultdict(dict)
    for named in (system.topics, system.services):
        for ends in named.values():
            for own, other in _facing(ends, wire.zid):
                place = _announced(own)
                if place is not None and own.type_name == other.type_name:
                    found[other.node.zid].setdefault(place, Unrouted(own, other, *place))
    return found


def _facing(ends: Ends, zid: str) -> Iterator[tuple[GraphEndpoint, GraphEndpoint]]:
    """Pair an end of a session with one on DDS of each bridge."""
    for near, far in ((ends.senders, ends.receivers), (ends.receivers, ends.senders)):
        own = next((one for one in near if one.node.zid == zid), None)
        if own is not None:
            yield from (
                (own, one) for one in {one.node.zid: one for one in far if one.node.bridge}.values()
            )


def _announced(end: GraphEndpoint) -> tuple[RouteKind, str] | None:
    """Return kind and name by which bridges know an end; None: another part of its action does."""
    token = parse_token(end.token)
    if not isinstance(token, EndpointToken):
        return None
    if token.kind is EndpointKind.SUBSCRIPTION:
        return None if is_hidden(token.name) else (RouteKind.SUBSCRIPTION, token.name)
    text = announcement(token)
    route = parse_bridge_token(text) if text else None
    return (route.kind, route.name) if isinstance(route, Route) else None
