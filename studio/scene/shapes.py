"""Shapes of a Drawing as nodes: each becomes one, or a few with names of their own."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from viser import _messages

from studio.displays.drawing import (
    BODIES_MAX,
    Arrows,
    Axes,
    CameraView,
    Frustum,
    GridLines,
    Lines,
    LinkParts,
    MeshFile,
    Picture,
    Points,
    Shape,
    Solids,
    Text,
    Triangles,
)
from studio.errors import SceneError
from studio.scene import node
from studio.scene.link_nodes import MISSING_SIZE_M, MISSING_STYLE, MeshShelf, link_nodes
from studio.scene.node import Node, Style
from studio.scene.pictures import EncodedShelf, camera_of, frustum_of, tiles_of
from studio.scene.solids import arrows_of, linear, many_of
from studio.scene.surfaces import surface_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MANY_MAX: Final = 200_000
_POINTS_MAX: Final = 5_000_000
_PIXELS_MAX: Final = 1 << 26
_TEXT_MAX: Final = 500
_HAIR_PX: Final = 1.8
_THICKNESS: Final = {"boxes": 1.0, "tiles": 0.001}
"""Height of points that are solids, as a share of their edge."""
_CAP_SHARE: Final = 0.72
"""Height of a capital letter, as a share of the font's size."""
_WHITE: Final = (255, 255, 255)
_DEFAULT_STYLE: Final = Style((196, 200, 206), shadow=False)


@dataclass(frozen=True, slots=True)
class Shelves:
    """Loaded meshes and encoded pictures, by which shapes become nodes."""

    meshes: MeshShelf = field(default_factory=MeshShelf)
    encoded: EncodedShelf = field(default_factory=EncodedShelf)


def nodes_of(shape: Shape, stream: str, shelves: Shelves) -> dict[str, Node]:
    """Return the nodes of one shape by a name for each; none when there is nothing to see.

    Args:
        shape: What to draw.
        stream: Another one whenever an array of the shape is another.
        shelves: Where meshes come from, and where encoded pictures are kept.

    Raises:
        SceneError: It is more than a browser can draw.
    """
    _check_size(shape)
    match shape:
        case MeshFile() | LinkParts():
            return _of_meshes(shape, shelves.meshes)
        case Text():
            return _text(shape)
        case Picture():
            return tiles_of(shape, shelves.encoded)
        case Frustum() | CameraView():
            is_view = isinstance(shape, CameraView)
            made = camera_of(shape, stream) if is_view else frustum_of(shape, stream)
            return {"camera" if is_view else "frustum": made}
        case GridLines():
            return _grid(shape)
        case _:
            return _batch(shape, stream)


def _batch(
    shape: Points | Lines | Arrows | Axes | Solids | Triangles, stream: str
) -> dict[str, Node]:
    match shape:
        case Points():
            return _points(shape, stream)
        case Lines():
            return _lines(shape.ends, shape.colors, shape.width_m, shape.opacity, stream)
        case Arrows():
            return arrows_of(shape, stream)
        case Axes():
            return _axes(shape, stream)
        case Solids():
            return many_of(shape, stream)
        case Triangles():
            return surface_of(shape, stream)


def mesh_uris_of(shape: Shape) -> frozenset[str]:
    """Return the URIs of the meshes that a shape draws."""
    match shape:
        case MeshFile():
            return frozenset({shape.uri})
        case LinkParts():
            return shape.mesh_uris()
        case _:
            return frozenset()


def same_arrays(one: Shape | None, other: Shape) -> bool:
    """Whether two shapes differ in small values only, so that no array need be sent again."""
    if type(one) is not type(other):
        return False
    pairs = ((getattr(one, part.name), getattr(other, part.name)) for part in fields(other))
    return all(a is b for a, b in pairs if isinstance(a, np.ndarray) or isinstance(b, np.ndarray))


def _check_size(shape: Shape) -> None:
    match shape:
        case Points():
            count, most, what = len(shape.positions), _POINTS_MAX, "points"
        case Lines() | Arrows():
            count, most, what = len(shape.ends), _POINTS_MAX, "lines or arrows"
        case Axes() | Solids():
            count, most, what = len(shape.positions), _MANY_MAX, "solids or axes"
        case Triangles():
            count, most, what = len(shape.faces), _POINTS_MAX, "triangles"
        case Picture():
            rows, columns = shape.pixels.shape[:2]
            count, most, what = rows * columns, _PIXELS_MAX, "pixels"
        case _:
            return
    if count > most:
        raise SceneError(
            f"One shape has {count} {what}, and the 3D view draws {most} of them at most: "
            "let the publisher send fewer."
        )


def _points(shape: Points, stream: str) -> dict[str, Node]:
    if len(shape.positions) == 0:
        return {}
    if shape.style in _THICKNESS and len(shape.positions) <= BODIES_MAX:
        return many_of(_as_bodies(shape), stream)
    props: dict[str, Any] = {
        # viser draws a point of size 1 two metres wide.
        "point_size": shape.size_m / 2,
        "point_shape": "circle" if shape.style == "spheres" else "square",
        "point_shading": "gradient" if shape.style in {"spheres", "squares"} else "flat",
        "studio_point_px": shape.size_px,
        "studio_size_by_z": shape.size_by_z,
        "precision": "float32" if shape.precise else "float16",
        "scale": 1.0,
        "studio_opacity": shape.opacity,
    }
    arrays: dict[str, NDArray[Any]] = {
        "points": _positions(shape.positions, precise=shape.precise),
        "colors": np.ascontiguousarray(shape.colors, np.uint8),
    }
    name = f"{stream}/{props['precision']}"
    return {"points": Node(_messages.PointCloudMessage, props, stream=name, flowing=arrays)}


