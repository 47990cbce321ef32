"""What the Doctor asks of routers and nodes: who is there, of which version, and who answers.

And of this machine: its network interfaces and variables, as far as they matter to ROS.

It imports Zenoh (through `ros`), so it is imported when somebody asks.
"""

from __future__ import annotations

import os
import socket
import time
from collections import Counter
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.live.doctor.passing import announcing_sessions, unrouted_ends
from studio.live.doctor.seen import Answers, Ends, Here, Interface, System, short
from studio.live.doctor.subjects.network import NAMES
from studio.ros.graph.diagnosis import (
    DistroHashes,
    nodes_by_domain,
    unseen_nodes,
    versions_by_session,
)
from studio.ros.graph.questions import Question
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.session import WireSession

ASKED_MAX: Final = 60
"""Nodes that are asked at once."""
ANSWER_S: Final = 2.0
"""So long a node may take to answer."""
_LOOKS: Final = 3
_CHECK_EVERY_S: Final = 0.01
_ANSWERING: Final = "/get_parameters"
"""A service that every node has and that changes nothing: it is asked for no parameter at all."""
_NO_PARAMETERS: Final = bytes((0, 1, 0, 0, 0, 0, 0, 0))

_SYSTEM: Final = Path("/sys/class/net")
"""Of Linux; elsewhere only names are known."""
_UP, _LOOPBACK, _MULTICAST = 0x1, 0x8, 0x1000
_INTERFACES_MAX: Final = 64


def look_here(environment: Mapping[str, str] = os.environ) -> Here:
    """Return interfaces, without their addresses, and those variables of ROS that are set."""
    return Here(
        tuple(_interface(name) for _, name in socket.if_nameindex()[:_INTERFACES_MAX]),
        {name: environment[name] for name in NAMES if environment.get(name)},
    )


def _interface(name: str) -> Interface:
    try:
        flags = int((_SYSTEM / name / "flags").read_text(encoding="ascii"), 16)
        state = (_SYSTEM / name / "operstate").read_text(encoding="ascii").strip()
    except (OSError, ValueError):
        return Interface(short(name), None, None, None)
    is_up = bool(flags & _UP) and state != "down"
    return Interface(short(name), is_up, bool(flags & _LOOPBACK), bool(flags & _MULTICAST))


def look(
    wire: WireSession,
    graph: Graph,
    types: TypeLibrary,
    hashes: DistroHashes,
    *,
    own: frozenset[str],
) -> System:
    """Return the graph of a system as it is now; some milliseconds with thousands of nodes.

    Args:
        wire: The session.
        graph: Of its domain.
        types: Message types that are known.
        hashes: Those of every distribution.
        own: Sessions of the studio.
    """
    malformed, last = graph.malformed
    return System(
        endpoint=", ".join(wire.settings.connect),
        domain=wire.domain,
        profile=wire.profile,
        is_connected=wire.is_connected,
        has_own_router=wire.router is not None,
        own=own,
        nodes=tuple(graph.nodes()),
        topics=_ends(graph, EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION),
        services=_ends(graph, EndpointKind.SERVICE, EndpointKind.CLIENT),
        malformed=(malformed, last or ""),
        types=types,
        hash_of=hashes,
        form_of=hashes.form_of,
        zenoh=metadata.version("eclipse-zenoh"),
        bridges=graph.bridges,
    )


def _ends(graph: Graph, senders: EndpointKind, receivers: EndpointKind) -> dict[str, Ends]:
    sending, receiving = graph.all_of(senders), graph.all_of(receivers)
    return {
        name: Ends(_in_order(sending.get(name, ())), _in_order(receiving.get(name, ())))
        for name in sorted({*sending, *receiving})
    }


def _in_order(ends: tuple[GraphEndpoint, ...]) -> tuple[GraphEndpoint, ...]:
    if len(ends) < 2:
        return ends
    return tuple(sorted(ends, key=lambda end: (end.node.path, end.token)))


def ask(wire: WireSession, system: System, before: Answers | None = None) -> Answers:
    """Ask all of it; takes some seconds where somebody does not answer, so call it in a thread.

    Args:
        wire: The session.
        system: The graph as it is now.
        before: The answers of the last time, by which it is known who answers no more.
    """
    nodes = _nodes_by_domain(wire, system)
    unseen = unseen_nodes(wire)
    asked, silent = _silent_nodes(wire, system)
    routers, sessions = versions_by_session(wire, "router"), versions_by_session(wire, "peer")
    known = before.sessions.keys() | before.routers.keys() | before.lost if before else set[str]()
    there = {one.zid for one in system.nodes} | {one.zid for one in system.bridges}
    return Answers(
        nodes_by_domain=nodes,
        unseen=unseen,
        routers=routers,
        sessions=sessions,
        asked=asked,
        silent=silent,
        lost=frozenset((known - sessions.keys() - routers.keys()) & there),
        unrouted=unrouted_ends(wire, system) if system.bridges else (),
        announcing=announcing_sessions(wire) if system.bridges else frozenset(),
    )


def _nodes_by_domain(wire: WireSession, system: System) -> dict[int, int]:
    """Count others' nodes; a router answers with a part of its tokens, or none, now and then.

    Nodes on DDS show no token: those of bridges count in the domains of these.
    """
    most = Counter({system.domain: len(system.others)})
    for bridge in system.bridges:
        if not bridge.is_used and bridge.settings is not None:
            most[bridge.settings.domain] += len(bridge.nodes)
    for _ in range(_LOOKS):
        most |= Counter(nodes_by_domain(wire, own=system.own))
    return {domain: nodes for domain, nodes in sorted(most.items()) if nodes}


def _silent_nodes(wire: WireSession, system: System) -> tuple[int, tuple[str, ...]]:
    """Ask nodes of others, all at once; return how many were asked, and who did not answer."""
    cannot = system.fast_dds
    servers = [
        ends.senders[0]
        for name, ends in system.services.items()
        if name.endswith(_ANSWERING) and ends.senders and not system.is_own(ends.senders[0])
        if ends.senders[0].node.path not in cannot
    ][:ASKED_MAX]
    asked = [(one.node.path, Question(wire, one, _NO_PARAMETERS, ANSWER_S)) for one in servers]
    end_s = time.monotonic() + ANSWER_S
    while time.monotonic() < end_s and not all(one.is_answered() for _, one in asked):
        time.sleep(_CHECK_EVERY_S)
    silent = tuple(path for path, one in asked if not one.is_answered())
    for _, one in asked:
        one.close()
    return len(asked), silent
