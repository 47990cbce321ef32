"""Expansions with the comments that come out, ours and stock's, in one comparable form."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias
from xml.dom import minidom

from studio.description.evaluator.output_tree import OutputElement
from studio.description.evaluator.source_store import SourceStore
from studio.description.syntax.source_tree import SourceComment
from studio.packages.roots import ServedRoots
from tests.support.commented_evaluation import CommentedEvaluation

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.values import ReadPolicy

Commented: TypeAlias = "tuple[str, tuple[tuple[str, str], ...], tuple[Commented | str, ...]]"
"""Tag, sorted attributes, children: blanks do not count, comments begin with `<!--`."""


def commented_run(
    file: str, policy: ReadPolicy, arguments: Mapping[str, str] | None = None
) -> Commented:
    """Our expansion with comments; a Fault when there is none."""
    store = SourceStore(ServedRoots([Path(root) for root in policy.roots]), {})
    root = CommentedEvaluation(store, policy, arguments or {}).run(file)
    return _of_output(root)


def _of_output(element: OutputElement) -> Commented:
    children: list[Commented | str] = []
    for child in element.children:
        if isinstance(child, OutputElement):
            children.append(_of_output(child))
        elif isinstance(child, SourceComment):
            children.append(f"<!--{child.text}-->")
        else:
            _add_text(children, child.text)
    return element.tag, tuple(sorted(element.attributes.items())), tuple(children)


def commented_xml(text: str) -> Commented:
    """XML text in comparable form."""
    root = minidom.parseString(text).documentElement
    assert root is not None
    return _commented(root)


def _commented(element: minidom.Element) -> Commented:
    children: list[Commented | str] = []
    for child in element.childNodes:
        if isinstance(child, minidom.Element):
            children.append(_commented(child))
        elif isinstance(child, minidom.Comment):
            children.append(f"<!--{child.data}-->")
        elif isinstance(child, minidom.Text):
            _add_text(children, child.data)
    return element.tagName, tuple(sorted(element.attributes.items())), tuple(children)


def _add_text(children: list[Commented | str], text: str) -> None:
    solid = "".join(text.split())
    last = children[-1] if children else None
    if solid and isinstance(last, str) and not last.startswith("<!--"):
        children[-1] = last + solid
    elif solid:
        children.append(solid)
