"""A robot and where its joints are now, as displays and frames take the document's own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from studio.robot.kinematics import Floats, Kinematics
    from studio.robot.values import Robot


class JointState(Protocol):
    """Positions of a robot's joints."""

    @property
    def values(self) -> Floats:
        """Positions of the movable joints in order, rad or m; a new array after each motion."""
        ...

    def by_name(self) -> dict[str, float]:
        """Return the same, by the joints' names."""
        ...


class PosedRobot(Protocol):
    """A robot and its joint positions."""

    @property
    def robot(self) -> Robot:
        """Its links and joints."""
        ...

    @property
    def kinematics(self) -> Kinematics:
        """Forward kinematics of this robot; a new object with each robot."""
        ...

    @property
    def joints(self) -> JointState:
        """Its joint positions."""
        ...
