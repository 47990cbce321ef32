"""Every place in a file where an expression or substitution names something."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.name_chains import chains_of
from studio.description.language.token_at import segments_in, tags_before
from studio.description.syntax.attribute_spans import attribute_spans, character_offsets
from studio.description.syntax.source_tree import SourceText
from studio.description.values import Span
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.name_chains import Chain
    from studio.description.syntax.source_tree import SourceElement, SourceTree

_SUBSTITUTION: Final = re.compile(r"\s*(\w+)\s+(\S+)")
_NO_MARKUP: Final = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_PACKAGE: Final = re.compile(r"(?:package|model)://([^/\s\"']+)")


@dataclass(frozen=True, slots=True)
class Use:
    """A chain of names read at bytes of a file.

    `command` is empty in `${...}`; in `$(arg x)` it is `arg` and the chain is `x`; a name in
    `package://name/...` counts as `find`. `segment` is the text inside the braces.
    """

    element: SourceElement
    segment: str
    command: str
    chain: Chain | None
    name: str
    starts: tuple[int, ...]
    """First byte of each step of the chain; of `name` when there is no chain."""
    ends: tuple[int, ...]


def uses_in(tree: SourceTree) -> tuple[Use, ...]:
    """All uses of a file: in attributes, in the order of their elements, then between tags."""
    in_attributes = (use for element in tree.elements for use in _of_element(tree, element))
    return (*in_attributes, *_of_contents(tree))


def _of_element(tree: SourceTree, element: SourceElement) -> Iterator[Use]:
    if not any("$" in text or "://" in text for text in element.attributes.values()):
        return
    try:
        for span in attribute_spans(tree.data, element.offset).values():
            yield from _of_value(tree, element, span)
    except EditError:
        return


def _of_contents(tree: SourceTree) -> Iterator[Use]:
    texts = (child for one in tree.elements for child in one.children if type(child) is SourceText)
    if not any("$" in one.text and not one.literal for one in texts):
        return
    try:
        for element, start, end in _contents(tree):
            yield from _of_value(tree, element, Span(start, end, ""))
    except EditError:
        return


def _contents(tree: SourceTree) -> Iterator[tuple[SourceElement, int, int]]:
    """The texts between tags that hold a `$`: the element around, and the bytes."""
    # As many characters as bytes; what is no markup here keeps its length.
    text = _NO_MARKUP.sub(_blanked, tree.data.decode("latin-1"))
    elements = {one.offset: one for one in tree.elements}
    opened: list[SourceElement | None] = []
    behind = 0
    for tag, is_closing, is_empty in tags_before(text, len(text)):
        if opened and (around := opened[-1]) and "$" in text[behind : tag.start]:
            yield around, behind, tag.start
        behind = tag.end
        if is_closing:
            del opened[-1:]
        elif not is_empty:
            opened.append(elements.get(tag.start))


def _blanked(found: re.Match[str]) -> str:
    return " " * len(found[0])


def _of_value(tree: SourceTree, element: SourceElement, span: Span) -> Iterator[Use]:
    text, offsets = character_offsets(tree.data[span.start : span.end], tree.encoding)
    at = [span.start + offset for offset in offsets]
    for segment in segments_in(text, 0, len(text)):
        inside = text[segment.start : segment.end]
        here = at[segment.start :]
        if segment.is_expression:
            yield from _of_expression(element, inside, here)
        else:
            yield from _of_substitution(element, inside, here)
    for found in _PACKAGE.finditer(text):
        start, end = at[found.start(1)], at[found.end(1)]
        yield Use(element, "", "find", None, found[1], (start,), (end,))


def _of_expression(
    element: SourceElement, inside: str, at: list[int], command: str = "", skipped: int = 0
) -> Iterator[Use]:
    for chain in chains_of(inside[skipped:]):
        starts = tuple(at[step.start + skipped] for step in chain.steps)
        ends = tuple(at[step.end + skipped] for step in chain.steps)
        yield Use(element, inside, command, chain, chain.base, starts, ends)
    for nested in segments_in(inside, 0, len(inside)):
        if not nested.is_expression:
            text = inside[nested.start : nested.end]
            yield from _of_substitution(element, text, at[nested.start :])


def _of_substitution(element: SourceElement, inside: str, at: list[int]) -> Iterator[Use]:
    found = _SUBSTITUTION.match(inside)
    if found is None:
        return
    if found[1] == "eval":
        yield from _of_expression(element, inside, at, "eval", found.end(1))
        return
    starts, ends = (at[found.start(2)],), (at[found.end(2)],)
    yield Use(element, inside, found[1], None, found[2], starts, ends)
