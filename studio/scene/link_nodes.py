"""The nodes of one link of a robot: its geometries, and the layers that show more of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.robot.masses import inertia_box
from studio.robot.meshes.textured import scale_of, textured_uri
from studio.robot.rotations import wxyz_from_matrices
from studio.robot.values import Box, Cylinder, JointType, Mesh, Sphere
from studio.scene import node
from studio.scene.node import Style
from studio.tf import rotations

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from studio.displays.drawing import LinkParts
    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import (
        Geometry,
        Joint,
        Link,
        Material,
        Origin,
        Robot,
        Vector3,
        Visual,
    )
    from studio.scene.node import Node, Quaternion, Rgb

DEFAULT_RGB: Rgb = (196, 200, 206)
COLLISION_STYLE = Style((255, 140, 60), opacity=0.45, shadow=False)
MISSING_STYLE = Style((255, 176, 32), wireframe=True, shadow=False)
MISSING_SIZE_M = (0.1, 0.1, 0.1)
FRAME_LENGTH_M = 0.1
AXIS_LENGTH_M = 0.18
_AXIS_RGB: dict[JointType, Rgb] = {
    JointType.REVOLUTE: (167, 139, 250),
    JointType.CONTINUOUS: (96, 165, 250),
    JointType.PRISMATIC: (52, 211, 153),
}
_INERTIA_STYLE = Style((94, 200, 235), opacity=0.4, shadow=False)
_COM_STYLE = Style((235, 87, 120), opacity=0.85, shadow=False)
_LEAD_KG_M3 = 11_340.0
_THINNEST_M = 1e-3
Nodes: TypeAlias = "dict[str, Node]"
"""By name below the link's node, parents first."""
_GROUPS: Final = frozenset({"visual", "collision"})


@lru_cache(maxsize=1 << 12)  # an edit turns few of the shapes that it draws
def wxyz_from_rpy(rpy_rad: Vector3) -> Quaternion:
    """Unit quaternion of fixed-axis roll, pitch, yaw; angles that are no numbers count as 0."""
    roll, pitch, yaw = (angle if math.isfinite(angle) else 0.0 for angle in rpy_rad)
    return rotations.wxyz_from_rpy(roll, pitch, yaw)


def wxyz_and_position(origin: Origin) -> tuple[Quaternion, Vector3]:
    """Return the pose of an `<origin>`."""
    return wxyz_from_rpy(origin.rpy), origin.xyz


def wxyz_and_translation(a_from_b: NDArray[np.float64]) -> tuple[Quaternion, Vector3]:
    """Return the pose of a matrix (4, 4)."""
    w, x, y, z = wxyz_from_matrices(a_from_b[:3, :3]).tolist()
    at_x, at_y, at_z = a_from_b[:3, 3].tolist()
    return (w, x, y, z), (at_x, at_y, at_z)


class MeshShelf:
    """The loaded meshes by URI; None for one that cannot be loaded."""

    def __init__(self) -> None:
        self._meshes: dict[str, LoadedMesh | None] = {}

    def __contains__(self, uri: str) -> bool:
        return uri in self._meshes

    def get(self, uri: str) -> LoadedMesh | None:
        """Return the mesh, or None when it failed or is not loaded yet."""
        return self._meshes.get(uri)

    def put(self, uri: str, mesh: LoadedMesh | None) -> bool:
        """Keep a mesh; return whether that changes what is drawn."""
        old, came = self._meshes.get(uri), uri in self._meshes
        self._meshes[uri] = mesh
        if not came or old is None or mesh is None:
            return not (came and old is mesh)
        return old.digest != mesh.digest

    def keep_only(self, uris: set[str]) -> None:
        """Forget the meshes that no robot names any more."""
        self._meshes = {uri: mesh for uri, mesh in self._meshes.items() if uri in uris}


def style_of(material: Material | None, robot: Robot) -> Style:
    """Colour of a visual: its own, else that of the material of the same name, else light grey."""
    rgba = material.rgba if material else None
    if material is not None and rgba is None and material.name in robot.materials:
        rgba = robot.materials[material.name].rgba
    return Style(DEFAULT_RGB) if rgba is None else _style_of_rgba(rgba)


@lru_cache(maxsize=1 << 10)
def _style_of_rgba(rgba: tuple[float, float, float, float]) -> Style:
    red, green, blue, alpha = (min(max(channel, 0.0), 1.0) for channel in rgba)
    return Style((round(red * 255), round(green * 255), round(blue * 255)), alpha)


def geometry_node(
    geometry: Geometry,
    origin: Origin,
    style: Style,
    shelf: MeshShelf,
    *,
    own_colors: bool = True,
) -> Node | None:
    """Return the node of one geometry, or None while its mesh is not loaded.

    Args:
        geometry: What to draw.
        origin: Its pose in the link.
        style: Colour, unless the mesh has its own and `own_colors` lets it.
        shelf: The loaded meshes.
        own_colors: Materials of a mesh file win over `style`, as in RViz.
    """
    wxyz, at = wxyz_and_position(origin)
    match geometry:
        case Box():
            return node.box(geometry.size_m, style, wxyz, at)
        case Cylinder():
            return node.cylinder(geometry.radius_m, geometry.length_m, style, wxyz, at)
        case Sphere():
            return node.sphere(geometry.radius_m, style, wxyz, at)
        case Mesh():
            return _draw_mesh(geometry, origin, style, shelf, own_colors=own_colors)


