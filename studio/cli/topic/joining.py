"""Subscribing to a topic by its name: its type and quality of service are those that are there."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.cli.learning import learn_type, say_foreign
from studio.cli.looking import full_name
from studio.cli.topic.qos_options import given_profile, is_given, matching_profile
from studio.errors import UnknownTypeError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from studio.cli.acting import Actor
    from studio.ros.node.subscription import Subscription
    from studio.ros.qos import QoSProfile
    from studio.ros.types.classes import MessageValue


@dataclass(frozen=True, slots=True)
class Joined:
    """What a verb listens to."""

    name: str
    kind: type[MessageValue]
    qos: QoSProfile


def join_topic(actor: Actor, options: argparse.Namespace, given_type: str | None) -> Joined | None:
    """Find out how to listen to a topic; None, after words on stderr, where that is not known.

    Raises:
        UnknownTypeError: No such type is known, and nobody describes it.
    """
    name = full_name(options.topic_name)
    types = dict(actor.graph.topics()).get(name, [])
    if not types:
        print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
    type_name = full_type_name(given_type) if given_type is not None else _only(name, types)
    if type_name is None:
        return None
    publishers = actor.graph.publishers(name)
    qos = matching_profile([one.qos for one in publishers])
    if is_given(options):
        qos = given_profile(options, qos)
    kind = _class_of(actor, name, type_name)
    say_foreign(actor, [one for one in publishers if one.type_name == type_name])
    return Joined(name, kind, qos)


def _class_of(actor: Actor, name: str, type_name: str) -> type[MessageValue]:
    """Find the type among those that are known, else ask a node that uses it what it is.

    Raises:
        UnknownTypeError: It is not known, and nobody could say.
    """
    try:
        return actor.types.message(type_name)
    except UnknownTypeError:
        learn_type(actor, [*actor.graph.publishers(name), *actor.graph.subscriptions(name)])
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
    return actor.node.create_subscription(joined.kind, joined.name, callback, joined.qos, raw=raw)
