"""The boxes around the visuals and collisions of links, in the frame of each link."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.robot.measures import geometry_bounds
from studio.robot.rotations import matrix_from_rpy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from studio.robot.measures import Bounds
    from studio.robot.rotations import Floats
    from studio.robot.values import Collision, Link, Visual

_MARKER_M: Final = 0.01


@dataclass(slots=True, eq=False)
class Extent:
    """Least and greatest corners, each (3,), m; None without geometry or with an unknown mesh."""

    visual: tuple[Floats, Floats] | None = None
    collision: tuple[Floats, Floats] | None = None

    @property
    def whole(self) -> tuple[Floats, Floats] | None:
        """The box around both, or around the one that is known."""
        boxes = [box for box in (self.visual, self.collision) if box is not None]
        if not boxes:
            return None
        lows, highs = zip(*boxes, strict=True)
        return np.minimum.reduce(lows), np.maximum.reduce(highs)


def is_marker(box: tuple[Floats, Floats]) -> bool:
    """Whether something is so small that it only marks where a frame is, as many robots do."""
    return bool((box[1] - box[0] <= _MARKER_M * (1 + 1e-9)).all())


@dataclass(slots=True)
class _Boxes:
    """Boxes of geometries in their own frames, one row each, to be turned all at once."""

    owners: list[tuple[str, bool]] = field(default_factory=list[tuple[str, bool]])
    """The link, and whether it is a visual."""
    corners: list[Bounds] = field(default_factory=list["Bounds"])
    places: list[tuple[float, ...]] = field(default_factory=list[tuple[float, ...]])

    def turned(self) -> Iterator[tuple[tuple[str, bool], Floats, Floats]]:
        """Owner, least and greatest corner in the link's frame."""
        corners, places = np.array(self.corners), np.array(self.places)
        turns = matrix_from_rpy(places[:, 3:])
        middles, halves = (corners[:, 0] + corners[:, 1]) / 2, np.ptp(corners, axis=1) / 2
        middles = np.einsum("nij,nj->ni", turns, middles) + places[:, :3]
        halves = np.einsum("nij,nj->ni", np.abs(turns), halves)
        return zip(self.owners, middles - halves, middles + halves, strict=True)


def extents(
    links: Iterable[Link], mesh_bounds: Callable[[str], Bounds | None]
) -> dict[str, Extent]:
    """Return the extent of each link by name; `mesh_bounds` as for `measure`.

    A side with an unknown mesh is None as a whole: half a box is of no use.
    """
    found: dict[str, Extent] = {}
    boxes = _Boxes()
    unknown: set[tuple[str, bool]] = set()
    for link in links:
        found[link.name] = Extent()
        for is_visual, side in ((True, link.visuals), (False, link.collisions)):
            if not _gather(boxes, (link.name, is_visual), side, mesh_bounds):
                unknown.add((link.name, is_visual))
    if boxes.owners:
        for owner, low, high in boxes.turned():
            if owner not in unknown:
                _widen(found[owner[0]], low, high, is_visual=owner[1])
    return found


def _gather(
    boxes: _Boxes,
    owner: tuple[str, bool],
    side: Iterable[Visual | Collision],
    mesh_bounds: Callable[[str], Bounds | None],
) -> bool:
    """Note the boxes of one side of a link; False when one is not known."""
    for one in side:
        bounds = geometry_bounds(one.geometry, mesh_bounds)
        if bounds is None:
            return False
        boxes.owners.append(owner)
        boxes.corners.append(bounds)
        boxes.places.append((*one.origin.xyz, *one.origin.rpy))
    return True


def _widen(extent: Extent, low: Floats, high: Floats, *, is_visual: bool) -> None:
    before = extent.visual if is_visual else extent.collision
    if before is not None:
        low, high = np.minimum(before[0], low), np.maximum(before[1], high)
    if is_visual:
        extent.visual = low, high
    else:
        extent.collision = low, high
