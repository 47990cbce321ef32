"""What the page is told of a robot and its sites: plain values made from those of the rooms."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from studio.protocol.edits import SiteView
from studio.protocol.robot import JointView, LinkView, RobotState
from studio.robot.values import JointType, Mesh

if TYPE_CHECKING:
    from studio.description.values import Part, Site
    from studio.documents.model import Model
    from studio.robot.assembly import Assembly
    from studio.robot.values import Joint, Link, Robot

_LIMITED = frozenset({JointType.REVOLUTE, JointType.PRISMATIC})


class RobotViews:
    """Makes the state of a robot for the page; of what stayed the same it keeps the views."""

    def __init__(self) -> None:
        self._links: dict[str, tuple[Link, Part | None, LinkView]] = {}
        self._joints: dict[str, tuple[Joint, Part | None, JointView]] = {}

    def state(self, model: Model) -> RobotState:
        """The robot's tree with the place where each part was written."""
        robot = model.robot
        return RobotState.model_construct(
            revision=model.revision,
            name=robot.name,
            root=robot.root,
            links=self._link_views(robot, model.assembly),
            joints=self._joint_views(robot, model),
        )

    def _link_views(self, robot: Robot, assembly: Assembly) -> tuple[LinkView, ...]:
        before, self._links = self._links, {}
        for name, link in robot.links.items():
            part = assembly.part(f"link:{name}")
            known = before.get(name)
            if known is None or known[0] is not link or known[1] is not part:
                known = link, part, _link_view(link, part)
            self._links[name] = known
        return tuple(view for _, _, view in self._links.values())

    def _joint_views(self, robot: Robot, model: Model) -> tuple[JointView, ...]:
        before, self._joints = self._joints, {}
        for name, joint in robot.joints.items():
            part = model.assembly.part(f"joint:{name}")
            known = before.get(name)
            if known is None or known[0] is not joint or known[1] is not part:
                known = joint, part, _joint_view(joint, model.kinematics.axis_of(name), part)
            self._joints[name] = known
        return tuple(view for _, _, view in self._joints.values())


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


def _link_view(link: Link, part: Part | None) -> LinkView:
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


def _joint_view(joint: Joint, axis: tuple[float, float, float], part: Part | None) -> JointView:
    limit = joint.limit if joint.type in _LIMITED else None
    lower, upper = limit.bounds if limit else (-math.inf, math.inf)
    return JointView(
        name=joint.name,
        type=joint.type.value,
        parent=joint.parent,
        child=joint.child,
        axis=axis,
        lower=lower if math.isfinite(lower) else None,
        upper=upper if math.isfinite(upper) else None,
        mimic=joint.mimic.joint if joint.mimic else "",
        multiplier=joint.mimic.multiplier if joint.mimic else 1.0,
        file=part.place.file if part else "",
        line=part.place.line if part else 0,
    )


def _macros(part: Part | None) -> tuple[str, ...]:
    return tuple(call.macro for call in part.calls) if part else ()
