"""Names of nodes: links flat under `/robot` and `/ghost`, each percent-encoded."""

from __future__ import annotations

from urllib.parse import quote

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
