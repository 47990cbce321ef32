"""Types that only other nodes know: asked of one that uses them, taken up if they are true."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import TypeDescriptionError
from studio.ros.profiles import NO_HASH
from studio.ros.remote.waiting import TIMEOUT_S, asked
from studio.ros.types.type_descriptions import (
    ACTION_QUESTIONS,
    DESCRIPTION_SERVICE,
    DESCRIPTION_SERVICE_TYPE,
    learn,
    matching_sources,
    owner_of,
)

if TYPE_CHECKING:
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue


def learn_from(node: Node, endpoint: GraphEndpoint, timeout_s: float = TIMEOUT_S) -> list[str]:
    """Ask the node of an endpoint what its type is made of; give the names that are new.

    Of a part of an action, such as its feedback, the whole action is asked.

    Raises:
        TypeDescriptionError: The node says no, or what it says cannot be trusted.
        NotServedError: It does not describe its types.
        NoAnswerError: It is silent.
    """
    descriptions, texts = _told(node, endpoint, timeout_s)
    return learn(node.wire.types, endpoint.type_name, descriptions, texts)


def texts_from(node: Node, endpoint: GraphEndpoint, timeout_s: float = TIMEOUT_S) -> dict[str, str]:
    """Ask the node of an endpoint how its type and all that it is made of are written.

    Those that say what is known here are given, by name: they hold the comments.

    Raises:
        TypeDescriptionError, NotServedError, NoAnswerError: As `learn_from`.
    """
    return matching_sources(node.wire.types, _told(node, endpoint, timeout_s)[1])


def _told(
    node: Node, endpoint: GraphEndpoint, timeout_s: float
) -> tuple[dict[str, tuple[str, MessageValue]], list[MessageValue]]:
    """Give descriptions with their hashes by what was asked, and the sources of all."""
    name = endpoint.type_name
    if endpoint.type_hash == NO_HASH:
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
            response = asked(node, client, request, timeout_s)
            if not response.successful:
                raise TypeDescriptionError(name, f"its node says: {response.failure_reason[:300]}")
            descriptions[part] = (type_hash, response.type_description)
            texts += response.type_sources
    finally:
        node.destroy_client(client)
    return descriptions, texts


def _questions(node: Node, endpoint: GraphEndpoint) -> dict[str, str]:
    """Give the names and hashes to ask for: of an action all three parts, if they are there."""
    if "/action/" not in endpoint.type_name:
        return {endpoint.type_name: endpoint.type_hash}
    owner = owner_of(endpoint.type_name)
    parts = {f"{owner}_{part}" for part in ACTION_QUESTIONS.values()}
    return {
        one.type_name: one.type_hash
        for one in node.graph.endpoints_of(endpoint.node)
        if one.type_name in parts
    }
