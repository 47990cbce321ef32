"""Which nodes are asked: the one that is named, or all that serve something."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.cli.learning import say_foreign
from studio.cli.looking import full_name
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    import argparse

    from studio.cli.acting import Actor
    from studio.errors import WireError

_LATE_S = 0.5
_ASKED = ("rcl_interfaces/srv/", "lifecycle_msgs/srv/")
"""Types of the services that are asked here."""


def node_asked_for(actor: Actor, options: argparse.Namespace) -> str | None:
    """Give the full name of the node; None, after words on stderr, when it is not there."""
    path = full_name(options.node_name)
    # On a busy machine what stands may be told late, and this one is meant by its name.
    actor.graph.wait_for(lambda: actor.graph.node(path) is not None, _LATE_S)
    node = actor.graph.node(path)
    if node is None:
        print("Node not found", file=sys.stderr)
        return None
    ends = actor.graph.endpoints_of(node)
    say_foreign(actor, [end for end in ends if end.type_name.startswith(_ASKED)])
    return path


def nodes_with(actor: Actor, service: str, type_name: str, *, hidden: bool) -> list[str]:
    """Name the nodes that serve `<node>/service` of a type, in order."""
    found = [
        name
        for name, types in actor.graph.services()
        if name.endswith(f"/{service}") and type_name in types
        if hidden or not is_hidden(name)
    ]
    say_foreign(actor, [server for name in found for server in actor.graph.servers(name)])
    return [name.removesuffix(f"/{service}") for name in found]


def say(error: WireError) -> None:
    """Say on stderr what one of several nodes did not do."""
    print(error, file=sys.stderr)
