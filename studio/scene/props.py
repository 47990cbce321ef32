"""Properties of viser's nodes, and beside them what only our own page's script knows to draw.

viser's page ignores what it does not know; `frontend_assets/viser/live.js` reads the fields that
begin with `studio_` and finishes what viser made.
"""

# viser's messages are met in this room's node.py, graph.py, shapes and here.
from __future__ import annotations

from dataclasses import dataclass

from viser import _messages


@dataclass
class PointCloudProps(_messages.PointCloudProps):
    """Points that may be see-through, and of one size on the screen: in pixels, if not 0."""

    studio_opacity: float = 1.0
    studio_point_px: float = 0.0


@dataclass
class LineSegmentsProps(_messages.LineSegmentsProps):
    """Lines that may be see-through."""

    studio_opacity: float = 1.0


@dataclass
class ArrowProps(_messages.ArrowProps):
    """Arrows that may be see-through."""

    studio_opacity: float = 1.0


@dataclass
class BatchedAxesProps(_messages.BatchedAxesProps):
    """Axes that may be see-through."""

    studio_opacity: float = 1.0


@dataclass
class GlbProps(_messages.GlbProps):
    """A mesh in its own colours that may be see-through."""

    studio_opacity: float = 1.0


@dataclass
class CameraFrustumProps(_messages.CameraFrustumProps):
    """A frustum whose picture may be see-through."""

    studio_opacity: float = 1.0


@dataclass
class ImageProps(_messages.ImageProps):
    """A picture with sharp pixels, drawn before all else if it is `behind`."""

    studio_opacity: float = 1.0
    studio_sharp: bool = False
    studio_behind: bool = False


@dataclass
class LabelProps(_messages.LabelProps):
    """Words in a colour, 0 to 255; None: black on a white plate, as viser writes them."""

    studio_opacity: float = 1.0
    studio_rgb: tuple[int, int, int] | None = None
