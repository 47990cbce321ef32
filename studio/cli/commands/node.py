"""`studio node`: list nodes and what they offer."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.cli.graph import add_graph_options, full_name, opened_graph
from studio.cli.verbs import Verbs
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    import argparse


_TITLES = (
    "Subscribers",
    "Publishers",
    "Service Servers",
    "Service Clients",
    "Action Servers",
    "Action Clients",
)
_DUPLICATES = (
    "WARNING: Be aware that there are nodes in the graph that share an exact name, "
    "which can have unintended side effects."
)


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `node` to the parser."""
    verbs = Verbs(parser)
    listing = verbs.add("list", _list, "name the nodes that are there")
    listing.add_argument("-a", "--all", action="store_true", dest="hidden", help="hidden ones, too")
    listing.add_argument("-c", "--count-nodes", action="store_true", dest="count")
    add_graph_options(listing)
    info = verbs.add("info", _info, "print what a node publishes, subscribes to, serves and calls")
    info.add_argument("node_name", metavar="NODE")
    info.add_argument("--include-hidden", action="store_true", dest="hidden")
    add_graph_options(info)


def _list(options: argparse.Namespace) -> None:
    with opened_graph(options) as graph:
        paths = [node.path for node in graph.nodes() if options.hidden or not is_hidden(node.path)]
        if len(set(paths)) < len(paths):
            print(_DUPLICATES, file=sys.stderr)
        print(len(paths) if options.count else "".join(f"{path}\n" for path in paths), end="")
        if options.count:
            print()


def _info(options: argparse.Namespace) -> int:
    from studio.ros.graph.graph import parts_of

    path = full_name(options.node_name)
    with opened_graph(options) as graph:
        same = [node for node in graph.nodes() if node.path == path]
        if not same:
            print(f"Unable to find node '{options.node_name}'", file=sys.stderr)
            return 1
        if len(same) > 1:
            print(
                f"There are {len(same)} nodes in the graph with the exact name '{path}'. "
                "You are seeing information about only one of them."
            )
        print(path)
        for title, rows in zip(
            _TITLES, parts_of(graph, same[0], hidden=options.hidden), strict=True
        ):
            print(f"  {title}:")
            print("\n".join(f"    {name}: {type_name}" for name, type_name in rows))
    return 0
