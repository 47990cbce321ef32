"""What the page receives of the robot of a document: its tree, and the joint positions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from studio.protocol.robot import JointPositions, JointView, LinkView, RobotState
from studio.robot.values import JointType, Mesh

if TYPE_CHECKING:
    from studio.description.values import Part
    from studio.documents.model import Model
    from studio.protocol.listeners import Audience
    from studio.robot.assembly import Assembly
    from studio.robot.values import Joint, Link, Robot

_LIMITED = frozenset({JointType.REVOLUTE, JointType.PRISMATIC})


class RobotView:
    """Tells the audience of a robot; keeps the views of links and joints that stay the same.

    Attributes:
        animating: Whether the joints swing.
    """

    def __init__(self, model: Model, audience: Audience) -> None:
        self._model, self._audience = model, audience
        self.animating = False
        self._links: dict[str, tuple[Link, Part | None, LinkView]] = {}
        self._joints: dict[str, tuple[Joint, Part | None, JointView]] = {}
        self._robot_sent: RobotState | None = None
        self._joints_sent: JointPositions | None = None

    def send(self) -> bool:
        """Send the robot's tree and its joint positions, as far as they changed.

        Returns:
            Whether the tree is another one.
        """
        robot, joints = self.robot_event(), self.joints_event()
        is_new = robot != self._robot_sent
        if is_new:
            self._robot_sent, self._joints_sent = robot, None
            self._audience.send(robot)
        if joints != self._joints_sent:
            self._audience.send(joints)
        self._joints_sent = joints
        return is_new

    def send_positions(self) -> None:
        """Send the joint positions, by name."""
        self._audience.send(self.joints_event())

    def send_joints(self) -> None:
        """Send the positions packed; a slow page gets the newest only."""
        frame = self._model.joints.frame(self._model.revision)
        self._audience.post(frame, binary=True, key="joints")

    def robot_event(self) -> RobotState:
        """Return the robot's tree with the place where each part was written."""
        model, robot = self._model, self._model.robot
        return RobotState.model_construct(
            revision=model.revision,
            name=robot.name,
            root=robot.root,
            links=self._link_views(robot, model.assembly),
            joints=self._joint_views(robot, model),
        )

    def joints_event(self) -> JointPositions:
        """Return the joint positions by name."""
        return JointPositions(positions=self._model.joints.by_name(), animating=self.animating)

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
