"""The expanded robot cut into its top-level elements, each as text of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.evaluator.output_tree import (
    OUTPUT_LIMIT,
    OutputElement,
    macro_calls,
    write_xml,
)
from studio.description.faults import Refusal
from studio.description.values import Part

if TYPE_CHECKING:
    from collections.abc import Mapping

_NAMED: Final = frozenset({"link", "joint", "material"})


def part_keys(root: OutputElement) -> list[tuple[str, OutputElement]]:
    """A key for each top-level element, in order, as `Part.key` says."""
    keyed: list[tuple[str, OutputElement]] = []
    used: dict[str, int] = {}
    others = 0
    for element in root.elements():
        name = element.attributes.get("name")
        if element.tag in _NAMED and name is not None:
            key = f"{element.tag}:{name}"
        else:
            key, others = f"other:{others}", others + 1
        count = used[key] = used.get(key, 0) + 1
        keyed.append((key if count == 1 else f"{key}#{count}", element))
    return keyed


class WrittenPart(NamedTuple):
    """A part as text; the rest of it is worked out by `part_of` when somebody asks."""

    key: str
    xml: str
    element: OutputElement


def write_parts(root: OutputElement) -> list[WrittenPart]:
    """Write each top-level element as XML that stands alone, prefixes declared.

    Raises:
        Refusal: All of them together are longer than OUTPUT_LIMIT.
    """
    prefixes = _prefixes(root)
    parts = [
        WrittenPart(key, _write(element, prefixes), element) for key, element in part_keys(root)
    ]
    if sum(len(part.xml) for part in parts) > OUTPUT_LIMIT:
        raise Refusal("output-too-large", "The robot comes to more text than can be shown.")
    return parts


def write_part(root: OutputElement, key: str, element: OutputElement) -> WrittenPart:
    """Write one of them."""
    return WrittenPart(key, _write(element, _prefixes(root)), element)


def _prefixes(root: OutputElement) -> dict[str, tuple[str, str]]:
    return {
        name[6:]: (name, value)
        for name, value in root.attributes.items()
        if name.startswith("xmlns:")
    }


def part_of(written: WrittenPart) -> Part:
    """A part with where it was written and the macro calls that led to it."""
    element = written.element
    return Part(written.key, written.xml, element.origin.place, macro_calls(element.calls))


def _write(element: OutputElement, prefixes: Mapping[str, tuple[str, str]]) -> str:
    xml = write_xml(element)
    declared = {
        name: value
        for prefix, (name, value) in prefixes.items()
        if f"{prefix}:" in xml and name not in element.attributes
    }
    return write_xml(element, declared) if declared else xml
