"""The type of a service, an action or a topic: known here, or asked of a node that uses it."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, TypeVar

from studio.errors import StudioError, UnknownTypeError
from studio.ros.graph.graph import goal_service
from studio.ros.remote.type_asking import learn_from, texts_from
from studio.ros.types.type_descriptions import DESCRIPTION_SERVICE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ActionType, ServiceType

    Say = Callable[[str], object]

TypeT = TypeVar("TypeT")


def known_service(node: Node, name: str, type_name: str, say: Say) -> ServiceType:
    """Give a service's type; why a node did not tell it is said.

    Raises:
        UnknownTypeError: Nobody here or there knows it.
    """
    types = node.wire.types
    return _known(types.service, type_name, node, lambda: node.graph.servers(name), say)


def known_action(node: Node, name: str, type_name: str, say: Say) -> ActionType:
    """Give an action's type; else as `known_service`."""
    types = node.wire.types
    service = goal_service(name)
    return _known(types.action, type_name, node, lambda: node.graph.servers(service), say)


def known_message(node: Node, topic: str, type_name: str, say: Say) -> type[MessageValue]:
    """Give the type of a topic's messages; else as `known_service`."""

    def users() -> list[GraphEndpoint]:
        return [*node.graph.subscriptions(topic), *node.graph.publishers(topic)]

    return _known(node.wire.types.message, type_name, node, users, say)


def learn_from_any(node: Node, endpoints: Iterable[GraphEndpoint], say: Say) -> None:
    """Ask the nodes of endpoints in turn until one tells what its type is made of.

    Why one did not is said; whether the type is known is seen by who needs it.
    """
    for endpoint in endpoints:
        path = endpoint.node.path
        if not node.graph.has_server(f"{path}/{DESCRIPTION_SERVICE}"):  # asking would wait for it
            say(f"{path} does not tell what its types are made of.")
            continue
        try:
            learn_from(node, endpoint)
        except StudioError as error:
            say(f"{path}: {error}")
        else:
            return


def texts_of_any(node: Node, endpoints: Iterable[GraphEndpoint]) -> dict[str, str]:
    """Ask the nodes of endpoints in turn until one tells how its type is written; by name."""
    for endpoint in endpoints:
        if node.graph.has_server(f"{endpoint.node.path}/{DESCRIPTION_SERVICE}"):
            with suppress(StudioError):
                return texts_from(node, endpoint)
    return {}


def users_of(graph: Graph, name: str) -> list[GraphEndpoint]:
    """Tell who uses a type, or the parts of it that actions are made of."""
    ends = (end for node in graph.nodes() for end in graph.endpoints_of(node))
    is_action = "/action/" in name
    return [
        end
        for end in ends
        if end.type_name == name or (is_action and end.type_name.startswith(f"{name}_"))
    ]


def _known(
    find: Callable[[str], TypeT],
    type_name: str,
    node: Node,
    users: Callable[[], Iterable[GraphEndpoint]],
    say: Say,
) -> TypeT:
    try:
        return find(type_name)
    except UnknownTypeError:
        learn_from_any(node, users(), say)
        return find(type_name)
