"""Marker: shapes, texts and meshes that programs show of what they think."""

from __future__ import annotations

from typing import ClassVar

from studio.displays.display import TopicRole
from studio.displays.markers.markers_display import MARKER, MARKER_ARRAY, MarkersDisplay


class MarkerDisplay(MarkersDisplay):
    """Single markers, and arrays of them on the topic that ends in `_array`, as in RViz."""

    KIND = "Marker"
    DOC = "Shows single markers: arrows, solids, lines, points, surfaces, texts and meshes."
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", (MARKER,), newest_only=False, latched=True, depth=1000),
        TopicRole("array", (MARKER_ARRAY,), "_array", newest_only=False, latched=True, depth=10),
    )