def _draw_mesh(
    geometry: Mesh, origin: Origin, style: Style, shelf: MeshShelf, *, own_colors: bool
) -> Node | None:
    if geometry.uri not in shelf:
        return None
    wxyz, at = wxyz_and_position(origin)
    loaded = shelf.get(geometry.uri)
    if loaded is None:
        return node.box(MISSING_SIZE_M, MISSING_STYLE, wxyz, at)
    if loaded.glb and own_colors:
        return node.colored_mesh(loaded, geometry.scale, wxyz, at)
    return node.mesh(loaded, geometry.scale, style, wxyz, at)


@dataclass(frozen=True, slots=True)
class LinkContext:
    """What a layer draws from: the link, the joint that moves it, the robot and its meshes."""

    link: Link
    joint: Joint | None
    robot: Robot
    shelf: MeshShelf
    rgb: Rgb | None = None
    """Of all visuals; None: their own colours."""


def visual_nodes(context: LinkContext) -> Nodes:
    """Return the visuals of the link."""
    nodes: Nodes = {"visual": node.group()}
    for index, visual in enumerate(context.link.visuals):
        if drawn := _visual_node(visual, context):
            nodes[f"visual/{index}"] = drawn
    return nodes


def _visual_node(visual: Visual, context: LinkContext) -> Node | None:
    """Return a visual with its image, if any; until that comes, in its material's colour."""
    geometry, origin, material = visual.geometry, visual.origin, visual.material
    if context.rgb is not None:
        style = Style(context.rgb, shadow=False)
        return geometry_node(geometry, origin, style, context.shelf, own_colors=False)
    if material is not None and material.texture_uri:
        textured = context.shelf.get(textured_uri(geometry, material))
        if textured is not None:
            return node.colored_mesh(textured, scale_of(geometry), *wxyz_and_position(origin))
    return geometry_node(geometry, origin, style_of(material, context.robot), context.shelf)


def collision_nodes(context: LinkContext) -> Nodes:
    """Return the collision shapes of the link, see-through."""
    nodes: Nodes = {"collision": node.group()}
    for index, collision in enumerate(context.link.collisions):
        drawn = geometry_node(
            collision.geometry, collision.origin, COLLISION_STYLE, context.shelf, own_colors=False
        )
        if drawn:
            nodes[f"collision/{index}"] = drawn
    return nodes


def frame_nodes(_: LinkContext) -> Nodes:
    """Return the frame of the link."""
    return {"frame": node.axes(FRAME_LENGTH_M)}


def name_nodes(context: LinkContext) -> Nodes:
    """Return the link's name at its origin."""
    return {"name": node.label(context.link.name)}


def axis_nodes(context: LinkContext) -> Nodes:
    """Return the axis that the link turns about or slides along, from its origin."""
    joint = context.joint
    if joint is None or joint.type not in _AXIS_RGB:
        return {}
    tip = _lengthened(joint.axis, AXIS_LENGTH_M)
    return {"axis": node.arrow((0.0, 0.0, 0.0), tip, _AXIS_RGB[joint.type])} if tip else {}


def inertia_nodes(context: LinkContext) -> Nodes:
    """Return the box of even density that turns as the link does."""
    found = inertia_box(context.link)
    if found is None:
        return {}
    x, y, z = (max(float(side), _THINNEST_M) for side in found.size_m)
    wxyz, at = wxyz_and_translation(found.link_from_box)
    return {"inertia": node.box((x, y, z), _INERTIA_STYLE, wxyz, at)}


def com_nodes(context: LinkContext) -> Nodes:
    """Return the centre of mass, as a ball of lead of the link's mass, as RViz draws it."""
    found = inertia_box(context.link)
    if found is None:
        return {}
    radius_m = (3 * found.mass_kg / (4 * math.pi * _LEAD_KG_M3)) ** (1 / 3)
    _, at = wxyz_and_translation(found.link_from_box)
    return {"com": node.sphere(radius_m, _COM_STYLE, node.NO_TURN, at)}


def _lengthened(axis: Vector3, length_m: float) -> Vector3 | None:
    size = sum(part * part for part in axis) ** 0.5
    if not 0.0 < size < float("inf"):
        return None
    return (axis[0] / size * length_m, axis[1] / size * length_m, axis[2] / size * length_m)


LAYERS: dict[str, Callable[[LinkContext], Nodes]] = {
    "visual": visual_nodes,
    "collision": collision_nodes,
    "frames": frame_nodes,
    "names": name_nodes,
    "axes": axis_nodes,
    "inertia": inertia_nodes,
    "com": com_nodes,
}
"""By the name of the display setting that switches it."""


def link_nodes(shape: LinkParts, shelf: MeshShelf) -> dict[str, Node]:
    """Return all nodes of a link, flat; meshes that are not loaded yet are left out."""
    context = LinkContext(shape.link, None, shape.robot, shelf, shape.rgb)
    shown = {
        "visual": shape.visual,
        "collision": shape.collision,
        "com": shape.mass,
        "inertia": shape.inertia,
    }
    nodes: dict[str, Node] = {}
    for layer in (name for name, is_shown in shown.items() if is_shown):
        for below, drawn in LAYERS[layer](context).items():
            if below not in _GROUPS:
                nodes[below.replace("/", "-")] = _faded(drawn, shape.opacity)
    return nodes


def _faded(drawn: Node, opacity: float) -> Node:
    """Multiply the opacity of a node; the page itself fades a mesh with its own materials."""
    if "opacity" not in drawn.props:
        return replace(drawn, props={**drawn.props, "studio_opacity": opacity})
    own = drawn.props["opacity"]
    both = opacity if own is None else own * opacity
    return replace(drawn, props={**drawn.props, "opacity": None if both >= 1.0 else both})
