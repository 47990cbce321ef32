"""Types by name, known here or asked of a node that uses them."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from studio.errors import StudioError, TypeDescriptionError, UnknownTypeError
from studio.ros.graph.graph import goal_service
from studio.ros.node.spinning import ANSWER_TIMEOUT_S, call_service
from studio.ros.profiles import NO_HASH
from studio.ros.types.type_descriptions import (
    ACTION_QUESTIONS,
    DESCRIPTION_SERVICE,
    DESCRIPTION_SERVICE_TYPE,
    learn,
    matching_sources,
    owner_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph
    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import ActionType, ServiceType

TypeT = TypeVar("TypeT")
Report: TypeAlias = "Callable[[str], object]"


def learn_from(
    node: Node, endpoint: GraphEndpoint, timeout_s: float = ANSWER_TIMEOUT_S
) -> list[str]:
    """Ask the node of an endpoint to describe its type; return the names that are new.

    For a part of an action, such as its feedback, the whole action is asked for.

    Raises:
        TypeDescriptionError: The node refuses, or its description cannot be trusted.
        NotServedError: It does not describe its types.
        NoAnswerError: It does not answer.
    """
    descriptions, texts = _descriptions_of(node, endpoint, timeout_s)
    return learn(node.wire.types, endpoint.type_name, descriptions, texts)


def texts_from(
    node: Node, endpoint: GraphEndpoint, timeout_s: float = ANSWER_TIMEOUT_S
) -> dict[str, str]:
    """Ask the node of an endpoint for the definitions of its type and all that it uses.

    Definitions that agree with the types known here are returned by name: they have the comments.

    Raises:
        TypeDescriptionError, NotServedError, NoAnswerError: As `learn_from`.
    """
    return matching_sources(node.wire.types, _descriptions_of(node, endpoint, timeout_s)[1])


def _descriptions_of(
    node: Node, endpoint: GraphEndpoint, timeout_s: float
) -> tuple[dict[str, tuple[str, MessageValue]], list[MessageValue]]:
    """Return descriptions with their hashes by what was asked, and the sources of all."""
    name = endpoint.type_name
    if endpoint.type_hash in {NO_HASH, ""}:
        raise TypeDescriptionError(name, "nodes of Humble do not describe their types")
    client = node.create_client(
        node.wire.types.service(DESCRIPTION_SERVICE_TYPE),
        f"{endpoint.node.path}/{DESCRIPTION_SERVICE}",
    )
    descriptions: dict[str, tuple[str, MessageValue]] = {}
    texts: list[MessageValue] = []
    try:
        for part, type_hash in _questions(node, endpoint).items():
            request = client.srv_type.Request(
                type_name=part, type_hash=type_hash, include_type_sources=True
            )
            response = call_service(node, client, request, timeout_s)
            if not response.successful:
                raise TypeDescriptionError(name, f"its node says: {response.failure_reason[:300]}")
            descriptions[part] = (type_hash, response.type_description)
            texts += response.type_sources
    finally:
        node.destroy_client(client)
    return descriptions, texts


def _questions(node: Node, endpoint: GraphEndpoint) -> dict[str, str]:
    """Return the names and hashes to ask for: of an action all three parts, if they are there."""
    if "/action/" not in endpoint.type_name:
        return {endpoint.type_name: endpoint.type_hash}
    owner = owner_of(endpoint.type_name)
    parts = {f"{owner}_{part}" for part in ACTION_QUESTIONS.values()}
    return {
        one.type_name: one.type_hash
        for one in node.graph.endpoints_of(endpoint.node)
        if one.type_name in parts
    }


def known_service(node: Node, name: str, type_name: str, report: Report) -> ServiceType:
    """Return a service's type; `report` is called with why nodes did not describe it.

    Raises:
        UnknownTypeError: It is not known, and no node describes it.
    """
    types = node.wire.types
    return _known(types.service, type_name, node, lambda: node.graph.servers(name), report)


def known_action(node: Node, name: str, type_name: str, report: Report) -> ActionType:
    """Return an action's type; else as `known_service`."""
    types = node.wire.types
    service = goal_service(name)
    return _known(types.action, type_name, node, lambda: node.graph.servers(service), report)


def known_message(node: Node, topic: str, type_name: str, report: Report) -> type[MessageValue]:
    """Return the type of a topic's messages; else as `known_service`."""

    def users() -> list[GraphEndpoint]:
        return [*node.graph.subscriptions(topic), *node.graph.publishers(topic)]

    return _known(node.wire.types.message, type_name, node, users, report)


def learn_from_any(node: Node, endpoints: Iterable[GraphEndpoint], report: Report) -> None:
    """Ask the nodes of endpoints in turn until one describes its type.

    `report` is called with why others did not.
    """
    for endpoint in endpoints:
        path = endpoint.node.path
        if not node.graph.has_server(f"{path}/{DESCRIPTION_SERVICE}"):  # asking would wait for it
            report(f"{path} does not describe its types.")
            continue
        try:
            learn_from(node, endpoint)
        except StudioError as error:
            report(f"{path}: {error}")
        else:
            return


def texts_of_any(node: Node, endpoints: Iterable[GraphEndpoint]) -> dict[str, str]:
    """Ask the nodes of endpoints in turn until one sends the text of its type; by name."""
    for endpoint in endpoints:
        if node.graph.has_server(f"{endpoint.node.path}/{DESCRIPTION_SERVICE}"):
            with suppress(StudioError):
                return texts_from(node, endpoint)
    return {}


def users_of(graph: Graph, name: str) -> list[GraphEndpoint]:
    """Return the endpoints that use a type, or a part of it if it is an action."""
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
    report: Report,
) -> TypeT:
    try:
        return find(type_name)
    except UnknownTypeError:
        learn_from_any(node, users(), report)
        return find(type_name)
