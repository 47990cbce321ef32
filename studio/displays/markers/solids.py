"""Boxes, spheres, cylinders and arrows of markers: each kind of a whole batch is one shape."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.drawing import Points, Solids
from studio.displays.markers.items import (
    alphas_of,
    item_colors,
    parts_of,
    place,
    placed_items,
    rgb_of,
)
from studio.displays.markers.kinds import Kind
from studio.displays.turning import products, turns_from_z

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Shape, SolidKind
    from studio.displays.markers.kinds import Flags, Floats, Whole
    from studio.displays.markers.table import Rows


_KINDS: Final[tuple[tuple[str, SolidKind, Kind, Kind | None], ...]] = (
    ("boxes", "box", Kind.CUBE, Kind.CUBE_LIST),
    ("balls", "sphere", Kind.SPHERE, Kind.SPHERE_LIST),
    ("cylinders", "cylinder", Kind.CYLINDER, None),
)
"""Names of shapes, what they are, and which single markers and lists become them."""
MANY: Final = 2000
"""From this number on, equal boxes or balls are drawn as a point cloud."""
_HALF_PRECISION: Final = 2.0**-10
_SEEN_SHARE: Final = 0.05
HEAD_SHARE: Final = 0.23
"""Share of the length, where the head's length is not given."""
_HEAD_SHARE_OF_STRIPS: Final = 0.25
_HEAD_BY_SHAFT: Final = 2.0
_HALF: Final = np.sqrt(0.5)
# From z to x: a quarter turn about y.
_Z_TO_X: Final = np.array([_HALF, 0.0, _HALF, 0.0])
# From z to -x, for arrows of negative length.
_Z_TO_BACK: Final = np.array([_HALF, 0.0, -_HALF, 0.0])
_HALF_TURN: Final = np.array([0.0, 1.0, 0.0, 0.0])
_Z: Final = np.array([0.0, 0.0, 1.0])


class Bodies(NamedTuple):
    """N solids."""

    positions: Floats
    """Shape (N, 3), m in the frame."""
    wxyz: Floats
    """Shape (N, 4)."""
    scales: Floats
    """Shape (N, 3), m."""
    rgba: NDArray[np.float32]
    """Shape (N, 4)."""
    items: Whole
    """Shape (N,): the row of the marker that each belongs to."""


def solids_of(markers: Rows) -> dict[str, Shape]:
    """Boxes, balls and cylinders by name."""
    shapes: dict[str, Shape] = {}
    kinds = set(markers.types.tolist())
    for name, kind, single, many in _KINDS:
        bodies: list[Bodies] = []
        if single in kinds:
            bodies.append(_singles(markers.of_types(single)))
        if many is not None and many in kinds:
            lists = markers.of_types(many)
            as_cloud = _are_clouds(lists)
            bodies.append(_listed(lists.only(~as_cloud)))
            _add_clouds(shapes, name, lists.only(as_cloud))
        made = solids(kind, joined(bodies)) if bodies else None
        if made is not None:
            shapes[name] = made
    return shapes


def solids(kind: SolidKind, bodies: Bodies) -> Solids | None:
    """Return one shape of all that is not transparent; None when nothing is left."""
    alphas = alphas_of(bodies.rgba)
    seen = alphas > 0
    if not seen.any():
        return None
    alphas = alphas[seen]
    same = bool((alphas == alphas[0]).all())
    return Solids(
        kind,
        bodies.positions[seen].astype(np.float32),
        bodies.wxyz[seen].astype(np.float32),
        np.abs(bodies.scales[seen]).astype(np.float32),
        rgb_of(bodies.rgba[seen]),
        float(alphas[0]) / 255 if same else (alphas / 255).astype(np.float32),
        bodies.items[seen],
    )


