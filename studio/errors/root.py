"""The root of the tree of errors."""

from __future__ import annotations


class StudioError(Exception):
    """Anything that the studio can say in one sentence; the root of the tree."""
