"""Which nodes are asked: the one that is named, or all that serve something."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.cli.looking import full_name
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    import argparse

    from studio.cli.acting import Actor
    from studio.errors import WireError


def node_asked_for(actor: Actor, options: argparse.Namespace) -> str | None:
    """Give the full name of the node; None, after words on stderr, when it is not there."""
    path = full_name(options.node_name)
    if any(node.path == path for node in actor.graph.nodes()):
        return path
    print("Node not found", file=sys.stderr)
    return None


def nodes_with(actor: Actor, service: str, type_name: str, *, hidden: bool) -> list[str]:
    """Name the nodes that serve `<node>/service` of a type, in order."""
    return [
        name.removesuffix(f"/{service}")
        for name, types in actor.graph.services()
        if name.endswith(f"/{service}") and type_name in types
        if hidden or not is_hidden(name)
    ]


def say(error: WireError) -> None:
    """Say on stderr what one of several nodes did not do."""
    print(error, file=sys.stderr)
