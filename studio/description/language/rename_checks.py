"""Why a name may not be given: it is no name, it is taken, or nobody can say what would read it."""

from __future__ import annotations

import keyword
import re
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.macros import read_parameters
from studio.description.language.name_group import NameGroup, called_name
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.references import macro_around
from studio.description.language.rename_spots import own_name
from studio.description.language.words import XACRO_TAGS
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.language.definitions import Definitions
    from studio.description.language.references import UsesBook
    from studio.description.syntax.source_tree import SourceElement

NAME_LIMIT: Final = 200
_IDENTIFIER: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_TAG: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")
_PIECES: Final = re.compile(r"\$\{[^}]*\}|\$\([^)]*\)")


def check_spelling(kind: Kind, old: str, new: str) -> None:
    """Refuse what is no name of its kind.

    Raises:
        EditError: It is none, or the one that it has.
    """
    pattern = _TAG if kind is Kind.MACRO else _IDENTIFIER
    if not pattern.fullmatch(new) or len(new) > NAME_LIMIT:
        letters = "letters, digits, - and _" if kind is Kind.MACRO else "letters, digits and _"
        raise EditError(f"{new!r} is no name: use {letters}, beginning with a letter or _.")
    if new == old:
        raise EditError(f"It is called {old} already: type another name.")
    is_word = keyword.iskeyword(new) if kind is not Kind.MACRO else new in XACRO_TAGS
    if is_word:
        raise EditError(f"{new} is a word of the language itself: choose another name.")


def check_group(group: NameGroup, new: str, definitions: Definitions, book: UsesBook) -> None:
    """Refuse a name that another property or parameter has where the group is read or defined.

    Raises:
        EditError: It is taken, or a reader of it would read the group.
    """
    if new in definitions.trace.scope.run.symbols:
        raise EditError(f"Every expression knows {new} already: choose another name.")
    _refuse_built(_built(definitions), group.name, new)
    _refuse_forwarded(group.name, definitions)
    _refuse_forwarded(new, definitions)
    other = NameGroup(new, (), definitions, book)
    homes = _homes(group)
    for one in (*other.properties, *other.macros):
        macro = one if one in other.macros else macro_around(one)
        if macro is None or macro in homes:
            raise _taken(new, one)
    for read in other.all_reads:
        macro = macro_around(read.element)
        if macro in homes or (None in homes and macro is None):
            raise _taken(new, read.element)


def _homes(group: NameGroup) -> set[SourceElement | None]:
    """The macros in which a group is defined or read; None: outside of all."""
    homes = {one if one.tag == "xacro:macro" else macro_around(one) for one in group.members}
    return homes | {macro_around(read.element) for read in group.reads()}


def check_arg(name: str, new: str, definitions: Definitions, book: UsesBook) -> None:
    """Refuse a name that another arg has, or that somebody asks for.

    Raises:
        EditError: It is taken.
    """
    if not definitions.named("xacro:arg", name):
        raise EditError(f"{name} is declared in no file of this robot.")
    _refuse_built(_built(definitions), name, new)
    for element in definitions.named("xacro:arg", new):
        raise _taken(new, element)
    for tree in definitions.trace.trees.values():
        for use in book.of(tree):
            if use.command == "arg" and ("$" in use.name or use.name == new):
                raise _taken(new, use.element)
            if use.command == "eval" and use.name == new:
                raise _taken(new, use.element)


def check_macro(name: str, new: str, definitions: Definitions) -> None:
    """Refuse a name that another macro has, or that is called already.

    Raises:
        EditError: It is taken, or calls are made by expressions.
    """
    _refuse_built(_built(definitions), name, new)
    for _, macro in definitions.macros:
        if own_name(macro) == new:
            raise _taken(new, macro)
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            if called_name(element).rpartition(".")[2] == new:
                raise _taken(new, element)


def _taken(new: str, element: SourceElement) -> EditError:
    return EditError(
        f"{new} is a name already, at {element.tree.path}:{element.line}: choose another one."
    )


def _built(definitions: Definitions) -> Iterator[tuple[SourceElement, str]]:
    """The names that are made by expressions, as they are written."""
    for tree in definitions.trace.trees.values():
        for element in tree.elements:
            own = element.xacro_name
            if own not in {"property", "arg", "macro", "insert_block", "call"}:
                continue
            text = element.attributes.get("macro" if own == "call" else "name", "")
            if "$" in text:
                yield element, text


def _refuse_built(built: Iterator[tuple[SourceElement, str]], *names: str) -> None:
    for element, text in built:
        pieces = _PIECES.split(text)
        for name in names:
            if _may_be(name, pieces):
                raise EditError(
                    f"{element.tree.path}:{element.line} makes a name by an expression, {text}: it "
                    f"may be {name}, so nobody can vouch for the renaming."
                )


def _may_be(name: str, pieces: list[str]) -> bool:
    """Whether a name is these pieces in their order, with anything between them."""
    first, last = pieces[0], pieces[-1]
    if not name.startswith(first) or not name.endswith(last):
        return False
    at, end = len(first), len(name) - len(last)
    for piece in pieces[1:-1]:
        found = name.find(piece, at, end)
        if found < 0:
            return False
        at = found + len(piece)
    return at <= end


def _refuse_forwarded(name: str, definitions: Definitions) -> None:
    """A parameter with `:=^` takes what its caller has under the same name."""
    for _, macro in definitions.macros:
        _, defaults = read_parameters(macro.attributes.get("params", ""))
        if name in defaults and defaults[name].forward:
            raise EditError(
                f"{macro.tree.path}:{macro.line} takes {name} over from its caller by name (:=^): "
                "give it there by hand first."
            )
