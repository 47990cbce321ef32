"""Many solids or arrows as few nodes: one mesh, drawn once for each place."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from viser import _messages

from studio.displays.drawing import Solids
from studio.scene.node import Node

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from studio.displays.drawing import Arrows, SolidKind

_SEGMENTS: Final = 24
"""Of a circle."""
_LEVELS: Final = 32
"""Of opacity."""
_SHORTEST_M = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class UnitMesh:
    """Triangles; a corner that an edge runs through is there once for each side of the edge.

    Attributes:
        vertices: Shape (V, 3), float32, m; read-only.
        faces: Shape (F, 3), uint32, seen from outside against the clock; read-only.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]


@cache
def unit_mesh(kind: SolidKind) -> UnitMesh:
    """Return a box, ball or cylinder around the origin, or a cone from there to z = 1.

    All reach 0.5 m from the z axis.
    """
    vertices, faces = _MAKERS[kind]()
    points = np.array(vertices, dtype=np.float32).reshape(-1, 3)
    triangles = np.array(faces, dtype=np.uint32).reshape(-1, 3)
    points.setflags(write=False)
    triangles.setflags(write=False)
    return UnitMesh(points, triangles)


def _box() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Return a box whose sides have corners of their own, or its edges would be shaded round."""
    square = np.array([[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]]) / 2
    sides: list[NDArray[np.float64]] = []
    for axis in range(3):
        upper = np.roll(square, axis + 1, axis=1)
        sides += [upper, -upper[::-1]]
    return np.concatenate(sides), _quads(np.arange(24).reshape(6, 4))


def _quads(corners: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return two triangles for each row of four corners."""
    return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])


def _sphere() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Rings of corners from pole to pole."""
    rings = _SEGMENTS // 2
    polar, turn = np.meshgrid(
        np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, _SEGMENTS, endpoint=False)
    )
    polar, turn = polar.T, turn.T
    points = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)])
    return points.reshape(3, -1).T / 2, _rings(rings + 1)


def _rings(count: int) -> NDArray[np.intp]:
    """Triangles between rings of `_SEGMENTS` corners each, the upper ring first."""
    row, column = np.mgrid[: count - 1, :_SEGMENTS]
    beside = (column + 1) % _SEGMENTS
    upper, lower = row * _SEGMENTS, (row + 1) * _SEGMENTS
    corners = np.stack([upper + column, lower + column, lower + beside, upper + beside], axis=-1)
    return _quads(corners.reshape(-1, 4))


def _circle(z_m: float) -> NDArray[np.float64]:
    turn = np.linspace(0, 2 * np.pi, _SEGMENTS, endpoint=False)
    return np.stack([np.cos(turn) / 2, np.sin(turn) / 2, np.full(_SEGMENTS, z_m)], axis=1)


def _fan(first: int, *, down: bool) -> NDArray[np.intp]:
    """Return a round plate of corners from `first` on."""
    near = np.arange(1, _SEGMENTS - 1)
    corners = np.stack([np.zeros_like(near), near, near + 1], axis=1) + first
    return corners[:, ::-1] if down else corners


def _cylinder() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    top, bottom = _circle(0.5), _circle(-0.5)
    faces = [_rings(2), _fan(2 * _SEGMENTS, down=False), _fan(3 * _SEGMENTS, down=True)]
    return np.concatenate([top, bottom, top, bottom]), np.concatenate(faces)


def _cone() -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """The tip is there once for each segment, so that light runs evenly around it."""
    base, tips = _circle(1.0), np.zeros((_SEGMENTS, 3))
    near = np.arange(_SEGMENTS)
    sides = np.stack([near, near + _SEGMENTS, (near + 1) % _SEGMENTS], axis=1)
    return np.concatenate([base, tips, base]), np.concatenate(
        [sides, _fan(2 * _SEGMENTS, down=False)]
    )


_MAKERS: Final[dict[SolidKind, Callable[[], tuple[NDArray[np.float64], NDArray[np.intp]]]]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "cone": _cone,
}


def _linear_levels() -> NDArray[np.uint8]:
    shown = np.arange(256) / 255
    linear = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    return np.round(linear * 255).astype(np.uint8)


LINEAR_LEVELS: Final = _linear_levels()
"""sRGB to amounts of light, both 0 to 255: what viser's page takes for colours of many solids."""


