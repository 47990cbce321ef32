"""Lines, points and triangles of markers, all of a batch together; texts and meshes one by one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.displays.drawing import Lines, MeshFile, Points, Text, Triangles
from studio.displays.markers.items import (
    alphas_of,
    colors_of,
    item_colors,
    parts_of,
    placed_items,
    rgb_of,
)
from studio.displays.markers.kinds import Kind
from studio.displays.markers.solids import is_seen_in_half

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from studio.displays.drawing import Rgb, Shape, Xyz
    from studio.displays.markers.items import PlacedItems
    from studio.displays.markers.kinds import Whole
    from studio.displays.markers.table import Rows

_OPAQUE: Final = 0.9998
"""Below this opacity RViz blends."""


def points_of(markers: Rows) -> dict[str, Shape]:
    """Squares that face the camera, as wide as scale.x."""
    dots = _with_items(markers.of_types(Kind.POINTS))
    if not len(dots.rows):
        return {}
    items = placed_items(dots)
    rgba = item_colors(dots, items)
    widths_m = np.abs(dots.scales[:, 0])[items.owners]
    shapes: dict[str, Shape] = {}
    for number, part in enumerate(parts_of(alphas_of(rgba), widths_m)):
        positions = items.positions[part.chosen]
        shapes[f"points-{number}"] = Points(
            positions.astype(np.float32), rgb_of(rgba[part.chosen]), part.size_m, "squares",
            part.opacity, is_seen_in_half(positions, part.size_m),
            items=dots.rows[items.owners[part.chosen]],
        )  # fmt: skip
    return shapes


def lines_of(markers: Rows) -> dict[str, Shape]:
    """Strips and lists of lines, as thick as scale.x."""
    drawn = _with_items(markers.of_types(Kind.LINE_STRIP, Kind.LINE_LIST))
    if not len(drawn.rows):
        return {}
    items = placed_items(drawn)
    rgba = item_colors(drawn, items)
    begins = _beginnings(drawn, items)
    ends = np.stack((items.positions[begins], items.positions[begins + 1]), axis=1)
    colors = np.stack((rgba[begins], rgba[begins + 1]), axis=1)
    widths_m = np.abs(drawn.scales[:, 0])[items.owners[begins]]
    shapes: dict[str, Shape] = {}
    for number, part in enumerate(parts_of(alphas_of(colors.mean(axis=1)), widths_m)):
        shapes[f"lines-{number}"] = Lines(
            ends[part.chosen].astype(np.float32),
            _in_pairs(rgb_of(colors[part.chosen].reshape(-1, 4))),
            part.size_m,
            part.opacity,
            drawn.rows[items.owners[begins[part.chosen]]],
        )
    return shapes


def triangles_of(markers: Rows) -> dict[str, Shape]:
    """Surfaces, stretched by the scale; each vertex or each triangle may have a colour."""
    drawn = _with_items(markers.of_types(Kind.TRIANGLES))
    if not len(drawn.rows):
        return {}
    items = placed_items(drawn, scaled=True)
    rgba = _surface_colors(drawn)
    alphas = alphas_of(rgba.reshape(-1, 3, 4).mean(axis=1))
    corners = items.positions.reshape(-1, 9)
    shapes: dict[str, Shape] = {}
    for number, part in enumerate(parts_of(alphas, np.ones(len(alphas)))):
        vertices = corners[part.chosen].reshape(-1, 3)
        shapes[f"triangles-{number}"] = Triangles(
            vertices.astype(np.float32),
            np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3),
            rgb_of(rgba.reshape(-1, 12)[part.chosen].reshape(-1, 4)),
            part.opacity,
            drawn.rows[items.owners[::3][part.chosen]],
        )
    return shapes


def _with_items(markers: Rows) -> Rows:
    return markers.only(np.array([len(each.points) > 0 for each in markers.items], dtype=np.bool_))


def _beginnings(drawn: Rows, items: PlacedItems) -> Whole:
    """Return which points begin a line: all of a strip but its last, every other one of a list."""
    is_begin = np.ones(len(items.owners), dtype=np.bool_)
    is_begin[items.starts[1:] - 1] = False
    in_list = drawn.types[items.owners] == Kind.LINE_LIST
    place = np.arange(len(items.owners)) - items.starts[items.owners]
    return np.flatnonzero(is_begin & ~(in_list & (place % 2 == 1)))


def _in_pairs(colors: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return colors if colors.ndim == 1 else colors.reshape(-1, 2, 3)


def _surface_colors(drawn: Rows) -> NDArray[np.float32]:
    """Return the colour of each vertex (V, 4), with RViz's own rules on what is blended.

    Colours of vertices are opaque unless one of the marker's is not, whatever its own alpha; those
    of whole triangles are opaque if the marker is.
    """
    colors: list[NDArray[np.float32]] = []
    for items, rgba in zip(drawn.items, drawn.rgba, strict=True):
        count = len(items.points)
        if len(items.rgba) == count:
            colors.append(_blended(items.rgba, rgba[3], bool((items.rgba[:, 3] < _OPAQUE).any())))
        elif len(items.rgba):
            whole = _blended(items.rgba, rgba[3], bool(rgba[3] < _OPAQUE))
            colors.append(np.repeat(whole, 3, axis=0))
        else:
            colors.append(np.broadcast_to(rgba, (count, 4)))
    return np.concatenate(colors)


def _blended(own: NDArray[np.float32], alpha: np.float32, blends: bool) -> NDArray[np.float32]:  # noqa: FBT001
    mixed = own.copy()
    mixed[:, 3] = own[:, 3] * alpha if blends else 1.0
    return mixed


def singles_of(markers: Rows) -> dict[str, Shape]:
    """Return texts and meshes by name."""
    shapes: dict[str, Shape] = dict(_texts(markers.of_types(Kind.TEXT)))
    shapes.update(_meshes(markers.of_types(Kind.MESH)))
    return shapes


def _texts(markers: Rows) -> Iterator[tuple[str, Text]]:
    """Words as high as scale.z, centred on the marker; how it is turned means nothing."""
    heights_m: list[float] = np.abs(markers.scales[:, 2]).tolist()
    rows: list[int] = markers.rows.tolist()
    for row, text, (xyz, rgb, opacity), height_m in zip(
        rows, markers.texts, _appearances(markers), heights_m, strict=True
    ):
        if height_m and opacity and text.strip():
            yield f"text-{row}", Text(text, xyz, height_m, rgb, opacity)


def _meshes(markers: Rows) -> Iterator[tuple[str, MeshFile]]:
    """Meshes in the marker's colour, or in their own; alpha counts for both.

    RViz takes a colour of all zeros for none where the mesh has its own.
    """
    for at, (xyz, rgb, opacity) in enumerate(_appearances(markers)):
        own = bool(markers.embedded[at])
        shown = 1.0 if own and not markers.rgba[at].any() else opacity
        if shown and markers.scales[at].all():
            x, y, z = markers.scales[at].tolist()
            w, i, j, k = markers.rotations_wxyz[at].tolist()
            colour = None if own else rgb
            mesh = MeshFile(markers.texts[at], (x, y, z), colour, shown, xyz, (w, i, j, k))
            yield f"mesh-{int(markers.rows[at])}", mesh


def _appearances(markers: Rows) -> Iterator[tuple[Xyz, Rgb, float]]:
    """Yield each marker's position, colour and opacity."""
    positions: list[list[float]] = markers.positions.tolist()
    colors: list[list[int]] = colors_of(markers.rgba).tolist()
    alphas: list[int] = alphas_of(markers.rgba).tolist()
    for (x, y, z), (red, green, blue), alpha in zip(positions, colors, alphas, strict=True):
        yield (x, y, z), (red, green, blue), alpha / 255
