"""MarkerArray: many markers in one message."""

from __future__ import annotations

from typing import ClassVar

from studio.displays.display import TopicRole
from studio.displays.markers.markers_display import MARKER_ARRAY, MarkersDisplay


class MarkerArrayDisplay(MarkersDisplay):
    """Arrays of markers; each changes, adds or deletes those that it names, and no others."""

    KIND = "MarkerArray"
    DOC = "Shows many markers at once: arrows, solids, lines, points, surfaces, texts and meshes."
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", (MARKER_ARRAY,), newest_only=False, latched=True, depth=10),
    )
