"""`studio topic list`, `info`, `type` and `find`: topics in the graph and their ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.graph import (
    add_graph_options,
    add_listing_options,
    add_type_and_find,
    full_name,
    opened_graph,
    print_listing,
    print_unknown,
    visible_names,
)
from studio.cli.terminal import harmless

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Verbs
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph


def add(verbs: Verbs) -> None:
    """Add the verbs that only read."""
    listing = verbs.add("list", _list, "list the topics that have a publisher or a subscription")
    listing.add_argument("-v", "--verbose", action="store_true", help="how many publish each")
    add_listing_options(listing, "topics")
    add_graph_options(listing)
    info = verbs.add("info", _info, "print the type of a topic and its endpoints")
    info.add_argument("topic_name", metavar="TOPIC")
    info.add_argument(
        "-v", "--verbose", action="store_true", help="each end with its node, QoS and type hash"
    )
    add_graph_options(info)
    add_type_and_find(verbs, "topic", "msg", lambda graph: graph.topics())


def _list(options: argparse.Namespace) -> None:
    with opened_graph(options) as graph:
        found = visible_names(graph.topics(), options)
        if options.verbose and not options.count:
            print(_counts(graph, found))
        else:
            print_listing(found, options)


def _counts(graph: Graph, found: list[tuple[str, list[str]]]) -> str:
    sides = (("Published", "publisher", graph.publishers), ("Subscribed", "subscriber",
             graph.subscriptions))  # fmt: skip
    blocks: list[str] = []
    for title, noun, ends_of in sides:
        lines = [f"{title} topics:\n"]
        for name, types in found:
            count = len(ends_of(name))
            if count:
                ends = f"{count} {noun}{'s' if count > 1 else ''}"
                lines.append(f" * {name} [{', '.join(types)}] {ends}\n")
        blocks.append("".join(lines))
    return "\n".join(blocks)


def _info(options: argparse.Namespace) -> int:
    name = full_name(options.topic_name)
    with opened_graph(options) as graph:
        types = dict(graph.topics()).get(name)
        if types is None:
            return print_unknown("topic", options.topic_name)
        text = types[0] if len(types) == 1 else f"[{', '.join(types)}]"
        end = "\n\n" if options.verbose else "\n"
        print(f"Type: {text}", end=end)
        sides = (("Publisher", graph.publishers(name)), ("Subscription", graph.subscriptions(name)))
        for side, ends in sides:
            print(f"{side} count: {len(ends)}", end=end)
            if options.verbose:
                for one in ends:
                    print(endpoint_text(one, side.upper()), end=end)
    return 0


def endpoint_text(endpoint: GraphEndpoint, side: str) -> str:
    """Write one end of a topic as `ros2 topic info -v` does."""
    qos = endpoint.qos
    depth = f" ({qos.depth})" if qos.history.name == "KEEP_LAST" else ""
    return "\n".join(
        [
            f"Node name: {endpoint.node.name}",
            f"Node namespace: {endpoint.node.namespace}",
            f"Topic type: {endpoint.type_name}",
            f"Topic type hash: {harmless(endpoint.type_hash)}",
            f"Endpoint type: {side}",
            f"GID: {'.'.join(f'{byte:02x}' for byte in endpoint.gid)}",
            "QoS profile:",
            f"  Reliability: {qos.reliability.name}",
            f"  History (Depth): {qos.history.name}{depth}",
            f"  Durability: {qos.durability.name}",
            f"  Lifespan: {_span(qos.lifespan.nanoseconds)}",
            f"  Deadline: {_span(qos.deadline.nanoseconds)}",
            f"  Liveliness: {qos.liveliness.name}",
            f"  Liveliness lease duration: {_span(qos.liveliness_lease_duration.nanoseconds)}",
        ]
    )


def _span(nanoseconds: int) -> str:
    return f"{nanoseconds} nanoseconds" if nanoseconds else "Infinite"
