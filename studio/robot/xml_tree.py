"""XML text to a tree, safely: no entities, nothing fetched, prefixes left as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn
from xml.etree.ElementTree import TreeBuilder
from xml.parsers import expat

from studio.description.elements import Element as PlainElement
from studio.errors import RobotError

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_TEXT_BUFFER_BYTES = 1 << 20


def parse_tree(xml: str | bytes) -> Element:
    """Parse XML without namespaces: real URDF uses prefixes that are not declared.

    Raises:
        RobotError: Not well-formed, of unknown encoding, or it declares entities.
    """
    builder = TreeBuilder()
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.buffer_size = min(max(len(xml), 1), _TEXT_BUFFER_BYTES)
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = _refuse_entity
    try:
        parser.Parse(xml, True)  # noqa: FBT003 - expat takes no keyword
    except (expat.ExpatError, LookupError, ValueError) as error:
        raise RobotError(f"It is not well-formed XML ({error}).") from error
    return builder.close()


def plain_element(element: Element) -> PlainElement:
    """Return an element and all below it as a plain value; comments are left out."""
    children: list[PlainElement | str] = [element.text] if element.text else []
    for child in element:
        children.append(plain_element(child))
        if child.tail:
            children.append(child.tail)
    return PlainElement(element.tag, element.attrib, tuple(children))


def _refuse_entity(name: str, *_: object) -> NoReturn:
    raise RobotError(f'It declares the entity "{name}", which is not read: write its text out.')