def joined(many: list[Bodies]) -> Bodies:
    """Bodies one after another."""
    if len(many) == 1:
        return many[0]
    return Bodies(
        np.concatenate([each.positions for each in many]),
        np.concatenate([each.wxyz for each in many]),
        np.concatenate([each.scales for each in many]),
        np.concatenate([each.rgba for each in many]),
        np.concatenate([each.items for each in many]),
    )


def is_seen_in_half(positions: Floats, size_m: float) -> bool:
    """Whether half precision of positions (N, 3) would be seen in things of a size."""
    farthest_m = float(np.abs(positions).max(initial=0.0))
    return farthest_m * _HALF_PRECISION > size_m * _SEEN_SHARE


def _singles(markers: Rows) -> Bodies:
    return Bodies(
        markers.positions, markers.rotations_wxyz, markers.scales, markers.rgba, markers.rows
    )


def _listed(markers: Rows) -> Bodies:
    if not len(markers.rows):
        return _singles(markers)
    items = placed_items(markers)
    return Bodies(
        items.positions,
        markers.rotations_wxyz[items.owners],
        markers.scales[items.owners],
        item_colors(markers, items),
        markers.rows[items.owners],
    )


def _are_clouds(lists: Rows) -> Flags:
    """Return which lists have so many equal boxes or balls that a cloud of points is better."""
    many = np.array([len(each.points) >= MANY for each in lists.items], dtype=np.bool_)
    even = (lists.scales == lists.scales[:, :1]).all(axis=1)
    upright = np.abs(lists.rotations_wxyz[:, 0]) >= 1.0
    return many & even & (upright | (lists.types == Kind.SPHERE_LIST))


def _add_clouds(shapes: dict[str, Shape], name: str, lists: Rows) -> None:
    if not len(lists.rows):
        return
    items = placed_items(lists)
    rgba = item_colors(lists, items)
    sizes_m = np.abs(lists.scales[:, 0])[items.owners]
    style = "boxes" if name == "boxes" else "spheres"
    for number, part in enumerate(parts_of(alphas_of(rgba), sizes_m)):
        positions = items.positions[part.chosen]
        shapes[f"many-{name}-{number}"] = Points(
            positions.astype(np.float32), rgb_of(rgba[part.chosen]), part.size_m, style,
            part.opacity, is_seen_in_half(positions, part.size_m),
            items=lists.rows[items.owners[part.chosen]],
        )  # fmt: skip


class Arrow(NamedTuple):
    """N arrows along the z axis of `wxyz`."""

    tails: Floats
    """Shape (N, 3), m in the frame."""
    tips: Floats
    """Shape (N, 3), m in the frame."""
    wxyz: Floats
    """Shape (N, 4)."""
    shafts_m: Floats
    """Shape (N, 2): diameters across x and y."""
    heads_m: Floats
    """Shape (N, 2)."""
    head_lengths_m: Floats
    """Shape (N,), at most the whole length."""
    rgba: NDArray[np.float32]
    """Shape (N, 4)."""
    items: Whole
    """Shape (N,): the row of the marker that each belongs to."""


def arrows_of(markers: Rows) -> dict[str, Shape]:
    """Shafts and heads of all arrows."""
    single = markers.of_types(Kind.ARROW)
    between = np.array([len(each.points) == 2 for each in single.items], dtype=np.bool_)
    strips = markers.of_types(Kind.ARROW_STRIP)
    many = [
        _by_pose(single.only(~between)),
        _by_points(single.only(between), HEAD_SHARE),
        _by_points(strips, _HEAD_SHARE_OF_STRIPS),
    ]
    whole = Arrow(*(np.concatenate(parts) for parts in zip(*many, strict=True)))
    return _shapes(whole)


