"""The robot that a check gets, the findings it returns, and how a finding can be mended.

A file of this folder with a function `findings(checked: CheckedRobot) -> Iterator[Finding]` is a
check: `robot_checks` finds it by that name. Its `WHY` explains each of its codes to the user.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

from studio.robot.checks.extents import extents

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.description.elements import Element
    from studio.description.values import Part
    from studio.problems import Severity
    from studio.robot.checks.extents import Extent
    from studio.robot.measures import Bounds
    from studio.robot.values import Robot


@dataclass(frozen=True)
class CheckedRobot:
    """A robot as it is drawn, and what is known about its text and its meshes.

    Attributes:
        robot: As it is drawn.
        part: Returns the element of a part key as it was written.
        mesh_bounds: Returns the box of a mesh by its URI, unscaled; None while it is unknown.
        source: Returns the bytes of a file as it is edited now; None when it cannot be read.
    """

    robot: Robot
    part: Callable[[str], Part | None]
    mesh_bounds: Callable[[str], Bounds | None]
    source: Callable[[str], bytes | None]

    @cached_property
    def extents(self) -> Mapping[str, Extent]:
        """The boxes around each link, by its name."""
        return extents(self.robot.links.values(), self.mesh_bounds)

    def element(self, key: str) -> Element | None:
        """Return the element of a part by its key; None when it is not known."""
        part = self.part(key)
        return part.element if part else None


@dataclass(frozen=True, slots=True)
class SwapAttributes:
    """Exchange the texts of two attributes of a child element."""

    label: str
    tag: str
    one: str
    other: str


@dataclass(frozen=True, slots=True)
class SetAttributes:
    """Set attributes of elements below the part; missing ones are added.

    `path` names the tags from the part's element down, `*` is any. Of several elements there,
    `where` picks those that have an attribute with that text as written.
    """

    label: str
    path: tuple[str, ...]
    texts: tuple[tuple[str, str], ...]
    where: tuple[str, str] | None = None
    is_for_one: bool = False
    """The texts hold for this part alone: not in a macro, which may write others."""


@dataclass(frozen=True, slots=True)
class AddChild:
    """Add the element `xml` as the last child of the part's element."""

    label: str
    xml: str


@dataclass(frozen=True, slots=True)
class RemoveChild:
    """Remove the only child with that tag, with its content."""

    label: str
    tag: str


Mend: TypeAlias = SwapAttributes | SetAttributes | AddChild | RemoveChild


@dataclass(frozen=True, slots=True)
class Finding:
    """One fault of a part of the robot.

    `key` is the part (`link:<name>`, `joint:<name>`), empty for the robot as a whole; `others` are
    further parts involved.
    """

    severity: Severity
    code: str
    sentence: str
    key: str
    mend: Mend | None = None
    others: tuple[str, ...] = ()
