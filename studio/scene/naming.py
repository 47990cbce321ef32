"""Names of nodes: links flat under `/robot` and `/ghost`, each percent-encoded."""

from __future__ import annotations

from urllib.parse import quote, unquote

ROBOT = "/robot"
GRID = "/grid"
GHOST = "/ghost"
_KEPT = "!*'()"  # what encodeURIComponent of the page leaves as it is, beside quote's own


def link_node(link: str) -> str:
    """The node that carries the pose of a link."""
    return f"{ROBOT}/{quote(link, safe=_KEPT)}"


def ghost_node(link: str) -> str:
    """The node that carries the pose of a link of the ghost."""
    return f"{GHOST}/{quote(link, safe=_KEPT)}"


def link_of(node: str) -> str | None:
    """The link that a node of the robot belongs to, or None."""
    parts = node.split("/", 3)
    return unquote(parts[2]) if len(parts) > 2 and parts[1] == ROBOT[1:] else None
