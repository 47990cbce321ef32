"""Asking a node's own services: those of its parameters and of its life."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from studio.cli.looking import full_name
from studio.errors import NoAnswerError, NotServedError, WireError
from studio.ros.names import is_hidden

if TYPE_CHECKING:
    import argparse

    from studio.cli.acting import Actor
    from studio.ros.types.classes import MessageValue

_TIMEOUT_S = 5.0


def ask_node(actor: Actor, type_name: str, service: str, **fields: Any) -> Any:  # noqa: ANN401
    """Ask one service and wait; gives the response.

    Raises:
        NotServedError: Nobody serves it.
        NoAnswerError: Its node does not answer.
    """
    kind = actor.types.service(type_name)
    client = actor.node.create_client(kind, service, timeout_s=_TIMEOUT_S)
    try:
        if not client.service_is_ready():
            raise NotServedError("service", service)
        request: MessageValue = kind.Request(**fields)
        future = client.call_async(request)
        if not actor.wait(future, _TIMEOUT_S):
            raise NoAnswerError("service", service, _TIMEOUT_S)
        return future.result()
    finally:
        actor.node.destroy_client(client)


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
