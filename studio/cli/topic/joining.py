"""Subscribing to a topic by its name: its type and quality of service are those that are there."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.cli.learning import learn_type, say_foreign
from studio.cli.looking import full_name, say_other_types
from studio.cli.other_forms import told_form
from studio.cli.topic.qos_options import listening_profile
from studio.errors import UnknownTypeError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from studio.cli.acting import Actor
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.subscription import Subscription
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue


@dataclass(frozen=True, slots=True)
class Joined:
    """What a verb listens to.

    Attributes:
        kind: The class of its messages; None where only the bytes are known.
        form: Who has the type in a form of its own, in which it is listened to.
    """

    name: str
    kind: type[MessageValue] | None
    qos: QoSProfile
    form: GraphEndpoint | None = None


def join_topic(
    actor: Actor, options: argparse.Namespace, topic: str, given_type: str | None, *, raw: bool
) -> Joined | None:
    """Find out how to listen to a topic; None, after words on stderr, where that is not known.

    Where bytes are enough (`raw`), a type that nobody knows is said and taken as it comes.

    Raises:
        UnknownTypeError: No such type is known, and nobody describes it.
    """
    name = full_name(topic)
    types = dict(actor.graph.topics()).get(name, [])
    if not types:
        print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
    type_name = full_type_name(given_type) if given_type is not None else _only(name, types)
    if type_name is None:
        return None
    say_other_types(name, type_name, [(name, types)])
    publishers = actor.graph.publishers(name)
    qos = listening_profile(options, [one.qos for one in publishers])
    kind, form = _form_of(actor, name, type_name, raw=raw)
    return Joined(name, kind, qos, form)


def _form_of(
    actor: Actor, name: str, type_name: str, *, raw: bool
) -> tuple[type[MessageValue] | None, GraphEndpoint | None]:
    """Give the class of a type, and who has it in the form that is meant if that is not ours.

    Raises:
        UnknownTypeError: It is not known, and its bytes are not enough.
    """
    publishers = [one for one in actor.graph.publishers(name) if one.type_name == type_name]
    others = [one for one in actor.graph.subscriptions(name) if one.type_name == type_name]
    try:
        kind = _class_of(actor, type_name, [*publishers, *others])
    except UnknownTypeError as error:
        return None, _unread(error, [*publishers, *others], raw=raw)
    told = told_form(actor, publishers)
    if told is None:
        say_foreign(actor, publishers)
    return told or (kind, None)


def _unread(error: UnknownTypeError, ends: list[GraphEndpoint], *, raw: bool) -> GraphEndpoint:
    """Give one who has a type that nobody knows, and say so.

    Raises:
        UnknownTypeError: Nobody has it, or its bytes are not enough.
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


def _class_of(actor: Actor, type_name: str, ends: list[GraphEndpoint]) -> type[MessageValue]:
    """Find the type among those that are known, else ask the nodes that use it what it is.

    Raises:
        UnknownTypeError: It is not known, and nobody could say.
    """
    try:
        return actor.types.message(type_name)
    except UnknownTypeError:
        learn_type(actor, ends)
        return actor.types.message(type_name)


def _only(name: str, types: list[str]) -> str | None:
    if len(types) == 1:
        return types[0]
    if types:
        said = f"Cannot tell the type of topic '{name}', it has several: {', '.join(types)}"
    else:
        said = "Could not determine the type for the passed topic"
    print(said, file=sys.stderr)
    return None


def subscribe(
    actor: Actor, joined: Joined, callback: Callable[..., object], *, raw: bool = False
) -> Subscription:
    """Listen to a topic."""
    if joined.form is not None:
        from studio.cli.topic.listening import listen_as

        return listen_as(actor.node, joined.form, joined.kind, callback, joined.qos, raw=raw)
    if joined.kind is None:
        raise UnknownTypeError(joined.name)
    return actor.node.create_subscription(joined.kind, joined.name, callback, joined.qos, raw=raw)
