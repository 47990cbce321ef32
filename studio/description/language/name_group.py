"""Definitions and readers of a name that belong together: all are renamed, or none.

Names of xacro are looked up at run time: a macro reads what its caller has. Where the run evaluated
a reader its meaning is known; elsewhere it is found from the text, and marked as uncertain.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.references import Spot, attribute_value, macro_around, meant_by
from studio.description.language.uses import Chain
from studio.description.language.words import XACRO_TAGS
from studio.description.syntax.params import read_parameters
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.description.language.definitions import Definitions
    from studio.description.language.references import UsesBook
    from studio.description.language.uses import Use
    from studio.description.syntax.source_tree import SourceElement

_OUTWARD = frozenset({"parent", "global"})


@dataclass(frozen=True, slots=True)
class Read:
    """A place that reads a name, and the definitions that it means or may mean.

    A definition is the element of a property, or of the macro whose parameter it is.
    """

    spot: Spot
    element: SourceElement
    means: frozenset[SourceElement]


class NameGroup:
    """A property, block or parameter of one name: `members` define it."""

    def __init__(
        self,
        name: str,
        elements: Iterable[SourceElement],
        definitions: Definitions,
        book: UsesBook,
    ) -> None:
        self.name, self._definitions, self._book = name, definitions, book
        self.members = self._grown(frozenset(elements))

    def reads(self) -> Iterator[Read]:
        """Yield the readers of the group.

        Raises:
            EditError: One reads something else as well, or may.
        """
        for read in self.all_reads:
            if read.means <= self.members and read.means:
                yield read
            elif read.means & self.members:
                tree, element = read.spot.file, read.element
                raise EditError(
                    f"{tree}:{element.line} may read another {self.name} as well: rename it "
                    "there by hand first."
                )

    @cached_property
    def all_reads(self) -> tuple[Read, ...]:
        """Every reader of the name, whatever it means."""
        trees = self._definitions.trace.trees.values()
        return (
            *(read for tree in trees for use in self._book.of(tree) for read in self._of_use(use)),
            *self._inserts(),
        )

    @cached_property
    def properties(self) -> frozenset[SourceElement]:
        """Every property of the name."""
        return frozenset(self._definitions.named("xacro:property", self.name))

    @cached_property
    def macros(self) -> frozenset[SourceElement]:
        """Every macro with a parameter of the name."""
        macros = (element for _, element in self._definitions.macros)
        return frozenset(one for one in macros if has_parameter(one, self.name))

    def _grown(self, members: frozenset[SourceElement]) -> frozenset[SourceElement]:
        """With all that shares a scope or a reader with them; a reader of both kinds joins none."""
        mine = self.properties if members & self.properties else self.macros
        while True:
            grown = members | {one for one in mine if self._shares_home(one, members)}
            for read in self.all_reads:
                if read.means & grown:
                    grown |= read.means & mine
            grown |= self._called_together(grown)
            if grown == members:
                return members
            members = grown

    def _shares_home(self, one: SourceElement, members: frozenset[SourceElement]) -> bool:
        if one in self.macros:
            return False
        home = self.home_of(one)
        return any(home is None or self.home_of(other) in {home, None} for other in members)

    def _called_together(self, members: frozenset[SourceElement]) -> frozenset[SourceElement]:
        """Macros that one and the same element calls, now this one and now that."""
        if not members & self.macros:
            return frozenset()
        called = (set(one) & self.macros for one in self._definitions.called.values())
        return frozenset(macro for those in called if those & members for macro in those)

    def home_of(self, one: SourceElement) -> object:
        """Return a property's scope: a macro, or files of the same namespaces; None: unknown."""
        macro = macro_around(one)
        if macro is None:
            return self._definitions.namespaces_of(one.tree.path)
        return None if one.attributes.get("scope") in _OUTWARD else macro

    def _of_use(self, use: Use) -> Iterator[Read]:
        if use.command or use.chain is None or use.chain.is_local:
            return
        for step, one in enumerate(use.chain.steps, 1):
            if one.key != self.name:
                continue
            found = meant_by(use, Chain(use.chain.steps[:step]), self._definitions)
            means = [element for each in found for element in self._defining(each.elements)]
            if not found:
                means = self._candidates(use.element, use.chain, step)
            spot = Spot(
                use.element.tree.path, use.starts[step - 1], use.ends[step - 1], bool(found)
            )
            yield Read(spot, use.element, frozenset(means))

    def _defining(self, elements: Iterable[SourceElement]) -> Iterator[SourceElement]:
        """Properties as they are; of what a call gave, the macros that it called."""
        for element in elements:
            if element in self.properties or element.tag == "xacro:macro":
                yield element
            else:
                called = self._definitions.called.get(element, ())
                yield from (one for one in called if one in self.macros)

    def _inserts(self) -> Iterator[Read]:
        """Yield where a block of the name is inserted."""
        for tree in self._definitions.trace.trees.values():
            for element in tree.elements:
                if element.tag != "xacro:insert_block":
                    continue
                if element.attributes.get("name") == self.name:
                    means = frozenset(self._visible(element))
                    yield from (
                        Read(spot, element, means) for spot in attribute_value(element, "name")
                    )

    def _candidates(
        self, element: SourceElement, chain: Chain, step: int
    ) -> Iterable[SourceElement]:
        """Return what a reader may mean that the run did not evaluate."""
        if step == 1:
            return self._visible(element)
        before = str(chain.steps[step - 2].key)
        inside = (one for one in self.properties if macro_around(one) is None)
        return [one for one in inside if self._is_in(one, before)]

    def _is_in(self, one: SourceElement, namespace: str) -> bool:
        spaces = self._definitions.namespaces_of(one.tree.path)
        return any(namespace in space.split(".") for space in spaces)

    def _visible(self, element: SourceElement) -> set[SourceElement]:
        """Return what a name may mean at an element: its macro's own, else files' and callers'."""
        macro = macro_around(element)
        if macro is not None and (own := self._own(macro)):
            return own
        found = {one for one in self.properties if self._is_seen_from(element, one)}
        if macro is not None:
            for caller in self._above(macro):
                found |= self._own(caller)
        return found

    def _is_seen_from(self, element: SourceElement, one: SourceElement) -> bool:
        home = self.home_of(one)
        if home is None:
            return True
        return macro_around(one) is None and not self._is_apart(home, element)

    def _is_apart(self, home: object, element: SourceElement) -> bool:
        """Whether a file sees another's names only behind their namespace."""
        return home != self._definitions.namespaces_of(element.tree.path) and home != {""}

    def _own(self, macro: SourceElement) -> set[SourceElement]:
        if macro in self.macros:
            return {macro}
        return {one for one in self.properties if self.home_of(one) is macro}

    def _above(self, macro: SourceElement) -> set[SourceElement]:
        """Macros whose bodies call it, at whatever depth."""
        found: set[SourceElement] = set()
        front = [macro]
        while front:
            for caller in self._callers.get(front.pop(), ()):
                if caller not in found:
                    found.add(caller)
                    front.append(caller)
        return found

    @cached_property
    def _callers(self) -> dict[SourceElement, set[SourceElement]]:
        """Return, by macro, those whose bodies name it."""
        by_name = self._definitions.macros_by_name
        found: dict[SourceElement, set[SourceElement]] = {}
        for tree in self._definitions.trace.trees.values():
            for element in tree.elements:
                name = called_name(element)
                caller = macro_around(element) if name else None
                if caller is None:
                    continue
                for macro in self._definitions.called.get(element) or by_name.get(name, ()):
                    found.setdefault(macro, set()).add(caller)
        return found


def has_parameter(macro: SourceElement, name: str) -> bool:
    """Whether a macro takes a parameter of a name, with or without stars."""
    names, _ = read_parameters(macro.attributes.get("params", ""))
    return any(one.lstrip("*") == name for one in names)


def called_name(element: SourceElement) -> str:
    """Return the macro that an element calls, as it is written; empty: it is no call."""
    own = element.xacro_name
    if own is None or own in XACRO_TAGS:
        return element.attributes.get("macro", "") if own == "call" else ""
    return own


def is_name_group(kind: Kind) -> bool:
    """Whether what is named is found through scopes."""
    return kind in {Kind.PROPERTY, Kind.PARAMETER, Kind.BLOCK}
