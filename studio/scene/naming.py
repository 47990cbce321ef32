"""Names of nodes, each part percent-encoded: links flat under `/robot` and `/ghost`, displays."""

from __future__ import annotations

from functools import lru_cache
from urllib.parse import quote

ROBOT = "/robot"
GRID = "/grid"
GHOST = "/ghost"
LIVE = "/live"
_KEPT = "!*'()"  # what encodeURIComponent of the page leaves as it is, beside quote's own


def link_node(link: str) -> str:
    """The node that carries the pose of a link."""
    return f"{ROBOT}/{_quoted(link)}"


def ghost_node(link: str) -> str:
    """The node that carries the pose of a link of the ghost."""
    return f"{GHOST}/{_quoted(link)}"


def live_node(display_id: str, *parts: str) -> str:
    """The root of a display, or below it the group of a path, or below that one node of a shape."""
    # An empty name would stand for the node above it.
    return "/".join((LIVE, *(_quoted(part) or "%" for part in (display_id, *parts))))


@lru_cache(maxsize=1 << 14)
def _quoted(part: str) -> str:
    return quote(part, safe=_KEPT)
