"""A Node: one thing in the 3D view in viser's terms, and functions that make those we draw.

viser's page ignores properties that it does not know; `frontend_assets/viser/live.js` reads those
that begin with `studio_`.
"""

# The property classes of viser's messages are met here and in graph.py only.
# pyright: reportPrivateUsage=false

# viser's messages are met in this room's node.py, graph.py, shapes and here.

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from viser import _messages

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import Vector3

Quaternion: TypeAlias = tuple[float, float, float, float]
"""w, x, y, z; unit length."""
Rgb: TypeAlias = tuple[int, int, int]
"""sRGB, 0 to 255."""

NO_TURN: Quaternion = (1.0, 0.0, 0.0, 0.0)
ORIGIN: Vector3 = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Style:
    """Colour and opacity (1: opaque) of a surface."""

    rgb: Rgb
    opacity: float = 1.0
    wireframe: bool = False
    shadow: bool = True


@dataclass(frozen=True, slots=True)
class Node:
    """A node of the scene; if it equals the one before, nothing needs to be sent.

    `content` is the digest of its arrays: when it changes, the node is made again, while the small
    properties in `props` are updated in place. `stream` names the arrays in `flowing`, which are
    updated in place, too: those of a sensor, which change all the time.
    """

    kind: type[_messages._CreateSceneNodeMessage]
    props: dict[str, Any]
    wxyz: Quaternion = NO_TURN
    position: Vector3 = ORIGIN
    visible: bool = True
    content: str = ""
    arrays: dict[str, NDArray[Any]] = field(
        default_factory=dict[str, "NDArray[Any]"], compare=False
    )
    stream: str = ""
    flowing: dict[str, NDArray[Any]] = field(
        default_factory=dict[str, "NDArray[Any]"], compare=False
    )


def surface(style: Style) -> dict[str, Any]:
    """Properties that all of viser's meshes have."""
    return {
        "color": style.rgb,
        "opacity": None if style.opacity >= 1.0 else style.opacity,
        "wireframe": style.wireframe,
        "flat_shading": False,
        "side": "front",
        "material": "standard",
        "cast_shadow": style.shadow,
        "receive_shadow": style.shadow,
        "scale": 1.0,
    }


def group(wxyz: Quaternion = NO_TURN, position: Vector3 = ORIGIN, *, visible: bool = True) -> Node:
    """Return a frame that is not drawn itself."""
    return _frame(0.0, wxyz, position, visible=visible)


def axes(length_m: float, *, visible: bool = True) -> Node:
    """Red, green and blue arrows along x, y and z."""
    return _frame(length_m, NO_TURN, ORIGIN, visible=visible)


def _frame(length_m: float, wxyz: Quaternion, position: Vector3, *, visible: bool) -> Node:
    props = {
        "show_axes": length_m > 0,
        "axes_length": length_m,
        "axes_radius": length_m / 30,
        "origin_radius": length_m / 18,
        "origin_color": (236, 236, 236),
        "scale": 1.0,
    }
    return Node(_messages.FrameMessage, props, wxyz, position, visible)


def box(size_m: Vector3, style: Style, wxyz: Quaternion = NO_TURN, at: Vector3 = ORIGIN) -> Node:
    """Return a box centred on its pose."""
    return Node(_messages.BoxMessage, {**surface(style), "dimensions": size_m}, wxyz, at)


def cylinder(radius_m: float, length_m: float, style: Style, wxyz: Quaternion, at: Vector3) -> Node:
    """Return a cylinder along z, centred on its pose."""
    size = {"radius": radius_m, "height": length_m, "radial_segments": 48}
    return Node(_messages.CylinderMessage, {**surface(style), **size}, wxyz, at)


def sphere(radius_m: float, style: Style, wxyz: Quaternion, at: Vector3) -> Node:
    """Return a ball."""
    size = {"radius": radius_m, "subdivisions": 3}
    return Node(_messages.IcosphereMessage, {**surface(style), **size}, wxyz, at)


def mesh(loaded: LoadedMesh, scale: Vector3, style: Style, wxyz: Quaternion, at: Vector3) -> Node:
    """Triangles in one colour, whatever colours the file has."""
    props = {**surface(style), "side": "double", "scale": scale}
    arrays: dict[str, NDArray[Any]] = {"vertices": loaded.vertices, "faces": loaded.faces}
    return Node(_messages.MeshMessage, props, wxyz, at, content=loaded.digest, arrays=arrays)


def colored_mesh(loaded: LoadedMesh, scale: Vector3, wxyz: Quaternion, at: Vector3) -> Node:
    """Return a mesh with the materials of its own file."""
    props = {"scale": scale, "cast_shadow": True, "receive_shadow": True}
    # As an array the GLB travels beside the compressed part of the frame, as it is.
    arrays: dict[str, NDArray[Any]] = {"glb_data": np.frombuffer(loaded.glb, np.uint8)}
    return Node(_messages.GlbMessage, props, wxyz, at, content=loaded.digest, arrays=arrays)


def label(text: str, *, visible: bool = True) -> Node:
    """Text of constant size on the screen."""
    props = {
        "text": text,
        "font_size_mode": "screen",
        "font_screen_scale": 0.85,
        "font_scene_height": 0.05,
        "depth_test": False,
        "anchor": "bottom-center",
    }
    return Node(_messages.LabelMessage, props, visible=visible)


def arrow(tail: Vector3, tip: Vector3, rgb: Rgb, *, visible: bool = True) -> Node:
    """Return an arrow as thick as becomes its length."""
    points = np.array([[tail, tip]], dtype=np.float32)
    length = float(np.linalg.norm(points[0, 1] - points[0, 0]))
    props = {
        "shaft_radius": length / 40,
        "head_radius": length / 14,
        "head_length": length / 5,
        "scale": 1.0,
    }
    arrays: dict[str, NDArray[Any]] = {"points": points, "colors": np.array([rgb], dtype=np.uint8)}
    content = f"{tail}{tip}{rgb}"
    return Node(_messages.ArrowMessage, props, visible=visible, content=content, arrays=arrays)


def grid(cell_m: float, extent_m: float, height_m: float, *, shadow: bool, visible: bool) -> Node:
    """Squares with a stronger line every four; the page gives it its colours."""
    props = {
        "width": extent_m or 10.0,  # an endless grid is this times the fade distance
        "height": extent_m or 10.0,
        "plane": "xy",
        "cell_color": (120, 130, 145),
        "cell_thickness": 0.8,
        "cell_size": cell_m,
        "section_color": (120, 130, 145),
        "section_thickness": 1.2,
        "section_size": 4 * cell_m,
        "infinite_grid": extent_m <= 0,
        "fade_distance": 100.0,
        "fade_strength": 1.0,
        "fade_from": "camera",
        "shadow_opacity": 0.3 if shadow else 0.0,
        "plane_color": (255, 255, 255),
        "plane_opacity": 0.0,
        "scale": 1.0,
    }
    at = (0.0, 0.0, height_m)
    return Node(_messages.GridMessage, props, position=at, visible=visible)


@dataclass
class PointCloudProps(_messages.PointCloudProps):
    """Points, see-through or of a size in pixels (if not 0), or larger the larger their z is."""

    studio_opacity: float = 1.0
    studio_point_px: float = 0.0
    studio_size_by_z: bool = False


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
    """A frustum whose picture may be see-through; or the view of a camera, of a page's own."""

    studio_opacity: float = 1.0
    studio_camera: dict[str, Any] | None = None


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
