"""Layers of the robot: each says which nodes one link has in it, below the node of the link."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from studio.robot.masses import inertia_box
from studio.robot.meshes.textured import textured_uri
from studio.robot.values import JointType
from studio.scene import node
from studio.scene.geometry_drawing import COLLISION_LOOK, draw, look_of
from studio.scene.node import Look
from studio.scene.pose import wxyz_and_translation

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.robot.values import Joint, Link, Robot, Vector3
    from studio.scene.geometry_drawing import MeshShelf
    from studio.scene.node import Node, Rgb

FRAME_LENGTH_M = 0.1
AXIS_LENGTH_M = 0.18
_AXIS_RGB: dict[JointType, Rgb] = {
    JointType.REVOLUTE: (167, 139, 250),
    JointType.CONTINUOUS: (96, 165, 250),
    JointType.PRISMATIC: (52, 211, 153),
}

_INERTIA_LOOK = Look((94, 200, 235), opacity=0.4, shadow=False)
_COM_LOOK = Look((235, 87, 120), opacity=0.85, shadow=False)
_LEAD_KG_M3 = 11_340.0
_THINNEST_M = 1e-3

Nodes: TypeAlias = "dict[str, Node]"
"""By name below the link's node, parents first."""


@dataclass(frozen=True, slots=True)
class LinkContext:
    """What a layer may look at: the link, the joint that moves it, the robot and its meshes."""

    link: Link
    joint: Joint | None
    robot: Robot
    shelf: MeshShelf


def visual_nodes(context: LinkContext) -> Nodes:
    """What the link looks like."""
    nodes: Nodes = {"visual": node.group()}
    for index, visual in enumerate(context.link.visuals):
        look = look_of(visual.material, context.robot)
        texture = textured_uri(visual.geometry, visual.material)
        if drawn := draw(visual.geometry, visual.origin, look, context.shelf, texture=texture):
            nodes[f"visual/{index}"] = drawn
    return nodes


def collision_nodes(context: LinkContext) -> Nodes:
    """What the link touches with, see-through."""
    nodes: Nodes = {"collision": node.group()}
    for index, collision in enumerate(context.link.collisions):
        drawn = draw(
            collision.geometry, collision.origin, COLLISION_LOOK, context.shelf, own_colors=False
        )
        if drawn:
            nodes[f"collision/{index}"] = drawn
    return nodes


def frame_nodes(_: LinkContext) -> Nodes:
    """The frame of the link."""
    return {"frame": node.axes(FRAME_LENGTH_M)}


def name_nodes(context: LinkContext) -> Nodes:
    """The link's name at its origin."""
    return {"name": node.label(context.link.name)}


def axis_nodes(context: LinkContext) -> Nodes:
    """The axis that the link turns about or slides along, from its origin."""
    joint = context.joint
    if joint is None or joint.type not in _AXIS_RGB:
        return {}
    tip = _lengthened(joint.axis, AXIS_LENGTH_M)
    return {"axis": node.arrow((0.0, 0.0, 0.0), tip, _AXIS_RGB[joint.type])} if tip else {}


def inertia_nodes(context: LinkContext) -> Nodes:
    """The box of even density that turns as the link does."""
    found = inertia_box(context.link)
    if found is None:
        return {}
    x, y, z = (max(float(side), _THINNEST_M) for side in found.size_m)
    wxyz, at = wxyz_and_translation(found.link_from_box)
    return {"inertia": node.box((x, y, z), _INERTIA_LOOK, wxyz, at)}


def com_nodes(context: LinkContext) -> Nodes:
    """The centre of mass, as a ball of lead of the link's mass, as RViz draws it."""
    found = inertia_box(context.link)
    if found is None:
        return {}
    radius_m = (3 * found.mass_kg / (4 * math.pi * _LEAD_KG_M3)) ** (1 / 3)
    _, at = wxyz_and_translation(found.link_from_box)
    return {"com": node.sphere(radius_m, _COM_LOOK, node.NO_TURN, at)}


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