def _positions(positions: NDArray[np.float32], *, precise: bool) -> NDArray[Any]:
    if precise:
        return np.ascontiguousarray(positions, np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        return positions.astype(np.float16, order="C")


def _as_bodies(shape: Points) -> Solids:
    count = len(shape.positions)
    upright = np.zeros((count, 4), np.float32)
    upright[:, 0] = 1
    sizes = np.full((count, 3), shape.size_m, np.float32)
    if shape.size_by_z:
        sizes *= np.abs(shape.positions[:, 2:3])
    sizes[:, 2] *= _THICKNESS[shape.style]
    return Solids("box", shape.positions, upright, sizes, shape.colors, shape.opacity)


def _lines(
    ends: NDArray[np.float32],
    colors: NDArray[np.uint8],
    width_m: float,
    opacity: float,
    stream: str,
) -> dict[str, Node]:
    # One end that is nowhere, and the page does not know how far the lines reach.
    known = np.isfinite(ends).all(axis=(1, 2))
    if not known.all():
        ends, colors = ends[known], colors if colors.ndim == 1 else colors[known]
    if len(ends) == 0:
        return {}
    props: dict[str, Any] = {
        "thickness": width_m if width_m > 0 else _HAIR_PX,
        "thickness_units": "world" if width_m > 0 else "screen",
        "scale": 1.0,
        "studio_opacity": opacity,
    }
    arrays: dict[str, NDArray[Any]] = {
        "points": np.ascontiguousarray(ends, np.float32),
        # viser takes one colour as it is shown, and those of each end as amounts of light.
        "colors": np.ascontiguousarray(colors if colors.ndim == 1 else linear(colors), np.uint8),
    }
    return {"lines": Node(_messages.LineSegmentsMessage, props, stream=stream, flowing=arrays)}


def _axes(shape: Axes, stream: str) -> dict[str, Node]:
    if len(shape.positions) == 0:
        return {}
    props: dict[str, Any] = {
        "batched_scales": None,
        "axes_length": shape.length_m,
        "axes_radius": shape.radius_m,
        "scale": 1.0,
        "studio_opacity": shape.opacity,
    }
    arrays: dict[str, NDArray[Any]] = {
        "batched_wxyzs": np.ascontiguousarray(shape.wxyz, np.float32),
        "batched_positions": np.ascontiguousarray(shape.positions, np.float32),
    }
    # viser's page forgets the places when only the sizes change: they are sent with them.
    name = f"{stream}/{shape.length_m}/{shape.radius_m}"
    return {"axes": Node(_messages.BatchedAxesMessage, props, stream=name, flowing=arrays)}


def _of_meshes(shape: MeshFile | LinkParts, shelf: MeshShelf) -> dict[str, Node]:
    return _mesh(shape, shelf) if isinstance(shape, MeshFile) else link_nodes(shape, shelf)


def _mesh(shape: MeshFile, shelf: MeshShelf) -> dict[str, Node]:
    if shape.uri not in shelf:
        return {}
    loaded = shelf.get(shape.uri)
    if loaded is None:
        return {"mesh": node.box(MISSING_SIZE_M, MISSING_STYLE, shape.wxyz, shape.position)}
    if loaded.glb and shape.rgb is None:
        made = node.colored_mesh(loaded, shape.scale, shape.wxyz, shape.position)
        made.props["studio_opacity"] = shape.opacity
        return {"mesh": made}
    style = Style(shape.rgb or _DEFAULT_STYLE.rgb, shape.opacity, shadow=False)
    return {"mesh": node.mesh(loaded, shape.scale, style, shape.wxyz, shape.position)}


def _text(shape: Text) -> dict[str, Node]:
    text = shape.text[:_TEXT_MAX]
    if not text.strip():
        return {}
    on_screen = shape.height_m <= 0
    # Names of frames, which are many, are written by viser: black on white plates, in one go.
    plain = on_screen and shape.rgb == _WHITE and shape.opacity >= 1
    props: dict[str, Any] = {
        "text": text,
        "font_size_mode": "screen" if on_screen else "scene",
        "font_screen_scale": 0.85,
        "font_scene_height": shape.height_m / _CAP_SHARE,
        "depth_test": not on_screen,
        "anchor": "bottom-center" if on_screen else "center-center",
        "studio_opacity": shape.opacity,
        "studio_rgb": None if plain else shape.rgb,
    }
    # Written in colour or plainly, it is another thing in the page.
    return {
        "plain" if plain else "text": Node(_messages.LabelMessage, props, position=shape.position)
    }


def _grid(shape: GridLines) -> dict[str, Node]:
    cells = min(max(shape.cells, 1), 2000)
    half_m = cells * shape.cell_m / 2
    at_m = np.linspace(-half_m, half_m, cells + 1, dtype=np.float32)
    first, second = ("xyz".index(axis) for axis in shape.plane)
    ends = np.zeros((2, cells + 1, 2, 3), np.float32)
    ends[0, :, :, first] = at_m[:, None]
    ends[0, :, :, second] = (-half_m, half_m)
    ends[1, :, :, second] = at_m[:, None]
    ends[1, :, :, first] = (-half_m, half_m)
    ends += np.asarray(shape.position, np.float32)
    colors = np.array(shape.rgb, np.uint8)
    # Its arrays follow from these, so they are sent when one of them changes.
    stream = f"{shape.plane}/{cells}/{shape.cell_m}/{shape.position}/{shape.rgb}"
    return _lines(ends.reshape(-1, 2, 3), colors, shape.width_m, shape.opacity, stream)
