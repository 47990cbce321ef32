"""What the page is told of a robot and its sites: plain values made from those of the rooms."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.engine.messages import JointView, LinkView, RobotState, SiteView
from studio.robot.values import Joint, JointType, Link, Mesh

if TYPE_CHECKING:
    from studio.description.values import Part, Site
    from studio.engine.model import Model
    from studio.robot.assembly import Assembly

_LIMITED = frozenset({JointType.REVOLUTE, JointType.PRISMATIC})


def robot_state(model: Model) -> RobotState:
    """The robot's tree with the place where each part was written."""
    robot, assembly = model.robot, model.assembly
    axes = dict(zip(model.kinematics.movable, model.kinematics.axes.tolist(), strict=True))
    return RobotState(
        revision=model.revision,
        name=robot.name,
        root=_root(model),
        links=tuple(_link_view(link, assembly) for link in robot.links.values()),
        joints=tuple(
            _joint_view(joint, axes.get(joint.name, [1.0, 0.0, 0.0]), assembly)
            for joint in robot.joints.values()
        ),
    )


def site_view(site: Site, saved_text: str | None, argument: str | None) -> SiteView:
    """One site as its row shows it."""
    return SiteView(
        id=site.id,
        kind=site.kind,
        name=site.name,
        file=site.place.file,
        line=site.place.line,
        text=site.text,
        saved_text=saved_text,
        value=site.value,
        number=site.number,
        values=site.values,
        reads=site.reads,
        widget=site.widget,
        group=site.group,
        owner=site.owner,
        argument=argument,
    )


def _root(model: Model) -> str:
    children = {joint.child for joint in model.robot.joints.values()}
    return next((name for name in model.robot.links if name not in children), "")


def _link_view(link: Link, assembly: Assembly) -> LinkView:
    part = assembly.part(f"link:{link.name}")
    shapes = (*link.visuals, *link.collisions)
    meshes = (shape.geometry.uri for shape in shapes if isinstance(shape.geometry, Mesh))
    return LinkView(
        name=link.name,
        visuals=len(link.visuals),
        collisions=len(link.collisions),
        mass_kg=link.inertial.mass_kg if link.inertial else None,
        meshes=tuple(dict.fromkeys(meshes)),
        file=part.place.file if part else "",
        line=part.place.line if part else 0,
        macros=_macros(part),
    )


def _joint_view(joint: Joint, axis: list[float], assembly: Assembly) -> JointView:
    part = assembly.part(f"joint:{joint.name}")
    limit = joint.limit if joint.type in _LIMITED else None
    return JointView(
        name=joint.name,
        type=joint.type.value,
        parent=joint.parent,
        child=joint.child,
        axis=(axis[0], axis[1], axis[2]),
        lower=limit.lower if limit else None,
        upper=limit.upper if limit else None,
        mimic=joint.mimic.joint if joint.mimic else "",
        multiplier=joint.mimic.multiplier if joint.mimic else 1.0,
        file=part.place.file if part else "",
        line=part.place.line if part else 0,
    )


def _macros(part: Part | None) -> tuple[str, ...]:
    return tuple(call.macro for call in part.calls) if part else ()
