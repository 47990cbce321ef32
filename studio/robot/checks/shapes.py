"""Checks of shapes: collision against visual, and meshes scaled in the wrong unit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.problems import Severity
from studio.robot.checks.extents import is_marker
from studio.robot.checks.finding import Finding, SetAttributes
from studio.robot.measures import geometry_bounds
from studio.robot.values import Mesh

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from studio.robot.checks.extents import Extent
    from studio.robot.checks.finding import CheckedRobot
    from studio.robot.measures import Bounds
    from studio.robot.rotations import Floats
    from studio.robot.values import Geometry, Link, Robot

_TIMES: Final = 3.0
"""Largest ratio of two diagonals."""
_SLACK_M: Final = 0.002
_LARGEST_M: Final = 20.0
_SMALLEST_M: Final = 0.0005
_ORDINARY_M: Final = 0.01
"""Where another part drawn in the same unit is that large, a tiny one is a marker."""
_STRIKING_M: Final = 2.0
"""From this size on a mesh is suspected when it dwarfs the rest of the robot."""
_DWARFS: Final = 100.0


def findings(checked: CheckedRobot) -> Iterator[Finding]:
    """Yield collisions that do not fit their visuals, and shapes of an unlikely size."""
    yield from _of_collisions(checked.robot, checked.extents)
    yield from _of_scales(checked.robot, checked.mesh_bounds)


def _of_collisions(robot: Robot, extents: Mapping[str, Extent]) -> Iterator[Finding]:
    """Yield links whose collision lies elsewhere than the visual, or is of another size."""
    for name in robot.links:
        extent = extents[name]
        if extent.visual is None or extent.collision is None or is_marker(extent.visual):
            continue
        what = _difference(extent.visual, extent.collision)
        if what:
            code, sentence = what
            sentence = f'The <collision> of link "{name}" {sentence}'
            yield Finding(Severity.WARNING, code, sentence, f"link:{name}")


def _difference(
    visual: tuple[Floats, Floats], collision: tuple[Floats, Floats]
) -> tuple[str, str] | None:
    """Code and the end of a sentence; None when the boxes are alike."""
    gap = np.maximum(visual[0] - collision[1], collision[0] - visual[1])
    if (gap > _SLACK_M).any():
        apart_m = float(np.linalg.norm(np.maximum(gap, 0)))
        return (
            "collision-apart",
            f"lies {apart_m:.3g} m beside its <visual>: check the <origin> of both.",
        )
    seen_m, touched_m = (float(np.linalg.norm(high - low)) for low, high in (visual, collision))
    larger, smaller = max(seen_m, touched_m), min(seen_m, touched_m)
    if larger <= _TIMES * smaller + _SLACK_M:
        return None
    how = "larger" if touched_m > seen_m else "smaller"
    times = f"{larger / smaller:.3g} times" if smaller else "much"
    return "collision-size", f"is {times} {how} than its <visual>: check the size or the scale."


def _of_scales(robot: Robot, mesh_bounds: Callable[[str], Bounds | None]) -> Iterator[Finding]:
    """Meshes of a size that no part of this robot has; `mesh_bounds` as for `measure`."""
    sizes = _sizes_m(robot, mesh_bounds)
    usual_m = _usual_m([size_m for size_m, _, _ in sizes.values()])
    ordinary = {_unit(mesh) for size_m, _, mesh in sizes.values() if size_m >= _ORDINARY_M}
    for size_m, link, mesh in sizes.values():
        if size_m > _LARGEST_M or (size_m > _STRIKING_M and 0 < usual_m * _DWARFS < size_m):
            yield _finding(link, mesh, size_m, 0.001)
        elif 0 < size_m < _SMALLEST_M and _unit(mesh) not in ordinary:
            yield _finding(link, mesh, size_m, 1000.0)


def _unit(mesh: Mesh | None) -> float | None:
    """Return the scale of a mesh's numbers; None for a shape, whose numbers are metres."""
    return None if mesh is None else max(map(abs, mesh.scale))


def _usual_m(sizes_m: list[float]) -> float:
    """Return the median of what is left without the largest; 0 when there is nothing."""
    rest = sorted(sizes_m)[:-1]
    return rest[(len(rest) - 1) // 2] if rest else 0.0


def _sizes_m(
    robot: Robot, mesh_bounds: Callable[[str], Bounds | None]
) -> dict[str, tuple[float, Link, Mesh | None]]:
    """Longest side of every geometry: meshes by URI, the rest by a name of their own."""
    found: dict[str, tuple[float, Link, Mesh | None]] = {}
    for link in robot.links.values():
        for one in (*link.visuals, *link.collisions):
            bounds = geometry_bounds(one.geometry, mesh_bounds)
            if bounds is None:
                continue
            size_m = max(abs(high - low) for low, high in zip(*bounds, strict=True))
            mesh = one.geometry if isinstance(one.geometry, Mesh) else None
            found.setdefault(_name(one.geometry), (size_m, link, mesh))
    return found


def _name(geometry: Geometry) -> str:
    return geometry.uri if isinstance(geometry, Mesh) else repr(geometry)


def _finding(link: Link, mesh: Mesh | None, size_m: float, factor: float) -> Finding:
    key = f"link:{link.name}"
    unit = "millimetres" if factor < 1 else "metres"
    size = f"{size_m:.3g} m" if factor < 1 else f"{1000 * size_m:.3g} mm"
    if mesh is None:
        sentence = f'A shape of link "{link.name}" is {size} long: sizes are in metres.'
        return Finding(Severity.WARNING, "shape-scale", sentence, key)
    sentence = (
        f'The mesh "{mesh.uri}" of link "{link.name}" is {size} long: it seems to be drawn in '
        f"{unit}, write the scale that turns it into metres."
    )
    scale = " ".join(f"{one * factor:.6g}" for one in mesh.scale)
    mend = SetAttributes(
        f'Write scale="{scale}"',
        ("*", "geometry", "mesh"),
        (("scale", scale),),
        where=("filename", mesh.uri),
    )
    return Finding(Severity.WARNING, "mesh-scale", sentence, key, mend)


WHY: Final = {
    "collision-apart": {
        "en": "The collision shape lies beside what is seen, so contacts happen where nothing is. "
        "Often an origin was forgotten in one of the two.",
        "de": "Die Kollisionsform liegt neben dem Sichtbaren; Berührungen geschehen dann, wo "
        "nichts ist. Oft wurde in einem von beiden das origin vergessen.",
    },
    "collision-size": {
        "en": "Collision and visual differ much in size. Often one mesh is in millimetres or one "
        "scale was forgotten.",
        "de": "Kollision und Visual sind sehr verschieden groß. Oft ist ein Mesh in Millimetern, "
        "oder ein scale wurde vergessen.",
    },
    "shape-scale": {
        "en": "URDF counts in metres: a shape of this size is likely meant in millimetres or "
        "centimetres.",
        "de": "URDF rechnet in Metern: Eine Form dieser Größe ist wohl in Millimetern oder "
        "Zentimetern gemeint.",
    },
    "mesh-scale": {
        "en": "URDF counts in metres. A mesh drawn in millimetres comes out a thousand times too "
        'large without scale="0.001 0.001 0.001".',
        "de": 'URDF rechnet in Metern. Ein Mesh in Millimetern wird ohne scale="0.001 0.001 '
        '0.001" tausendmal zu groß.',
    },
}
"""By code and language: why a finding matters, as the page explains it."""
