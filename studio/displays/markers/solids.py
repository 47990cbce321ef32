"""Boxes, balls and cylinders of markers: each kind of a whole batch is one shape."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Literal, NamedTuple

import numpy as np

from studio.displays.drawing import Points, Solids
from studio.displays.markers.colours import alphas_of, parts_of, rgb_of
from studio.displays.markers.items import item_colors, placed_items
from studio.displays.markers.kinds import Kind

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Shape
    from studio.displays.markers.kinds import Flags, Floats
    from studio.displays.markers.table import Rows

SolidKind = Literal["box", "sphere", "cylinder", "cone"]

_KINDS: Final[tuple[tuple[str, SolidKind, Kind, Kind | None], ...]] = (
    ("boxes", "box", Kind.CUBE, Kind.CUBE_LIST),
    ("balls", "sphere", Kind.SPHERE, Kind.SPHERE_LIST),
    ("cylinders", "cylinder", Kind.CYLINDER, None),
)
"""Names of shapes, what they are, and which single markers and lists become them."""
MANY: Final = 2000
"""From so many equal boxes or balls on a list is drawn as a cloud of them."""
_HALF_PRECISION: Final = 2.0**-10
_SEEN_SHARE: Final = 0.05


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
    """One shape of all that is not clear; None when nothing is left."""
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
    )


def is_seen_in_half(positions: Floats, size_m: float) -> bool:
    """Whether half precision of positions (N, 3) would be seen in things of a size."""
    farthest_m = float(np.abs(positions).max(initial=0.0))
    return farthest_m * _HALF_PRECISION > size_m * _SEEN_SHARE


def _singles(markers: Rows) -> Bodies:
    return Bodies(markers.positions, markers.rotations_wxyz, markers.scales, markers.rgba)


def _listed(markers: Rows) -> Bodies:
    if not len(markers.rows):
        return _singles(markers)
    items = placed_items(markers)
    return Bodies(
        items.positions,
        markers.rotations_wxyz[items.owners],
        markers.scales[items.owners],
        item_colors(markers, items),
    )


def _are_clouds(lists: Rows) -> Flags:
    """Which lists are of so many equal boxes or balls that a cloud is the better way."""
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
        )  # fmt: skip
