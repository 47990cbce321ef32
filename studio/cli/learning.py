"""Types that only other nodes know, asked of one of them."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.cli.acting import Actor
    from studio.ros.graph.endpoints import GraphEndpoint


def learn_type(actor: Actor, endpoints: Iterable[GraphEndpoint]) -> None:
    """Ask the nodes of endpoints in turn until one says what its type is made of.

    Why one did not is said on stderr; whether the type is known is seen by who needs it.
    """
    from studio.ros.remote.type_asking import learn_from

    for endpoint in endpoints:
        try:
            learn_from(actor.node, endpoint)
        except StudioError as error:
            print(f"{endpoint.node.path}: {error}", file=sys.stderr)
        else:
            return
