"""Geometries of a robot as nodes: primitives, meshes, and a sign where a mesh is missing."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from studio.robot.meshes.textured import scale_of
from studio.robot.values import Box, Cylinder, Mesh, Sphere
from studio.scene import node
from studio.scene.node import Look
from studio.scene.pose import wxyz_and_position

if TYPE_CHECKING:
    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import Geometry, Material, Origin, Robot
    from studio.scene.node import Node, Rgb

DEFAULT_RGB: Rgb = (196, 200, 206)
COLLISION_LOOK = Look((255, 140, 60), opacity=0.45, shadow=False)
MISSING_LOOK = Look((255, 176, 32), wireframe=True, shadow=False)
MISSING_SIZE_M = (0.1, 0.1, 0.1)


class MeshShelf:
    """The meshes that came, by URI; None for one that cannot be loaded."""

    def __init__(self) -> None:
        self._meshes: dict[str, LoadedMesh | None] = {}

    def __contains__(self, uri: str) -> bool:
        return uri in self._meshes

    def get(self, uri: str) -> LoadedMesh | None:
        """The mesh, or None when it failed or has not come."""
        return self._meshes.get(uri)

    def put(self, uri: str, mesh: LoadedMesh | None) -> bool:
        """Keep it; whether that changes what is drawn."""
        old, came = self._meshes.get(uri), uri in self._meshes
        self._meshes[uri] = mesh
        if not came or old is None or mesh is None:
            return not (came and old is mesh)
        return old.digest != mesh.digest

    def keep_only(self, uris: set[str]) -> None:
        """Forget the meshes that no robot names any more."""
        self._meshes = {uri: mesh for uri, mesh in self._meshes.items() if uri in uris}


def look_of(material: Material | None, robot: Robot) -> Look:
    """Colour of a visual: its own, else that of the material of the same name, else light grey."""
    rgba = material.rgba if material else None
    if material is not None and rgba is None and material.name in robot.materials:
        rgba = robot.materials[material.name].rgba
    return Look(DEFAULT_RGB) if rgba is None else _look_of_rgba(rgba)


@lru_cache(maxsize=1 << 10)
def _look_of_rgba(rgba: tuple[float, float, float, float]) -> Look:
    red, green, blue, alpha = (min(max(channel, 0.0), 1.0) for channel in rgba)
    return Look((round(red * 255), round(green * 255), round(blue * 255)), alpha)


def draw(
    geometry: Geometry,
    origin: Origin,
    look: Look,
    shelf: MeshShelf,
    *,
    own_colors: bool = True,
    texture: str = "",
) -> Node | None:
    """The node of one geometry, or None while its mesh is on the way.

    Args:
        geometry: What to draw.
        origin: Its pose in the link.
        look: Colour, unless the mesh has its own and `own_colors` lets it.
        shelf: The meshes that came.
        own_colors: Materials of a mesh file win over `look`, as in RViz.
        texture: URI of the primitive with an image on it; until that comes, `look` is drawn.
    """
    wxyz, at = wxyz_and_position(origin)
    if texture and (textured := shelf.get(texture)) is not None:
        return node.colored_mesh(textured, scale_of(geometry), wxyz, at)
    match geometry:
        case Box():
            return node.box(geometry.size_m, look, wxyz, at)
        case Cylinder():
            return node.cylinder(geometry.radius_m, geometry.length_m, look, wxyz, at)
        case Sphere():
            return node.sphere(geometry.radius_m, look, wxyz, at)
        case Mesh():
            return _draw_mesh(geometry, origin, look, shelf, own_colors=own_colors)


def _draw_mesh(
    geometry: Mesh, origin: Origin, look: Look, shelf: MeshShelf, *, own_colors: bool
) -> Node | None:
    if geometry.uri not in shelf:
        return None
    wxyz, at = wxyz_and_position(origin)
    loaded = shelf.get(geometry.uri)
    if loaded is None:
        return node.box(MISSING_SIZE_M, MISSING_LOOK, wxyz, at)
    if loaded.glb and own_colors:
        return node.colored_mesh(loaded, geometry.scale, wxyz, at)
    return node.mesh(loaded, geometry.scale, look, wxyz, at)
