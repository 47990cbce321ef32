"""The names that the texts of a file use, each with its bytes.

Chains such as `cfg['joint']['limit']` are read from the text as written, references such as `&lt;`
included, and from expressions that are not finished yet.
"""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.description.language.token_at import segments_in
from studio.description.syntax.attribute_spans import attribute_spans, character_offsets
from studio.description.syntax.source_tree import SourceText
from studio.description.values import Span
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.syntax.source_tree import SourceElement, SourceTree

Key: TypeAlias = str | int
_TOKEN: Final = re.compile(
    r"(?P<string>&quot;.*?(?:&quot;|$)|&apos;.*?(?:&apos;|$)|'[^']*'?|\"[^\"]*\"?)|&#?\w+;"
    r"|(?P<number>\d[\w.]*|\.\d\w*)|(?P<name>[^\W\d]\w*)|(?P<sign>\S)",
    re.DOTALL,
)
_LOOP: Final = re.compile(r"\bfor\s+([\w\s,()]+?)\s+in\b")
_WORD: Final = re.compile(r"[^\W\d]\w*")
_QUOTES: Final = ("&quot;", "&apos;", "'", '"')
_SUBSTITUTION: Final = re.compile(r"\s*(\w+)\s+(\S+)")
_NO_TEXT: Final = re.compile(rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_PACKAGE: Final = re.compile(r"(?:package|model)://([^/\s\"']+)")


@dataclass(frozen=True, slots=True)
class Step:
    """One name or key of a chain, and where it is: a key without its quotes."""

    key: Key
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Chain:
    """A name and what is read below it; `steps[0]` is the name itself."""

    steps: tuple[Step, ...]
    is_local: bool = False
    """The name of a loop inside the expression."""

    @property
    def base(self) -> str:
        """The name that it begins with."""
        return str(self.steps[0].key)

    @property
    def keys(self) -> tuple[Key, ...]:
        """The keys read below the name."""
        return tuple(step.key for step in self.steps[1:])

    def up_to(self, index: int) -> Chain | None:
        """Return the chain up to the step that a cursor is in; None when it is in none."""
        for count, step in enumerate(self.steps, 1):
            if step.start <= index <= step.end:
                return Chain(self.steps[:count], self.is_local)
        return None


@lru_cache(maxsize=8192)
def chains_of(text: str) -> tuple[Chain, ...]:
    """Return all chains of an expression, in order."""
    local = {name for loop in _LOOP.findall(text) for name in _WORD.findall(loop)}
    return tuple(
        Chain(steps, is_local=str(steps[0].key) in local) for steps in _chains(_tokens(text))
    )


def chain_at(text: str, index: int) -> Chain | None:
    """Return the chain under a cursor, up to the step that it is in."""
    found = (chain.up_to(index) for chain in chains_of(text))
    return next((chain for chain in found if chain is not None), None)


def string_at(text: str, index: int) -> Step | None:
    """Return the quoted text under a cursor."""
    for found in _tokens(text):
        if found.lastgroup == "string":
            step = _quoted(found)
            if step.start <= index <= step.end:
                return step
    return None


def _tokens(text: str) -> list[re.Match[str]]:
    return list(_TOKEN.finditer(text))


def _chains(tokens: list[re.Match[str]]) -> Iterator[tuple[Step, ...]]:
    position = 0
    while position < len(tokens):
        found = tokens[position]
        position += 1
        if found.lastgroup == "name" and not keyword.iskeyword(found[0]):
            steps = [Step(found[0], found.start(), found.end())]
            position = _read_steps(tokens, position, steps)
            yield tuple(steps)
        elif found[0] == ".":  # of a call or a bracket: no name of its own
            position += position < len(tokens) and tokens[position].lastgroup == "name"


def _read_steps(tokens: list[re.Match[str]], position: int, steps: list[Step]) -> int:
    """Add what is read below a name; where to go on."""
    while position + 1 < len(tokens):
        sign, inside = tokens[position], tokens[position + 1]
        if sign[0] == "." and inside.lastgroup == "name":
            steps.append(Step(inside[0], inside.start(), inside.end()))
            position += 2
        elif sign[0] == "[" and (step := _key(inside)) and _is(tokens, position + 2, "]"):
            steps.append(step)
            position += 3
        else:
            break
    return position


def _is(tokens: list[re.Match[str]], position: int, sign: str) -> bool:
    return position < len(tokens) and tokens[position][0] == sign


def _key(found: re.Match[str]) -> Step | None:
    if found.lastgroup == "string":
        return _quoted(found)
    if found.lastgroup == "number" and found[0].isdecimal() and len(found[0]) < 10:
        return Step(int(found[0]), found.start(), found.end())
    return None


def _quoted(found: re.Match[str]) -> Step:
    quote = next(one for one in _QUOTES if found[0].startswith(one))
    start = found.start() + len(quote)
    closed = found[0].endswith(quote) and len(found[0]) >= 2 * len(quote)
    end = found.end() - len(quote) if closed else found.end()
    return Step(found.string[start:end], start, end)


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
    """Return all uses of a file: in attributes, in the order of elements, then between tags."""
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
        for element, start, end in _contents(tree.root):
            yield from _of_value(tree, element, Span(start, end, ""))
    except EditError:
        return


def _contents(element: SourceElement) -> Iterator[tuple[SourceElement, int, int]]:
    """Yield the texts between tags that hold a `$`: the element around, and the bytes."""
    if element.closes_itself:
        return
    data, behind = element.tree.data, element.inside
    for child in element.elements():
        if b"$" in _NO_TEXT.sub(b"", data[behind : child.offset]):
            yield element, behind, child.offset
        yield from _contents(child)
        behind = child.end
    if b"$" in _NO_TEXT.sub(b"", data[behind : element.end_tag]):
        yield element, behind, element.end_tag


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
