"""LinkParts: what a display shows of one link of a robot, in the frame of the link."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from studio.robot.textured import mesh_uris

if TYPE_CHECKING:
    from studio.robot.values import Link, Robot


@dataclass(frozen=True, slots=True, eq=False)
class LinkParts:
    """A link as it looks, touches and weighs.

    Attributes:
        link: What it is made of.
        robot: Whose link it is: materials are named there.
        visual: Whether its looks are shown.
        collision: Whether its collision shapes are.
        mass: Whether its mass is, as a ball of lead.
        inertia: Whether its inertia is, as a box.
        opacity: 1 is opaque.
    """

    link: Link
    robot: Robot
    visual: bool = True
    collision: bool = False
    mass: bool = False
    inertia: bool = False
    opacity: float = 1.0

    def mesh_uris(self) -> frozenset[str]:
        """Of the files that it is drawn with."""
        drawn = self.link if self.visual else replace(self.link, visuals=())
        return frozenset(mesh_uris(drawn, collisions=self.collision))


def frame_of(link: str, tf_prefix: str) -> str:
    """The frame of a link on /tf; as in RViz a slash stands between it and a prefix."""
    prefix = tf_prefix.strip("/")
    return f"{prefix}/{link}" if prefix else link
