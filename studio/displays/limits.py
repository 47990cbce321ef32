"""Limits: how much a display may show, so that the view stays quick; given from outside."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limits:
    """At most so much of one display.

    Attributes:
        points: Of a cloud, with those of before that have not decayed.
        messages: Of before that have not decayed.
        kept_bytes: Of their messages.
        cells: Of a map.
        pixels: Of a camera's picture.
    """

    points: int = 300_000
    messages: int = 200
    kept_bytes: int = 256 << 20
    cells: int = 16_000_000
    pixels: int = 400_000
