"""`studio lifecycle`: the states of managed nodes, and their ways from one to another."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from studio.cli.acting import acting
from studio.cli.asking import ask_node, node_asked_for, nodes_with, say
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options
from studio.errors import WireError

if TYPE_CHECKING:
    import argparse

    from studio.cli.acting import Actor

_TYPES = "lifecycle_msgs/srv"


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the verbs of `lifecycle`."""
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


def _managed(actor: Actor, *, hidden: bool) -> list[str]:
    return nodes_with(actor, "get_state", f"{_TYPES}/GetState", hidden=hidden)


def _nodes(options: argparse.Namespace) -> None:
    with acting(options) as actor:
        found = _managed(actor, hidden=options.hidden)
        print(f"{len(found)}\n" if options.count else "".join(f"{one}\n" for one in found), end="")


def _state(actor: Actor, node: str) -> str:
    state = ask_node(actor, f"{_TYPES}/GetState", f"{node}/get_state").current_state
    return f"{state.label} [{state.id}]"


def _get(options: argparse.Namespace) -> int:
    with acting(options) as actor:
        if options.node_name is not None:
            node = node_asked_for(actor, options)
            if node is None:
                return 1
            print(_state(actor, node))
            return 0
        for node in _managed(actor, hidden=options.hidden):
            try:
                print(f"{node}: {_state(actor, node)}")
            except WireError as error:
                say(error)
    return 0


def _transitions(actor: Actor, node: str, *, of_all_states: bool = False) -> list[Any]:
    service = "get_transition_graph" if of_all_states else "get_available_transitions"
    answer = ask_node(actor, f"{_TYPES}/GetAvailableTransitions", f"{node}/{service}")
    return answer.available_transitions


def _list(options: argparse.Namespace) -> int:
    with acting(options) as actor:
        node = node_asked_for(actor, options)
        if node is None:
            return 1
        for one in _transitions(actor, node, of_all_states=options.all):
            print(f"- {one.transition.label} [{one.transition.id}]")
            print(f"\tStart: {one.start_state.label}\n\tGoal: {one.goal_state.label}")
    return 0


def _set(options: argparse.Namespace) -> int:
    with acting(options) as actor:
        node = node_asked_for(actor, options)
        if node is None:
            return 1
        offered = [one.transition for one in _transitions(actor, node)]
        wanted = options.transition.strip()
        chosen = [one for one in offered if wanted in (one.label, str(one.id))]
        if not chosen:
            print("Unknown transition requested, available ones are:", file=sys.stderr)
            print(*(f"- {one.label} [{one.id}]" for one in offered), sep="\n", file=sys.stderr)
            return 1
        answer = ask_node(
            actor, f"{_TYPES}/ChangeState", f"{node}/change_state", transition=chosen[0]
        )
    print("Transitioning successful" if answer.success else "Transitioning failed")
    return 0 if answer.success else 1
