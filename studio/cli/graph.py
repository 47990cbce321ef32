"""The graph as a command sees it when it asks, and its names and types as `ros2` lists them."""

from __future__ import annotations

import sys
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeAlias

from studio.cli.wire import add_wire_options, opened_wire
from studio.ros.names import check_full_name, full_type_name, is_hidden

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Generator, Iterable

    from studio.cli.verbs import Verbs
    from studio.ros.graph.graph import Graph
    from studio.ros.wire.session import WireSession


_NamesOf: TypeAlias = "Callable[[Graph], list[tuple[str, list[str]]]]"
_FIRST_TOKENS_S = 1.0
_QUIET_S = 0.1
_NOBODY_ON_DDS = (
    "A bridge to DDS is there, but no DDS node is seen behind it: it needs the ROS_DOMAIN_ID of "
    "the nodes, their ROS_DISTRO if that is humble, and a network on which DDS finds them."
)


def add_graph_options(parser: argparse.ArgumentParser) -> None:
    """Options of a verb that reads the graph and does nothing else."""
    add_wire_options(parser, own_types=False)


@contextmanager
def opened_graph(options: argparse.Namespace) -> Generator[Graph]:
    """Join, and wait until the graph is known.

    Raises:
        NoRouterError: None answers.
    """
    from studio.ros.graph.graph import Graph

    with opened_wire(options, own_types=False) as wire, Graph(wire) as graph:
        settle(graph, options)
        if not graph.nodes():
            print(f"studio: {why_empty(wire)}", file=sys.stderr)
        yield graph


def why_empty(wire: WireSession) -> str:
    """Return why no node is seen: none is shown, or they are in other domains."""
    from studio.ros.graph.diagnosis import nodes_by_domain, unseen_nodes, why_nobody, why_unseen

    unseen = unseen_nodes(wire)
    if unseen is not None:
        return why_unseen(unseen)
    counts = Counter(nodes_by_domain(wire))
    for bridge in wire.bridges.current:
        if bridge.settings is not None:
            counts[bridge.settings.domain] += len(bridge.nodes)
    counts.pop(wire.domain, None)  # what came while this was asked
    if wire.bridges.current and not counts.total():
        return _NOBODY_ON_DDS
    endpoint = ", ".join(wire.settings.connect) or "the configured address"
    return why_nobody(endpoint, wire.domain, counts) or ""


def settle(graph: Graph, options: argparse.Namespace) -> None:
    """Wait until the graph is known, and then for `--spin-time`."""
    graph.settle()
    # A router that was just joined sends the tokens in parts, and at first perhaps none.
    graph.wait_for(lambda: graph.version > 0, _FIRST_TOKENS_S)
    seen = -1
    while seen != graph.version:
        seen = graph.version
        graph.wait_for(lambda: graph.version != seen, _QUIET_S)  # noqa: B023 - done within
        graph.settle()  # asked again: the answer of the first time may have been a part of it
    if options.spin_time > 0:
        graph.wait_for(lambda: False, options.spin_time)


def full_name(text: str) -> str:
    """Return a topic, service, action or node by its full name, the first slash added if missing.

    Raises:
        RosNameError: It breaks a rule.
    """
    return check_full_name(text if text.startswith("/") else f"/{text}")


def add_listing_options(parser: argparse.ArgumentParser, what: str) -> None:
    """Options of `list` verbs."""
    parser.add_argument("-t", "--show-types", action="store_true", help="with their types")
    parser.add_argument("-c", "--count", action="store_true", help="how many there are, alone")
    add_hidden_option(parser, what)


def add_hidden_option(parser: argparse.ArgumentParser, what: str) -> None:
    """Let hidden names be shown: those of which a part begins with an underscore."""
    parser.add_argument(
        f"--include-hidden-{what}", action="store_true", dest="hidden", help="hidden ones, too"
    )


def add_type_and_find(verbs: Verbs, noun: str, kind: str, names_of: _NamesOf) -> None:
    """Add the verbs `type`, which prints the types of a name, and `find`, the names of a type.

    Args:
        verbs: Those of `topic`, for example.
        noun: What has names and types: `topic`.
        kind: Of the types: `msg`.
        names_of: Returns each name with its types.
    """

    def print_types(options: argparse.Namespace) -> int:
        with opened_graph(options) as graph:
            types = dict(names_of(graph)).get(full_name(options.name), [])
        print("".join(f"{one}\n" for one in types), end="")
        return 0 if types else 1

    def print_names(options: argparse.Namespace) -> None:
        wanted = full_type_name(options.type, kind)
        with opened_graph(options) as graph:
            found = visible_names(names_of(graph), options)
        names = [name for name, types in found if wanted in types]
        print(f"{len(names)}\n" if options.count else "".join(f"{one}\n" for one in names), end="")

    of_name = verbs.add("type", print_types, f"print the type of a {noun}")
    of_name.add_argument("name", metavar=noun.upper())
    add_graph_options(of_name)
    find = verbs.add("find", print_names, f"name the {noun}s of a type")
    find.add_argument("type", metavar="TYPE")
    find.add_argument("-c", f"--count-{noun}s", dest="count", action="store_true")
    add_hidden_option(find, f"{noun}s")
    add_graph_options(find)


def visible_names(
    found: Iterable[tuple[str, list[str]]], options: argparse.Namespace
) -> list[tuple[str, list[str]]]:
    """Leave hidden names out unless they are asked for."""
    return [(name, types) for name, types in found if options.hidden or not is_hidden(name)]


def print_listing(found: list[tuple[str, list[str]]], options: argparse.Namespace) -> None:
    """Print names as `ros2`'s `list` verbs do."""
    if options.count:
        print(len(found))
        return
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if options.show_types else name)


def print_other_types(name: str, wanted: str, found: Iterable[tuple[str, list[str]]]) -> None:
    """Print on stderr that a name has other types than the one given: they never match."""
    types = dict(found).get(name)
    if types and wanted not in types:
        print(f"WARNING: {name} has the type {', '.join(types)}, not {wanted}", file=sys.stderr)


def print_unknown(what: str, name: str) -> int:
    """Print that nothing has a name; return ros2's exit code."""
    print(f"Unknown {what} '{name}'", file=sys.stderr)
    return 1
