"""The definitions in the files of a watched run, by name, with their comments."""

from __future__ import annotations

import re
from functools import cached_property
from typing import TYPE_CHECKING, Final

from studio.description.language.questions import Parameter
from studio.description.language.subject import printed
from studio.description.syntax.attribute_spans import attribute_spans, character_offsets
from studio.description.syntax.params import name_in_params, read_parameters
from studio.description.syntax.source_tree import SourceComment, SourceText
from studio.description.syntax.templates import Cut
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.language.watched_run import Included, Trace
    from studio.description.syntax.params import Default
    from studio.description.syntax.source_tree import SourceElement

_VALUES = frozenset({"xacro:property", "xacro:arg"})
_PARTS = frozenset({"link", "joint"})
_LENGTH: Final = 2_000
_MARKUP: Final = re.compile(r"<\s*/?[A-Za-z][^>]*>")
_LICENCE: Final = re.compile(r"copyright|licen[sc]e|all rights reserved", re.IGNORECASE)
_RULE: Final = re.compile(r"[=*#~_+/|-]{3,}")
_LIST_MARK: Final = re.compile(r"^[-*@\s]*(?:param(?:eter)?\s+)?")


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
        """Return the properties or args of a name."""
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
        """Return what came out of each element of a source."""
        found: dict[SourceElement, list[OutputElement]] = {}
        for one in self.trace.root.walk():
            found.setdefault(one.origin, []).append(one)
        return found

    def written_out(self, element: SourceElement, attribute: str) -> tuple[str, ...]:
        """Return what an attribute came out as, each text once."""
        outputs = self.outputs.get(element, ())
        texts = (one.attributes.get(attribute) for one in outputs)
        return tuple(dict.fromkeys(text for text in texts if text is not None))

    def namespaces_of(self, file: str) -> frozenset[str]:
        """Return the prefixes of a file's names; for the entry and most others: ``."""
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
        """Return the namespace of an include; empty without one."""
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


def parameter_bytes(macro: SourceElement, name: str) -> tuple[int, int] | None:
    """Return the bytes of a parameter's name in its macro, without stars; None: it has none."""
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


def documentation_of(element: SourceElement) -> str:
    """Return comments right above an element, without rules, licences and old code."""
    text = "\n".join(filter(None, (_plain(one) for one in _comments_above(element))))
    return text if len(text) <= _LENGTH else text[: _LENGTH - 1] + "…"


def _comments_above(element: SourceElement) -> list[str]:
    siblings = element.parent.children if element.parent else []
    lines: list[list[str]] = [[]]
    for sibling in reversed(siblings[: _index(element)]):
        if isinstance(sibling, SourceComment):
            lines[0].insert(0, sibling.text)
        elif not isinstance(sibling, SourceText):
            # A comment behind another element on its line speaks of that one.
            lines[0].clear()
            break
        elif not _joins(sibling.text):
            break
        elif "\n" in sibling.text:
            lines.insert(0, [])
    return [comment for line in lines for comment in line]


def _index(element: SourceElement) -> int:
    siblings = element.parent.children if element.parent else []
    return next((at for at, one in enumerate(siblings) if one is element), 0)


def _joins(text: str) -> bool:
    """Whether a text between a comment and an element lets them belong together."""
    return not text.strip() and text.count("\n") <= 1


def _plain(comment: str) -> str:
    if _MARKUP.search(comment) or _LICENCE.search(comment):
        return ""
    lines = (_RULE.sub("", line).strip() for line in comment.splitlines())
    return "\n".join(line for line in lines if line)


def parameter_documentation(documentation: str, name: str) -> str:
    """Return the documentation of one parameter: the line of the macro's that begins with it."""
    for line in re.split(r"\n|;", documentation):
        text = _LIST_MARK.sub("", line)
        rest = text.removeprefix(name)
        if rest != text and (found := re.match(r"\s*(?:\([^)]*\)\s*)?[:=\u2013-]\s*(.+)", rest)):
            return found[1].strip()
    return ""
