"""URDF text: read as strictly as ROS takes it, and written from the parts of a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from studio.description.values import Part
from studio.errors import RobotError
from studio.problems import Place, Severity
from studio.robot.assembly import Assembly
from studio.robot.xml_tree import parse_tree, plain_element

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.description.elements import Element
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
    """Return the elements under their keys; a repeated name gets a number behind it."""
    seen: dict[str, int] = {}
    for element in root:
        if element.tag in _KINDS:
            key = f"{element.tag}:{element.get('name', '')}"
            seen[key] = seen.get(key, 0) + 1
            numbered = key if seen[key] == 1 else f"{key}#{seen[key]}"
            yield Part(numbered, plain_element(element), Place(""))


def urdf_text(parts: Iterable[Part], root_attributes: Iterable[tuple[str, str]]) -> str:
    """A robot of these parts as URDF text, one indented element after the other.

    May run in any thread; a large robot takes some time.
    """
    root = ElementTree.Element("robot", dict(root_attributes))
    root.extend(part_element(part, root.attrib) for part in parts)
    ElementTree.indent(root)
    return '<?xml version="1.0" ?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def part_element(part: Part, root_attributes: Mapping[str, str]) -> ElementTree.Element:
    """A part as an element of a robot, with its prefixes as written.

    A part declares its prefixes itself, to stand alone; what the root declares is not repeated.
    """
    element = _tree_of(part.element)
    for name in [one for one in element.attrib if one.startswith("xmlns:")]:
        if root_attributes.get(name) == element.get(name):
            del element.attrib[name]
    return element


def _tree_of(element: Element) -> ElementTree.Element:
    builder = ElementTree.TreeBuilder()
    _build(element, builder)
    return builder.close()


def _build(element: Element, builder: ElementTree.TreeBuilder) -> None:
    builder.start(element.tag, dict(element.attributes))
    for child in element.children:
        if isinstance(child, str):
            builder.data(child)
        else:
            _build(child, builder)
    builder.end(element.tag)
