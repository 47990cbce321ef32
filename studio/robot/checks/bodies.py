"""Rigid bodies: links that fixed joints hold together move, and weigh, as one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.robot.values import JointType

if TYPE_CHECKING:
    from studio.robot.values import Joint, Link, Robot


@dataclass(frozen=True, slots=True)
class Body:
    """Links that move as one, the one nearest to the root first; `mover` is None for a root's."""

    links: tuple[Link, ...]
    mover: Joint | None


def rigid_bodies(robot: Robot) -> list[Body]:
    """Every link of the robot in exactly one body; joints in a cycle belong to none."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint)
    held = {joint.child for joint in robot.joints.values()}
    waiting: list[tuple[str, Joint | None]] = [(n, None) for n in robot.links if n not in held]
    found: list[Body] = []
    while waiting:
        first, mover = waiting.pop(0)
        names = [first]
        for name in names:  # grows while it is gone through
            for joint in children.get(name, ()):
                if joint.type is JointType.FIXED:
                    names.append(joint.child)
                else:
                    waiting.append((joint.child, joint))
        found.append(Body(tuple(robot.links[one] for one in names), mover))
    return found
