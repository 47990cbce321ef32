"""Where the files of a watched run define macros, properties, args, links and joints, by name."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.evaluator.macros import PARAMS_LIMIT, parameter, read_parameters
from studio.description.language.questions import Parameter, TextPlace
from studio.description.language.subject import printed
from studio.description.syntax.attribute_spans import attribute_spans, character_offsets
from studio.description.syntax.templates import Cut
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.macros import Default
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.language.reading import Reading
    from studio.description.language.watched_run import Included, Trace
    from studio.description.syntax.source_tree import SourceElement

_VALUES = frozenset({"xacro:property", "xacro:arg"})
_PARTS = frozenset({"link", "joint"})


class Definitions:
    """The definitions of one run."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    @cached_property
    def macros(self) -> list[tuple[str, SourceElement]]:
        """Every macro with each name that it can be called by, file by file, top to bottom."""
        found: list[tuple[str, SourceElement]] = []
        for file, tree in self.trace.trees.items():
            spaces = self._namespaces.get(file) or {"": None}
            for element in tree.elements:
                if element.tag == "xacro:macro" and (name := element.attributes.get("name")):
                    own = name.removeprefix("xacro:")
                    found += [(f"{space}{own}", element) for space in spaces]
        return found

    @cached_property
    def macros_by_name(self) -> dict[str, list[SourceElement]]:
        """Macros by the names that they can be called by."""
        found: dict[str, list[SourceElement]] = {}
        for name, element in self.macros:
            found.setdefault(name, []).append(element)
        return found

    @cached_property
    def values(self) -> list[SourceElement]:
        """Every property and arg that has a name, file by file, top to bottom."""
        trees = self.trace.trees.values()
        elements = (element for tree in trees for element in tree.elements)
        return [one for one in elements if one.tag in _VALUES and one.attributes.get("name")]

    def named(self, tag: str, name: str) -> list[SourceElement]:
        """The properties or args of a name."""
        return [one for one in self.values if one.tag == tag and one.attributes["name"] == name]

    @cached_property
    def parts(self) -> dict[tuple[str, str], OutputElement]:
        """Links and joints that came out, by tag and name."""
        return {
            (one.tag, one.attributes["name"]): one
            for one in reversed(list(self.trace.root.elements()))
            if one.tag in _PARTS and "name" in one.attributes
        }

    @cached_property
    def called(self) -> dict[SourceElement, list[SourceElement]]:
        """The macros that each element called."""
        found: dict[SourceElement, list[SourceElement]] = {}
        for macro, calls in self.trace.seen.calls.items():
            for call in calls:
                known = found.setdefault(call.element, [])
                if macro not in known:
                    known.append(macro)
        return found

    @cached_property
    def outputs(self) -> dict[SourceElement, list[OutputElement]]:
        """What came out of each element of a source."""
        found: dict[SourceElement, list[OutputElement]] = {}
        for one in self.trace.root.walk():
            found.setdefault(one.origin, []).append(one)
        return found

    def written_out(self, element: SourceElement, attribute: str) -> tuple[str, ...]:
        """What an attribute came out as, each text once."""
        outputs = self.outputs.get(element, ())
        texts = (one.attributes.get(attribute) for one in outputs)
        return tuple(dict.fromkeys(text for text in texts if text is not None))

    def namespaces_of(self, file: str) -> frozenset[str]:
        """The prefixes under which a file's names are read; the entry's and most others': ``."""
        return frozenset(self._namespaces.get(file) or {"": None})

    @cached_property
    def _namespaces(self) -> dict[str, dict[str, None]]:
        """The prefixes that the names of each included file have: `a.b.`, or nothing."""
        spaces: list[str] = []
        found: dict[str, dict[str, None]] = {self.trace.entry: {"": None}}
        for one in self.trace.seen.includes:
            around = spaces[one.inside] if one.inside >= 0 else ""
            own = self.namespace_of(one)
            spaces.append(f"{around}{own}." if own else around)
            found.setdefault(one.file, {})[spaces[-1]] = None
        return found

    def namespace_of(self, one: Included) -> str:
        """The namespace of an include; empty without one."""
        text = one.element.attributes.get("ns", "")
        if not text.startswith("${") or not text.endswith("}"):
            return text
        key = (one.element, Cut.EXPRESSION, text[2:-1])
        values = self.trace.seen.evaluated.get(key)
        return printed(values[0].value) if values else text


def parameters_of(text: str) -> tuple[Parameter, ...]:
    """Read `params` of a macro."""
    names, defaults = read_parameters(text)
    return tuple(_parameter(name, defaults) for name in names)


def _parameter(name: str, defaults: Mapping[str, Default]) -> Parameter:
    stars = len(name) - len(name.lstrip("*"))
    default = defaults.get(name)
    text = default.text if default else None
    forwards = default.forward if default else False
    kind = ("value", "block", "blocks")[min(stars, 2)]
    return Parameter(name.lstrip("*"), kind, text, forwards)


def place_of(reading: Reading, element: SourceElement, attribute: str = "name") -> TextPlace:
    """Where the text of an attribute stands; without one, where its element begins."""
    tree = element.tree
    try:
        span = attribute_spans(tree.data, element.offset).get(attribute)
    except EditError:
        span = None
    if span is None:
        return reading.place(tree.path, element.offset)
    return reading.place(tree.path, span.start, span.end)


def parameter_place(reading: Reading, macro: SourceElement, name: str) -> TextPlace:
    """Where a macro names its parameter."""
    named = parameter_bytes(macro, name)
    return reading.place(macro.tree.path, *named) if named else place_of(reading, macro)


def parameter_bytes(macro: SourceElement, name: str) -> tuple[int, int] | None:
    """The bytes with which a macro names its parameter, stars left out; None: it has none."""
    tree = macro.tree
    try:
        span = attribute_spans(tree.data, macro.offset)["params"]
        text, offsets = character_offsets(tree.data[span.start : span.end], tree.encoding)
    except (EditError, KeyError):
        return None
    at = name_in_params(text, name)
    if at < 0:
        return None
    return span.start + offsets[at], span.start + offsets[at + len(name)]


def name_in_params(text: str, name: str) -> int:
    """Where `params` names a parameter, its stars left out; -1 when it does not."""
    if len(text) > PARAMS_LIMIT:
        return -1
    at = 0
    while (rest := text[at:]).strip():
        found, _, behind = parameter(rest)
        if found.lstrip("*") == name:
            return at + len(rest) - len(rest.lstrip()) + len(found) - len(name)
        at = len(text) - len(behind)
    return -1
