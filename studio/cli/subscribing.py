"""Subscribing to a topic by its name, in the type, form and QoS that its publishers have."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from studio.cli.graph import full_name, print_other_types
from studio.cli.own_node import learn_type, warn_of_foreign_types
from studio.cli.qos_options import listening_profile
from studio.errors import NotServedError, StudioError, UnknownTypeError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Mapping, Sequence

    from studio.cli.own_node import OwnNode
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.node import Node
    from studio.ros.node.subscription import Subscription
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.definitions import Message


@dataclass(frozen=True, slots=True)
class Joined:
    """How a verb subscribes to a topic.

    Attributes:
        kind: Class of its messages; None where only the bytes are known.
        form: An endpoint with its own version of the type, which is used.
    """

    name: str
    kind: type[MessageValue] | None
    qos: QoSProfile
    form: GraphEndpoint | None = None


def join_topic(
    own: OwnNode, options: argparse.Namespace, topic: str, given_type: str | None, *, raw: bool
) -> Joined | None:
    """Find out the type of a topic; None, after a message on stderr, where it is not known.

    Where bytes are enough (`raw`), an unknown type is reported, and subscribed all the same.

    Raises:
        UnknownTypeError: The type is not known, and no node describes it.
    """
    name = full_name(topic)
    types = dict(own.graph.topics()).get(name, [])
    if not types:
        print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
    type_name = full_type_name(given_type) if given_type is not None else _only(name, types)
    if type_name is None:
        return None
    print_other_types(name, type_name, [(name, types)])
    publishers = own.graph.publishers(name)
    qos = listening_profile(options, [one.qos for one in publishers])
    kind, form = _form_of(own, name, type_name, raw=raw)
    return Joined(name, kind, qos, form)


def _form_of(
    own: OwnNode, name: str, type_name: str, *, raw: bool
) -> tuple[type[MessageValue] | None, GraphEndpoint | None]:
    """Return the class of a type, and who has it in the form that is meant if that is not ours.

    Raises:
        UnknownTypeError: It is not known, and its bytes are not enough.
    """
    publishers = [one for one in own.graph.publishers(name) if one.type_name == type_name]
    others = [one for one in own.graph.subscriptions(name) if one.type_name == type_name]
    try:
        kind = _class_of(own, type_name, [*publishers, *others])
    except UnknownTypeError as error:
        return None, _unread(error, [*publishers, *others], raw=raw)
    described = _described_form(own, publishers)
    if described is None:
        warn_of_foreign_types(own, publishers)
    return described or (kind, None)


def _unread(error: UnknownTypeError, ends: list[GraphEndpoint], *, raw: bool) -> GraphEndpoint:
    """Return an endpoint with an unknown type, and report it.

    Raises:
        UnknownTypeError: There is none, or its bytes are not enough.
    """
    if not ends:
        raise error
    if not raw:
        reason = error.reason or "no known package defines it: open its package"
        raise UnknownTypeError(
            error.name, f"{reason}, give --interfaces, or see its bytes with --raw"
        ) from None
    print(f"WARNING: {error} Its bytes come as they are.", file=sys.stderr)
    return ends[0]


def _class_of(own: OwnNode, type_name: str, ends: list[GraphEndpoint]) -> type[MessageValue]:
    """Return the class of a type; one that is not known is learned from nodes that use it.

    Raises:
        UnknownTypeError: It is not known, and no node describes it.
    """
    try:
        return own.types.message(type_name)
    except UnknownTypeError:
        learn_type(own, ends)
        return own.types.message(type_name)


def _only(name: str, types: list[str]) -> str | None:
    if len(types) == 1:
        return types[0]
    if types:
        text = f"Cannot tell the type of topic '{name}', it has several: {', '.join(types)}"
    else:
        text = "Could not determine the type for the passed topic"
    print(text, file=sys.stderr)
    return None


def subscribe(
    own: OwnNode, joined: Joined, callback: Callable[..., object], *, raw: bool = False
) -> Subscription:
    """Subscribe to a topic; `callback` takes a message, or its bytes where `raw`."""
    if joined.form is not None:
        return _subscribe_as(own.node, joined.form, joined.kind, callback, joined.qos, raw=raw)
    if joined.kind is None:
        raise UnknownTypeError(joined.name)
    return own.node.create_subscription(joined.kind, joined.name, callback, joined.qos, raw=raw)


def _subscribe_as(
    node: Node,
    other: GraphEndpoint,
    kind: type[MessageValue] | None,
    callback: Callable[..., object],
    qos: QoSProfile,
    *,
    raw: bool,
) -> Subscription:
    """Subscribe in the form that another's token names; without a class, to the bytes."""
    from studio.ros.node.base import Endpoint
    from studio.ros.node.subscription import Subscription
    from studio.ros.profiles import NO_HASH
    from studio.ros.tokens import EndpointKind, EndpointToken
    from studio.ros.types.classes import make_class
    from studio.ros.types.definitions import Message

    token = EndpointToken(
        node.token,
        node.wire.next_id(),
        EndpointKind.SUBSCRIPTION,
        other.name,
        other.type_name,
        other.type_hash or NO_HASH,
        qos,
    )
    endpoint = Endpoint(node.wire, token, lambda: node.graph)
    raw = raw or kind is None
    kind = kind or make_class(Message(other.type_name), _no_part)
    subscription = Subscription(endpoint, kind, callback, node.default_callback_group, raw=raw)
    node.add_work(subscription)
    return subscription


