"""Checks of meshes for a scale in the wrong unit: millimetres read as metres, or the reverse."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.problems import Severity
from studio.robot.checks.finding import Finding, SetAttributes
from studio.robot.measures import geometry_bounds
from studio.robot.values import Mesh

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.robot.measures import Bounds
    from studio.robot.values import Geometry, Link, Robot

_LARGEST_M: Final = 20.0
_SMALLEST_M: Final = 0.0005
_ORDINARY_M: Final = 0.01
"""Where another part drawn in the same unit is that large, a tiny one is a marker."""
_STRIKING_M: Final = 2.0
"""Of this size on a mesh is suspected when it dwarfs the rest of the robot."""
_DWARFS: Final = 100.0


def mesh_scale_findings(
    robot: Robot, mesh_bounds: Callable[[str], Bounds | None]
) -> Iterator[Finding]:
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
    """What a mesh's numbers are scaled by; None for a shape, whose numbers are metres."""
    return None if mesh is None else max(map(abs, mesh.scale))


def _usual_m(sizes_m: list[float]) -> float:
    """The median of what is left without the largest; 0 when there is nothing."""
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
