"""The places that name an arg, a macro, or a parameter in the calls of its macro, byte by byte."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from xml.parsers import expat

from studio.description.language.name_group import called_name, has_parameter
from studio.description.language.references import Spot, attribute_name, attribute_value
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.description.language.definitions import Definitions
    from studio.description.language.references import UsesBook
    from studio.description.language.uses import Use
    from studio.description.syntax.source_tree import SourceElement, SourceTree

_CALLED = re.compile(rb"\s*\(")
_GIVEN = re.compile(rb"\s*\(\s*(?:'([^']*)'|\"([^\"]*)\"|&quot;(.*?)&quot;|&apos;(.*?)&apos;)\s*\)")


def arg_spots(name: str, definitions: Definitions, book: UsesBook) -> Iterator[Spot]:
    """The declarations of an arg, `$(arg name)`, its name in `$(eval ...)`, `arg('name')`.

    Raises:
        EditError: `arg(...)` is called with what is no plain text.
    """
    for element in definitions.named("xacro:arg", name):
        yield from attribute_value(element, "name")
    for tree in definitions.trace.trees.values():
        for use in book.of(tree):
            if use.command in {"arg", "eval"} and use.name == name:
                yield Spot(tree.path, use.starts[0], use.ends[0])
            yield from _asked_for(tree, use, name)


def _asked_for(tree: SourceTree, use: Use, name: str) -> Iterator[Spot]:
    """The text in `arg('name')` and `xacro.arg('name')`."""
    if use.chain is None or use.chain.steps[-1].key != "arg":
        return
    if not _CALLED.match(tree.data, use.ends[-1]):  # of `$(arg name)`
        return
    found = _GIVEN.match(tree.data, use.ends[-1])
    if found is None:
        raise EditError(
            f"{tree.path}:{use.element.line} makes the name of an arg by an expression: it may be "
            f"{name}, so rename by hand."
        )
    assert found.lastindex is not None
    if found[found.lastindex] == name.encode():
        yield Spot(tree.path, *found.span(found.lastindex))


def macro_spots(
    name: str, elements: Iterable[SourceElement], definitions: Definitions
) -> Iterator[Spot]:
    """The definitions of a macro and its calls, opening and closing tags.

    Raises:
        EditError: A call may mean another macro of that name as well.
    """
    members = same_macros(name, elements, definitions)
    if not members:
        raise EditError(f"{name} is defined in no file of this robot.")
    for element in members:
        yield from attribute_value(element, "name")
    for tree in definitions.trace.trees.values():
        calls = [one for one in tree.elements if _calls(one, name, members, definitions)]
        closings = closing_names(tree) if calls else {}
        for call in calls:
            in_run = call in definitions.called
            if call.tag == "xacro:call":
                yield from attribute_value(call, "macro")
                continue
            start = call.offset + 1
            yield Spot(tree.path, start, start + len(call.tag.encode(tree.encoding)), in_run)
            if call.offset in closings:
                yield Spot(tree.path, *closings[call.offset], in_run)


def same_macros(
    name: str, elements: Iterable[SourceElement], definitions: Definitions
) -> frozenset[SourceElement]:
    """All macros that are told apart by nothing: of one name, in files of the same namespaces."""
    alike = {e for _, e in definitions.macros if own_name(e) == name}
    homes = {definitions.namespaces_of(one.tree.path) for one in set(elements) & alike}
    return frozenset(one for one in alike if definitions.namespaces_of(one.tree.path) in homes)


def own_name(macro: SourceElement) -> str:
    """The name of a macro as calls have it, without namespaces."""
    return macro.attributes.get("name", "").removeprefix("xacro:")


def _calls(
    element: SourceElement,
    name: str,
    members: frozenset[SourceElement],
    definitions: Definitions,
) -> bool:
    called = called_name(element)
    known = definitions.called.get(element)
    if not known and (called.rpartition(".")[2] != name or "$" in called):
        return False
    meant = frozenset(known or definitions.macros_by_name.get(called, ()))
    return _is_of(element, meant, members, name) if meant & members else False


def given_spots(
    name: str, members: frozenset[SourceElement], definitions: Definitions
) -> Iterator[Spot]:
    """The attributes of calls that give a parameter.

    Raises:
        EditError: A call may mean another macro as well.
    """
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            if name not in element.attributes or not (called := called_name(element)):
                continue
            known = definitions.called.get(element)
            meant = known or definitions.macros_by_name.get(called, ())
            taking = frozenset(one for one in meant if has_parameter(one, name))
            if taking & members and _is_of(element, taking, members, name):
                yield from attribute_name(element, name, in_run=bool(known))


def _is_of(
    element: SourceElement,
    meant: frozenset[SourceElement],
    members: frozenset[SourceElement],
    name: str,
) -> bool:
    if meant <= members:
        return True
    raise EditError(
        f"{element.tree.path}:{element.line} may call another macro with {name} as well: rename it "
        "there by hand first."
    )


def closing_names(tree: SourceTree) -> dict[int, tuple[int, int]]:
    """By the byte of each `<`, the bytes of the name in its closing tag; none for `<empty/>`."""
    found: dict[int, tuple[int, int]] = {}
    opened: list[int] = []
    parser = expat.ParserCreate(tree.encoding)

    def start(_tag: str, _attributes: dict[str, str]) -> None:
        opened.append(parser.CurrentByteIndex)

    def end(tag: str) -> None:
        at, begun = parser.CurrentByteIndex, opened.pop()
        if tree.data.startswith(b"</", at) and at != begun:
            found[begun] = at + 2, at + 2 + len(tag.encode(tree.encoding))

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(tree.data, True)  # noqa: FBT003 - expat's own way
    return found
