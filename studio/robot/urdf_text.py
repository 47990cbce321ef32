"""URDF text, read as strictly as ROS takes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.values import Part
from studio.errors import RobotError
from studio.problems import Place, Severity
from studio.robot.assembly import Assembly
from studio.robot.xml_tree import parse_tree, plain_element

if TYPE_CHECKING:
    from collections.abc import Iterator
    from xml.etree import ElementTree

    from studio.robot.values import Robot

_KINDS = ("link", "joint", "material")


def robot_from_urdf(text: str) -> Robot:
    """Read an expanded URDF.

    Raises:
        RobotError: It is no robot, or ROS would reject it; the sentence names the first fault.
    """
    root = parse_tree(text)
    if root.tag != "robot":
        raise RobotError(f"It begins with <{root.tag}> and not with <robot>: it is no URDF.")
    parts = tuple(_parts(root))
    change = Assembly(root.get("name", "")).apply(tuple(part.key for part in parts), parts)
    for problem in change.problems:
        if problem.severity is Severity.ERROR:
            raise RobotError(problem.sentence)
    return change.robot


def _parts(root: ElementTree.Element) -> Iterator[Part]:
    """Yield the elements under their keys; a repeated name gets a number behind it."""
    seen: dict[str, int] = {}
    for element in root:
        if element.tag in _KINDS:
            key = f"{element.tag}:{element.get('name', '')}"
            seen[key] = seen.get(key, 0) + 1
            numbered = key if seen[key] == 1 else f"{key}#{seen[key]}"
            yield Part(numbered, plain_element(element), Place(""))
