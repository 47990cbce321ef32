"""`studio action`: which actions there are, who serves them, and to send a goal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.action_goal import add_send_goal
from studio.cli.looking import (
    add_listing_options,
    add_looking_options,
    full_name,
    looking,
    print_listing,
    shown,
)
from studio.cli.verbs import Verbs

if TYPE_CHECKING:
    import argparse

    from studio.ros.graph.graph import Graph


def add(parser: argparse.ArgumentParser) -> None:
    """Give the parser the verbs of `action`."""
    verbs = Verbs(parser)
    listing = verbs.add("list", _list, "name the actions that somebody serves")
    add_listing_options(listing, "actions")
    add_looking_options(listing)
    info = verbs.add("info", _info, "say who serves an action and who may send goals")
    info.add_argument("action_name", metavar="ACTION")
    info.add_argument("-t", "--show-types", action="store_true", help="with its type")
    info.add_argument("-c", "--count", action="store_true", help="how many there are, alone")
    add_looking_options(info)
    kind = verbs.add("type", _type, "print the type of an action")
    kind.add_argument("action_name", metavar="ACTION")
    add_looking_options(kind)
    add_send_goal(verbs)


def _list(options: argparse.Namespace) -> None:
    with looking(options) as graph:
        print_listing(shown(graph.actions(), options), options)


def _type(options: argparse.Namespace) -> int:
    with looking(options) as graph:
        types = dict(graph.actions()).get(full_name(options.action_name), [])
        print("".join(f"{one}\n" for one in types), end="")
        return 0 if types else 1


def _info(options: argparse.Namespace) -> int:
    name = full_name(options.action_name)
    with looking(options) as graph:
        print(f"Action: {name}")
        for title, paths in _ends(graph, name):
            print(f"Action {title}: {len(paths)}")
            if not options.count:
                kind = f" [{', '.join(dict(graph.actions()).get(name, []))}]"
                print("".join(f"    {path}{kind * options.show_types}\n" for path in paths), end="")
    return 0


def _ends(graph: Graph, name: str) -> list[tuple[str, list[str]]]:
    return [
        ("clients", [node.path for node in graph.action_clients(name)]),
        ("servers", [node.path for node in graph.action_servers(name)]),
    ]
