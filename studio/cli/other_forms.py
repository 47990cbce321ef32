"""Types that others have in a form of their own: taken as the node tells them that has them."""

from __future__ import annotations

import sys
from functools import cache
from typing import TYPE_CHECKING

from studio.errors import NotServedError, StudioError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.cli.acting import Actor
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.definitions import Message


def told_form(
    actor: Actor, ends: Sequence[GraphEndpoint]
) -> tuple[type[MessageValue], GraphEndpoint] | None:
    """Give the class of a type as one of its users has it, where nobody has it as we do.

    None where somebody does, where the form is only another distribution's, which is chosen by
    name, and where nobody tells it. What is known otherwise stays as it is.
    """
    if not ends or not _is_nobodys(actor, ends):
        return None
    for end in ends:
        try:
            kind = _class_as_told(actor, end)
        except StudioError:
            continue
        print(
            f"WARNING: {end.node.path} has another form of {end.type_name}, which is shown",
            file=sys.stderr,
        )
        return kind, end
    return None


def _is_nobodys(actor: Actor, ends: Sequence[GraphEndpoint]) -> bool:
    """Whether no end has our form of a type, nor one that a distribution is known to have."""
    from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes
    from studio.ros.profiles import NO_HASH

    wire = actor.node.wire
    if not wire.profile.has_type_hash or any(end.type_hash == NO_HASH for end in ends):
        return False  # Humble, here or there, where no form is told
    ours = wire.profile.type_hash(wire.types.hash_of(ends[0].type_name))
    if any(end.type_hash == ours for end in ends):
        return False
    found = foreign_hashes(ends, wire.profile, DistroHashes(wire.types))
    return all(not one.distros for one in found)


def _class_as_told(actor: Actor, end: GraphEndpoint) -> type[MessageValue]:
    """Ask the node of an end what its type is made of; its hash proves the answer.

    Raises:
        StudioError: It does not tell, or not the truth.
    """
    from studio.ros.node.spinning import call_service
    from studio.ros.types.type_descriptions import (
        DESCRIPTION_SERVICE,
        DESCRIPTION_SERVICE_TYPE,
        read_description,
    )

    service = f"{end.node.path}/{DESCRIPTION_SERVICE}"
    if not actor.graph.has_server(service):  # asking would wait for it
        raise NotServedError("service", service)
    client = actor.node.create_client(actor.types.service(DESCRIPTION_SERVICE_TYPE), service)
    try:
        request = client.srv_type.Request(type_name=end.type_name, type_hash=end.type_hash)
        response = call_service(actor.node, client, request)
    finally:
        actor.node.destroy_client(client)
    return _made(read_description(response.type_description, end.type_name, end.type_hash), end)


def _made(parts: Mapping[str, Message], end: GraphEndpoint) -> type[MessageValue]:
    from studio.ros.types.classes import make_class

    @cache
    def make(name: str) -> type[MessageValue]:
        return make_class(parts[name], make)

    return make(end.type_name)
