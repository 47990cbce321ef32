"""`studio doctor`: look for what keeps nodes apart."""

from __future__ import annotations

import platform
import sys
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

import studio
from studio.cli.graph import settle, why_empty
from studio.cli.terminal import harmless
from studio.cli.wire import add_wire_options, opened_wire
from studio.errors import StudioError
from studio.ros.names import is_hidden
from studio.ros.qos import why_unmatched

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.profiles import WireProfile
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.session import WireSession


_Section = tuple[str, list[tuple[str, object]]]


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `doctor` to the parser."""
    parser.description = "Look for what keeps nodes apart; exit code 1 when something does."
    parser.add_argument("-r", "--report", action="store_true", help="print all, also what is well")
    parser.add_argument(
        "-rf", "--report-failed", action="store_true", help="print only what is not well"
    )
    parser.add_argument(
        "-iw", "--include-warnings", action="store_true", help="as is: warnings are shown"
    )
    parser.add_argument("verb", nargs="?", choices=["hello"], help="as is: whether all can be met")
    add_wire_options(parser)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from studio.ros.graph.graph import Graph

    with opened_wire(options) as wire, Graph(wire) as graph:
        settle(graph, options)
        unseen = _unseen(wire)
        faults = [*unseen, *faults_of(graph, wire.types, wire.profile)]
        why_nobody = "" if graph.nodes() or unseen else why_empty(wire)
        if options.report:
            _print_sections([*_sections(wire, graph), *_fault_sections(faults, why_nobody)])
        elif options.report_failed:
            _print_sections(_fault_sections(faults, why_nobody))
        else:
            _print_verdict(graph, faults, why_nobody)
    return 1 if faults else 0


def _unseen(wire: WireSession) -> list[Fault]:
    from studio.ros.graph.diagnosis import unseen_nodes, why_unseen

    found = unseen_nodes(wire)
    return [Fault("unseen nodes", why_unseen(found))] if found else []


def _print_verdict(graph: Graph, faults: list[Fault], why_nobody: str) -> None:
    for fault in faults:
        print(f"{fault.kind}: {harmless(fault.sentence)}")
    if why_nobody:
        print(why_nobody)
    elif not faults:
        topics = [name for name, _ in graph.topics() if not is_hidden(name)]
        print(f"All is well: {len(graph.nodes())} nodes, {len(topics)} topics.")


def _sections(wire: WireSession, graph: Graph) -> list[_Section]:
    from studio.ros.graph.diagnosis import router_versions

    return [
        (
            "PLATFORM INFORMATION",
            [
                ("system", platform.platform()),
                ("python", sys.version.split()[0]),
                ("studio", studio.__version__),
            ],
        ),
        (
            "RMW MIDDLEWARE",
            [
                ("middleware name", "rmw_zenoh's wire, spoken by the studio"),
                ("distribution", wire.profile.distro),
                ("router", ", ".join(wire.settings.connect) or "of the configuration"),
                ("router's Zenoh", ", ".join(router_versions(wire)) or "unknown"),
                ("domain", wire.domain),
                ("session", wire.zid),
            ],
        ),
        ("NODE LIST", [(node.path, f"session {node.zid}") for node in graph.nodes()]),
        ("TOPIC LIST", [(name, _ends(graph, name, types)) for name, types in graph.topics()]),
        (
            "SERVICE LIST",
            [
                (name, f"{', '.join(types)}, servers {len(graph.servers(name))}")
                for name, types in graph.services()
            ],
        ),
    ]


def _ends(graph: Graph, name: str, types: list[str]) -> str:
    publishers, subscribers = len(graph.publishers(name)), len(graph.subscriptions(name))
    return f"{', '.join(types)}, publishers {publishers}, subscribers {subscribers}"


def _fault_sections(faults: list[Fault], why_nobody: str) -> list[_Section]:
    rows: list[tuple[str, object]] = [(one.kind, harmless(one.sentence)) for one in faults]
    if why_nobody:
        rows.append(("no nodes", why_nobody))
    return [("FINDINGS", rows or [("none", "all is well")])]


def _print_sections(sections: list[_Section]) -> None:
    """Print as `ros2 doctor --report` does: a title in capitals, names in one column."""
    for title, rows in sections:
        print(f"\n   {title}")
        width = max((len(name) for name, _ in rows), default=0)
        for name, value in rows:
            print(f"{name:<{width}} : {value}")


@dataclass(frozen=True, slots=True)
class Fault:
    """One problem: its kind, and a sentence."""

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
    # Reported once for nodes of one name, not for each of their services.
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
    from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes, why_not_received

    ends = [end for node in graph.nodes() for end in graph.endpoints_of(node)]
    for found in foreign_hashes(ends, profile, DistroHashes(types)):
        yield Fault("hash", why_not_received(found, profile))


def _malformed(graph: Graph) -> Iterator[Fault]:
    count, last = graph.malformed
    if count:
        yield Fault("token", f"{count} liveliness tokens were not understood; the last: {last}")
