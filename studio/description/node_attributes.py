"""Attributes of xacro's own elements: a missing one is a fault, an unknown one a warning."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.faults import Fault

if TYPE_CHECKING:
    from studio.description.output_tree import Node, OutputElement
    from studio.description.texts import Texts


def required(node: Node, *names: str) -> tuple[str, ...]:
    """The raw texts of attributes that must be there.

    Raises:
        Fault: One is missing.
    """
    for name in names:
        if name not in node.attributes:
            raise Fault("missing-attribute", f'<{node.tag}> needs the attribute "{name}".')
    return tuple(node.attributes[name] for name in names)


def warn_unknown(texts: Texts, node: Node, *known: str) -> None:
    """Warn of attributes that xacro ignores here."""
    for name in node.attributes:
        if name not in known and not name.startswith("xmlns:"):
            texts.warn("unknown-attribute", f'<{node.tag}> does not know the attribute "{name}".')


def import_namespaces(texts: Texts, into: OutputElement, attributes: dict[str, str]) -> None:
    """Declare on an element the prefixes that a macro or an included file declares."""
    for name, value in attributes.items():
        if name.startswith("xmlns:"):
            if into.attributes.get(name, value) != value:
                texts.warn("namespace-conflict", f"{name} is declared twice with different URIs.")
            else:
                into.attributes = {**into.attributes, name: value}