def _by_pose(markers: Rows) -> Arrow:
    """Along x from the pose on, scale.x long; the head is twice as thick as the shaft."""
    lengths_m = markers.scales[:, 0]
    along = np.zeros_like(markers.scales)
    along[:, 0] = lengths_m
    everyone = np.arange(len(lengths_m))
    to_x = np.where(lengths_m[:, None] < 0, _Z_TO_BACK, _Z_TO_X)
    # Turned so, x of the arrow is its height and y its width.
    shafts_m = np.abs(markers.scales[:, [2, 1]])
    return Arrow(
        markers.positions,
        place(markers, everyone, along),
        products(markers.rotations_wxyz, to_x),
        shafts_m,
        _HEAD_BY_SHAFT * shafts_m,
        HEAD_SHARE * np.abs(lengths_m),
        markers.rgba,
        markers.rows,
    )


def _by_points(markers: Rows, head_share: float) -> Arrow:
    """Return arrows from point to point: scale.x is the shaft, y the head, z the head's length."""
    owners, tails, tips = _pairs(markers)
    tails, tips = place(markers, owners, tails), place(markers, owners, tips)
    lengths_m = np.linalg.norm(tips - tails, axis=1)
    scales = markers.scales[owners]
    given = np.clip(scales[:, 2], 0.0, lengths_m)
    return Arrow(
        tails,
        tips,
        turns_from_z(_unit_or_z(tips - tails, lengths_m)),
        np.abs(scales[:, [0, 0]]),
        np.abs(scales[:, [1, 1]]),
        np.where(scales[:, 2] == 0, head_share * lengths_m, given),
        markers.rgba[owners],
        markers.rows[owners],
    )


def _pairs(markers: Rows) -> tuple[Whole, Floats, Floats]:
    counts = [max(len(each.points) - 1, 0) for each in markers.items]
    owners = np.repeat(np.arange(len(counts)), counts)
    none = np.empty((0, 3))
    tails = np.concatenate([none, *(each.points[:-1] for each in markers.items)])
    tips = np.concatenate([none, *(each.points[1:] for each in markers.items)])
    return owners, tails, tips


def _shapes(arrows: Arrow) -> dict[str, Shape]:
    lengths_m = np.linalg.norm(arrows.tips - arrows.tails, axis=1)
    shaft_lengths_m = lengths_m - arrows.head_lengths_m
    directions = arrows.tips - arrows.tails
    directions = directions / np.where(lengths_m == 0, 1.0, lengths_m)[:, None]
    middles = arrows.tails + directions * (shaft_lengths_m / 2)[:, None]
    shafts = Bodies(
        middles, arrows.wxyz, _sized(arrows.shafts_m, shaft_lengths_m), arrows.rgba, arrows.items
    )
    # A cone stands on its tip, and that of an arrow points ahead.
    backwards = products(arrows.wxyz, np.broadcast_to(_HALF_TURN, arrows.wxyz.shape))
    heads = Bodies(
        arrows.tips, backwards, _sized(arrows.heads_m, arrows.head_lengths_m), arrows.rgba,
        arrows.items,
    )  # fmt: skip
    shapes: dict[str, Shape] = {}
    for name, kind, bodies in (("shafts", "cylinder", shafts), ("heads", "cone", heads)):
        made = solids("cylinder" if kind == "cylinder" else "cone", _solid(bodies))
        if made is not None:
            shapes[name] = made
    return shapes


def _sized(diameters_m: Floats, lengths_m: Floats) -> Floats:
    return np.concatenate((diameters_m, lengths_m[:, None]), axis=1)


def _solid(bodies: Bodies) -> Bodies:
    """Return those with a length and thickness: an arrow may be all shaft, or all head."""
    kept = (bodies.scales[:, 2] > 0) & (bodies.scales[:, :2] > 0).any(axis=1)
    return Bodies(
        bodies.positions[kept], bodies.wxyz[kept], bodies.scales[kept], bodies.rgba[kept],
        bodies.items[kept],
    )  # fmt: skip


def _unit_or_z(vectors: Floats, lengths_m: Floats) -> Floats:
    """Return vectors (N, 3) at length 1; z for those of length 0."""
    units = vectors / np.where(lengths_m == 0, 1.0, lengths_m)[:, None]
    units[lengths_m == 0] = _Z
    return units
