"""`studio lifecycle`: see and change the states of managed nodes."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.cli.own_node import named_node, nodes_serving, own_node, print_error
from studio.cli.terminal import harmless
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options
from studio.errors import WireError

if TYPE_CHECKING:
    import argparse
    from collections.abc import Generator

    from studio.cli.own_node import OwnNode
    from studio.ros.lifecycle.client import LifecycleClient


_TYPES = "lifecycle_msgs/srv"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `lifecycle` to the parser."""
    verbs = Verbs(parser)
    nodes = verbs.add("nodes", _nodes, "name the managed nodes")
    nodes.add_argument("-a", "--all", action="store_true", dest="hidden", help="hidden ones, too")
    nodes.add_argument("-c", "--count-nodes", action="store_true", dest="count")
    add_wire_options(nodes)
    get = verbs.add("get", _get, "print the state of a managed node, or of all")
    get.add_argument("node_name", metavar="NODE", nargs="?")
    get.add_argument("--include-hidden-nodes", action="store_true", dest="hidden")
    add_wire_options(get)
    listing = verbs.add("list", _list, "print the transitions that a node may take now")
    listing.add_argument("node_name", metavar="NODE")
    listing.add_argument("-a", "--all", action="store_true", help="those of all states")
    add_wire_options(listing)
    change = verbs.add("set", _set, "make a managed node change its state")
    change.add_argument("node_name", metavar="NODE")
    change.add_argument("transition", metavar="TRANSITION", help="by name or number")
    add_wire_options(change)


def _managed(own: OwnNode, *, hidden: bool) -> list[str]:
    return nodes_serving(own, "get_state", f"{_TYPES}/GetState", hidden=hidden)


def _nodes(options: argparse.Namespace) -> None:
    with own_node(options) as own:
        found = _managed(own, hidden=options.hidden)
        print(f"{len(found)}\n" if options.count else "".join(f"{one}\n" for one in found), end="")


def _state(own: OwnNode, node: str) -> str:
    from studio.ros.lifecycle.client import LifecycleClient

    with LifecycleClient(own.node, node) as remote:
        state = remote.state()
    return f"{harmless(state.label)} [{state.id}]"


def _get(options: argparse.Namespace) -> int:
    with own_node(options) as own:
        if options.node_name is not None:
            node = named_node(own, options)
            if node is None:
                return 1
            print(_state(own, node))
            return 0
        for node in _managed(own, hidden=options.hidden):
            try:
                print(f"{node}: {_state(own, node)}")
            except WireError as error:
                print_error(str(error))
    return 0


def _list(options: argparse.Namespace) -> int:
    with _named_client(options) as remote:
        if remote is None:
            return 1
        found = remote.transition_graph() if options.all else remote.available_transitions()
    for one in found:
        print(f"- {harmless(one.transition.label)} [{one.transition.id}]")
        print(f"\tStart: {one.start_state.label}\n\tGoal: {one.goal_state.label}")
    return 0


def _set(options: argparse.Namespace) -> int:
    with _named_client(options) as remote:
        return 1 if remote is None else _change(remote, options.transition.strip())


@contextmanager
def _named_client(options: argparse.Namespace) -> Generator[LifecycleClient | None]:
    """Yield a client of the node that is named; None, after a message, if it is not there."""
    from studio.ros.lifecycle.client import LifecycleClient

    with own_node(options) as own:
        node = named_node(own, options)
        if node is None:
            yield None
            return
        with LifecycleClient(own.node, node) as remote:
            yield remote


def _change(remote: LifecycleClient, wanted: str) -> int:
    offered = [one.transition for one in remote.available_transitions()]
    chosen = next((one for one in offered if wanted in (one.label, str(one.id))), None)
    if chosen is None:
        print("Unknown transition requested, available ones are:", file=sys.stderr)
        print(
            *(f"- {harmless(one.label)} [{one.id}]" for one in offered), sep="\n", file=sys.stderr
        )
        return 1
    succeeded = remote.change(int(chosen.id))
    print("Transitioning successful" if succeeded else "Transitioning failed")
    return 0 if succeeded else 1
