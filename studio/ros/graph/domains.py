"""Domains: how many nodes each ROS_DOMAIN_ID at a router has, whichever is one's own."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from studio.errors import TokenError
from studio.ros.tokens import ADMIN_SPACE, NodeToken, parse_token
from studio.ros.wire.zenoh import standing_tokens

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.ros.wire.session import WireSession

LOOK_TIMEOUT_S = 3.0


def nodes_by_domain(wire: WireSession, timeout_s: float = LOOK_TIMEOUT_S) -> dict[int, int]:
    """Ask the router for the nodes of every domain, once; lasts `timeout_s` at most."""
    return count_nodes(standing_tokens(wire.zenoh, f"{ADMIN_SPACE}/*/**", timeout_s))


def count_nodes(tokens: Iterable[str]) -> dict[int, int]:
    """Count the nodes of each domain, in the order of their numbers; a token counts once."""
    nodes = (node for token in set(tokens) if (node := _node(token)) is not None)
    return dict(sorted(Counter(node.domain for node in nodes).items()))


def _node(token: str) -> NodeToken | None:
    try:
        parsed = parse_token(token)
    except TokenError:
        return None
    return parsed if isinstance(parsed, NodeToken) else None
