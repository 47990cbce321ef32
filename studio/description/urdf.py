"""The URDF text of an expanded robot."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.description.elements import Element
    from studio.description.values import Part


def urdf_text(parts: Iterable[Part], root_attributes: Iterable[tuple[str, str]]) -> str:
    """Return a robot of these parts as URDF text, one indented element after the other.

    Thread-safe; a large robot takes some time.
    """
    root = ElementTree.Element("robot", dict(root_attributes))
    root.extend(part_element(part, root.attrib) for part in parts)
    ElementTree.indent(root)
    return '<?xml version="1.0" ?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def part_element(part: Part, root_attributes: Mapping[str, str]) -> ElementTree.Element:
    """Return a part as an element of a robot, with its prefixes as written.

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
