"""`studio doctor`: whether router, domain and nodes are as they should be."""

from __future__ import annotations

import platform
import sys
from typing import TYPE_CHECKING

import studio
from studio.cli.looking import settle, why_empty
from studio.cli.terminal import harmless
from studio.cli.wire import add_wire_options, opened_wire
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    import argparse

    from studio.cli.faults import Fault
    from studio.ros.graph.graph import Graph
    from studio.ros.wire.session import WireSession

    Section = tuple[str, list[tuple[str, object]]]


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the options of `doctor`."""
    parser.description = "Look for what keeps nodes apart; exit code 1 when something does."
    parser.add_argument("-r", "--report", action="store_true", help="say all, also what is well")
    parser.add_argument(
        "-rf", "--report-failed", action="store_true", help="say all, but only of what is not well"
    )
    parser.add_argument(
        "-iw", "--include-warnings", action="store_true", help="as is: warnings are shown"
    )
    parser.add_argument("verb", nargs="?", choices=["hello"], help="as is: whether all can be met")
    add_wire_options(parser)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from studio.cli.faults import faults_of
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
    from studio.cli.faults import Fault
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


def _sections(wire: WireSession, graph: Graph) -> list[Section]:
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
                ("router's Zenoh", ", ".join(router_versions(wire)) or "not told"),
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


def _fault_sections(faults: list[Fault], why_nobody: str) -> list[Section]:
    rows: list[tuple[str, object]] = [(one.kind, harmless(one.sentence)) for one in faults]
    if why_nobody:
        rows.append(("no nodes", why_nobody))
    return [("FINDINGS", rows or [("none", "all is well")])]


def _print_sections(sections: list[Section]) -> None:
    """Print as `ros2 doctor --report` does: a title in capitals, names in one column."""
    for title, rows in sections:
        print(f"\n   {title}")
        width = max((len(name) for name, _ in rows), default=0)
        for name, value in rows:
            print(f"{name:<{width}} : {value}")