def linear(colors: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Colours as amounts of light."""
    return LINEAR_LEVELS[colors]


def many_of(shape: Solids, stream: str) -> dict[str, Node]:
    """Return a node for each opacity, in steps of 1/32; what is invisible is not drawn.

    viser's page could take an opacity for each, but would then make its mesh again with each
    message, and never give back what the one before took of the graphics processor.
    """
    if len(shape.positions) == 0:
        return {}
    levels = levels_of(shape)
    nodes: dict[str, Node] = {}
    for level in np.unique(levels[levels > 0]).tolist():
        which = None if levels.ndim == 0 or (levels == level).all() else levels == level
        name = "many" if level == _LEVELS else f"many-{level:.0f}"
        nodes[name] = _many(shape, which, level / _LEVELS, stream)
    return nodes


def levels_of(shape: Solids) -> NDArray[np.float64]:
    """Return the opacity of each solid in steps of 1/32, shape (N,), or () if all have one."""
    with np.errstate(invalid="ignore"):
        return np.clip(np.rint(np.multiply(shape.opacities, _LEVELS)), 0, _LEVELS)


def level_of_node(node: str) -> float:
    """Return the level of the solids that `many_of` draws as a node of that name."""
    _, _, level = node.partition("-")
    return float(level) if level.isascii() and level.isdigit() else float(_LEVELS)


def _many(shape: Solids, which: NDArray[np.bool_] | None, opacity: float, stream: str) -> Node:
    mesh = unit_mesh(shape.kind)
    props: dict[str, Any] = {
        "lod": "off",
        "wireframe": False,
        "opacity": opacity if opacity < 1 else None,
        "flat_shading": False,
        "side": "front",
        "material": "standard",
        "cast_shadow": False,
        "receive_shadow": False,
        "batched_opacities": None,
        "scale": 1.0,
    }
    one_color = shape.colors.ndim == 1
    flowing: dict[str, NDArray[Any]] = {
        "batched_wxyzs": _rows(shape.wxyz, which),
        "batched_positions": _rows(shape.positions, which),
        "batched_scales": _rows(shape.scales, which),
        "batched_colors": linear(shape.colors if one_color else _colors(shape.colors, which)),
    }
    arrays: dict[str, NDArray[Any]] = {"vertices": mesh.vertices, "faces": mesh.faces}
    return Node(
        _messages.BatchedMeshesMessage,
        props,
        content=shape.kind,
        arrays=arrays,
        stream=stream,
        flowing=flowing,
    )


def _rows(values: NDArray[np.float32], which: NDArray[np.bool_] | None) -> NDArray[np.float32]:
    return np.ascontiguousarray(values if which is None else values[which], np.float32)


def _colors(values: NDArray[np.uint8], which: NDArray[np.bool_] | None) -> NDArray[np.uint8]:
    return np.ascontiguousarray(values if which is None else values[which])


def arrows_of(shape: Arrows, stream: str) -> dict[str, Node]:
    """Whole arrows, and for short ones a head that is smaller in all its sizes."""
    along, lengths_m = _lengths_of(shape)
    whole, short = _parts(shape, lengths_m)
    nodes: dict[str, Node] = {}
    if whole.any():
        nodes["arrows"] = _whole(shape, whole, stream)
    if short.any():
        nodes.update(many_of(_heads(shape, along, lengths_m, short), stream))
    return nodes


def whole_and_short(shape: Arrows) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which arrows have a shaft and a whole head, and which are all head, shape (N,)."""
    return _parts(shape, _lengths_of(shape)[1])


def _parts(
    shape: Arrows, lengths_m: NDArray[np.float32]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    whole = lengths_m >= max(shape.head_length_m, _SHORTEST_M)
    return whole, (lengths_m > _SHORTEST_M) & ~whole


def _lengths_of(shape: Arrows) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return the ways from tails to tips, shape (N, 3), and their lengths, m."""
    with np.errstate(invalid="ignore"):
        along: NDArray[np.float32] = shape.ends[:, 1] - shape.ends[:, 0]
    lengths_m: NDArray[np.float32] = np.linalg.norm(along, axis=1)
    lengths_m[~np.isfinite(lengths_m)] = 0  # from nowhere or to nowhere: not drawn
    return along, lengths_m


def _whole(shape: Arrows, which: NDArray[np.bool_], stream: str) -> Node:
    props: dict[str, Any] = {
        "shaft_radius": shape.shaft_diameter_m / 2,
        "head_radius": shape.head_diameter_m / 2,
        "head_length": shape.head_length_m,
        "scale": 1.0,
        "studio_opacity": shape.opacity,
    }
    arrays: dict[str, NDArray[Any]] = {
        "points": np.ascontiguousarray(shape.ends[which], np.float32),
        "colors": linear(_colors_of(shape, which)),
    }
    # Which arrows are whole hangs on the length of their heads.
    name = f"{stream}/{shape.head_length_m}"
    return Node(_messages.ArrowMessage, props, stream=name, flowing=arrays)


def _colors_of(shape: Arrows, which: NDArray[np.bool_]) -> NDArray[np.uint8]:
    return np.ascontiguousarray(shape.colors[which] if shape.colors.ndim > 1 else shape.colors)


def _heads(
    shape: Arrows,
    along: NDArray[np.float32],
    lengths_m: NDArray[np.float32],
    which: NDArray[np.bool_],
) -> Solids:
    long_m = lengths_m[which]
    width_m = shape.head_diameter_m * long_m / shape.head_length_m
    return Solids(
        "cone",
        shape.ends[which, 1],
        _z_turned_to(-along[which] / long_m[:, None]),
        np.stack([width_m, width_m, long_m], axis=1),
        _colors_of(shape, which),
        shape.opacity,
    )


def _z_turned_to(directions: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return quaternions that turn z to each direction, shape (N, 3) of length 1."""
    x, y, z = directions.T
    wxyz = np.stack([1 + z, -y, x, np.zeros_like(x)], axis=1)
    wxyz[z < -1 + 1e-6] = (0, 1, 0, 0)  # straight back: half a turn about x
    return wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True)