def _no_part(name: str) -> type[MessageValue]:
    raise KeyError(name)


def _described_form(
    own: OwnNode, ends: Sequence[GraphEndpoint]
) -> tuple[type[MessageValue], GraphEndpoint] | None:
    """Return the class of a type as one of its users has it, if none has it as we do.

    None if one does, if the form is only another distribution's, which is chosen by name, and
    if no node describes it. The types that are known stay as they are.
    """
    if not ends or not _is_nobodys(own, ends):
        return None
    for end in ends:
        try:
            kind = _class_as_described(own, end)
        except StudioError:
            continue
        print(
            f"WARNING: {end.node.path} has another form of {end.type_name}, which is shown",
            file=sys.stderr,
        )
        return kind, end
    return None


def _is_nobodys(own: OwnNode, ends: Sequence[GraphEndpoint]) -> bool:
    """Whether no end has our form of a type, nor one that a distribution is known to have."""
    from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes
    from studio.ros.profiles import NO_HASH

    wire = own.node.wire
    if not wire.profile.has_type_hash or any(end.type_hash in {NO_HASH, ""} for end in ends):
        return False  # Humble, here or there, where tokens hold no hash
    ours = wire.profile.type_hash(wire.types.hash_of(ends[0].type_name))
    if any(end.type_hash == ours for end in ends):
        return False
    found = foreign_hashes(ends, wire.profile, DistroHashes(wire.types))
    return all(not one.distros for one in found)


def _class_as_described(own: OwnNode, end: GraphEndpoint) -> type[MessageValue]:
    """Ask the node of an endpoint to describe its type; the hash proves the answer.

    Raises:
        StudioError: It does not answer, or its answer has another hash.
    """
    from studio.ros.node.spinning import call_service
    from studio.ros.types.type_descriptions import (
        DESCRIPTION_SERVICE,
        DESCRIPTION_SERVICE_TYPE,
        read_description,
    )

    service = f"{end.node.path}/{DESCRIPTION_SERVICE}"
    if not own.graph.has_server(service):  # asking would wait for it
        raise NotServedError("service", service)
    client = own.node.create_client(own.types.service(DESCRIPTION_SERVICE_TYPE), service)
    try:
        request = client.srv_type.Request(type_name=end.type_name, type_hash=end.type_hash)
        response = call_service(own.node, client, request)
    finally:
        own.node.destroy_client(client)
    return _made(read_description(response.type_description, end.type_name, end.type_hash), end)


def _made(parts: Mapping[str, Message], end: GraphEndpoint) -> type[MessageValue]:
    from studio.ros.types.classes import make_class

    @cache
    def make(name: str) -> type[MessageValue]:
        return make_class(parts[name], make)

    return make(end.type_name)
