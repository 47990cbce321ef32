"""What is wrong in a graph: names, types, hashes and quality of service that do not fit."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

from studio.errors import StudioError
from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes, why_not_heard
from studio.ros.qos import why_unmatched

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.profiles import WireProfile
    from studio.ros.types.library import TypeLibrary


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong: which kind, and a sentence."""

    kind: str
    sentence: str


def faults_of(graph: Graph, types: TypeLibrary, profile: WireProfile) -> list[Fault]:
    """Find all that is wrong for one who speaks a profile, in the order of kinds and names."""
    return [
        *_duplicate_names(graph),
        *(fault for name, _ in graph.topics() for fault in _topic_faults(graph, name, types)),
        *(fault for name, _ in graph.services() for fault in _service_faults(graph, name, types)),
        *_foreign_hashes(graph, types, profile),
        *_malformed(graph),
        *(Fault("interface text", str(error)) for error in types.faults().values()),
    ]


def _duplicate_names(graph: Graph) -> Iterator[Fault]:
    for path, count in graph.duplicate_nodes().items():
        yield Fault(
            "duplicate name",
            f"{count} nodes are called {path}: start all but one with another name.",
        )


def _topic_faults(graph: Graph, name: str, types: TypeLibrary) -> Iterator[Fault]:
    publishers, subscriptions = graph.publishers(name), graph.subscriptions(name)
    yield from _type_faults(name, [*publishers, *subscriptions], types)
    for publisher in publishers:
        for subscription in subscriptions:
            if publisher.type_name != subscription.type_name:
                continue
            for reason in why_unmatched(publisher.qos, subscription.qos):
                yield Fault(
                    "QoS",
                    f"{name}: {reason} ({publisher.node.path} to {subscription.node.path}); "
                    "Zenoh carries it, DDS would not.",
                )


def _service_faults(graph: Graph, name: str, types: TypeLibrary) -> Iterator[Fault]:
    servers, clients = graph.servers(name), graph.clients(name)
    yield from _type_faults(name, [*servers, *clients], types)
    paths = [server.node.path for server in servers]
    # Of nodes with one name that is said, not each of their services.
    is_one_name = len(set(paths)) == 1 and paths[0] in graph.duplicate_nodes()
    if len(servers) > 1 and not is_one_name:
        yield Fault(
            "two servers",
            f"{name} is served {len(servers)} times, by {', '.join(paths)}: keep one.",
        )


def _type_faults(name: str, ends: list[GraphEndpoint], types: TypeLibrary) -> Iterator[Fault]:
    names = sorted({end.type_name for end in ends})
    if len(names) > 1:
        yield Fault("type", f"{name} has {len(names)} types, {', '.join(names)}: they never meet.")
    ordered = sorted(ends, key=lambda end: end.type_name)
    for type_name, same in groupby(ordered, key=lambda end: end.type_name):
        yield from _hash_faults(name, type_name, list(same), types)


def _hash_faults(
    name: str, type_name: str, ends: list[GraphEndpoint], types: TypeLibrary
) -> Iterator[Fault]:
    hashes = {end.type_hash for end in ends}
    if len(hashes) > 1:
        who = ", ".join(f"{end.node.path} {end.type_hash[:15]}" for end in ends)
        yield Fault("hash", f"{name}: {type_name} has several forms, which never meet ({who}).")
        return
    try:
        types.hash_of(type_name)
    except StudioError as error:
        yield Fault("unknown type", f"{name}: {error}")


def _foreign_hashes(graph: Graph, types: TypeLibrary, profile: WireProfile) -> Iterator[Fault]:
    ends = [end for node in graph.nodes() for end in graph.endpoints_of(node)]
    for found in foreign_hashes(ends, profile, DistroHashes(types)):
        yield Fault("hash", why_not_heard(found, profile))


def _malformed(graph: Graph) -> Iterator[Fault]:
    count, last = graph.malformed
    if count:
        yield Fault("token", f"{count} liveliness tokens were not understood; the last: {last}")
