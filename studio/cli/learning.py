"""Types as other nodes have them: asked of them where unknown, and told where they differ."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.cli.acting import Actor
    from studio.ros.graph.endpoints import GraphEndpoint


def learn_type(actor: Actor, endpoints: Iterable[GraphEndpoint]) -> None:
    """Ask the nodes of endpoints in turn until one says what its type is made of.

    Why one did not is said on stderr; whether the type is known is seen by who needs it.
    """
    from studio.ros.type_lookup import learn_from_any

    learn_from_any(actor.node, endpoints, say_aside)


def say_aside(sentence: str) -> None:
    """Say something on stderr."""
    print(sentence, file=sys.stderr)


def say_foreign(actor: Actor, endpoints: Sequence[GraphEndpoint]) -> None:
    """Say on stderr that others have another form of a type: they are not heard then."""
    from studio.ros.graph.diagnosis import DistroHashes, foreign_hashes, why_not_heard

    wire = actor.node.wire
    for found in foreign_hashes(endpoints, wire.profile, DistroHashes(wire.types)):
        print(f"WARNING: {why_not_heard(found, wire.profile)}", file=sys.stderr)
