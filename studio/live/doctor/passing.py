"""What bridges to DDS should pass on for the studio and do not, and who else announces to them.

It imports Zenoh (through `ros`), so it is imported when somebody asks.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from studio.errors import TokenError
from studio.live.doctor.seen import Unrouted
from studio.ros.wire.bridges.bridges import ANSWER_TIMEOUT_S
from studio.ros.wire.bridges.dialect import TOKENS, Route, parse_bridge_token, place_of
from studio.ros.wire.bridges.passing import missing_routes
from studio.ros.wire.zenoh import live_tokens

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Ends, System
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.wire.bridges.dialect import Place
    from studio.ros.wire.session import WireSession


def announcing_sessions(wire: WireSession) -> frozenset[str]:
    """Return the sessions that announce their ends to bridges; rmw_zenoh_cpp does not."""
    found: set[str] = set()
    for token in live_tokens(wire.zenoh, TOKENS, ANSWER_TIMEOUT_S):
        try:
            route = parse_bridge_token(token)
        except TokenError:
            continue
        if isinstance(route, Route):
            found.add(route.zid)
    return frozenset(found)


def unrouted_ends(wire: WireSession, system: System) -> tuple[Unrouted, ...]:
    """Return the studio's ends that have DDS nodes on the other side, and no route to them.

    It takes some seconds where one is missing.
    """
    wanted = _wanted(wire, system)
    missing = missing_routes(wire.zenoh, wanted)
    return tuple(wanted[bridge][place] for bridge, places in missing.items() for place in places)


def _wanted(wire: WireSession, system: System) -> dict[str, dict[Place, Unrouted]]:
    """Return, by bridge, what the studio announces and DDS nodes have the other end of."""
    found: dict[str, dict[Place, Unrouted]] = defaultdict(dict)
    for named in (system.topics, system.services):
        for ends in named.values():
            for own, other in _facing(ends, wire.zid):
                place = place_of(own.kind, own.name)
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
