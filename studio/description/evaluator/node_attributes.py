"""Attributes of xacro's own elements: a missing one is a fault, an unknown one a warning."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from studio.description.expressions.guarded_operations import text_of
from studio.description.faults import Fault, shorten

if TYPE_CHECKING:
    from studio.description.evaluator.output_tree import Node, OutputElement
    from studio.description.evaluator.texts import Texts


_XML_NAME: Final = re.compile(r"[^\W\d][\w.\-]*(?::[^\W\d][\w.\-]*)?")


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


def xml_name(node: Node, value: Any, *, written: bool = True) -> str:  # noqa: ANN401
    """What the name of an element or attribute came to; `written` when it comes out.

    Raises:
        Fault: It is no text (where xacro fails as well), or XML does not allow it as a name.
    """
    if value == "":
        raise Fault("empty-name", f"{node.tag} came to an empty name.")
    if not isinstance(value, str) or (written and not _XML_NAME.fullmatch(value)):
        sentence = f'<{node.tag}> came to the name "{text_of(value)}", which is no XML name.'
        raise Fault("bad-name", shorten(sentence, 300))
    return value


def attribute_text(name: str, value: Any) -> str:  # noqa: ANN401
    """The value of an `xacro:attribute` that comes out.

    Raises:
        Fault: It is a number or list, which xacro fails to write.
    """
    if not isinstance(value, str):
        shown = shorten(text_of(value), 40)
        sentence = (
            f'<xacro:attribute name="{name}"> came to {shown}, which xacro cannot write: '
            "make it a text with ${str(...)}."
        )
        raise Fault("attribute-not-text", sentence)
    return value
