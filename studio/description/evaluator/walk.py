"""Walk source trees and evaluate them into output: elements, attributes, texts, comments.

Nothing is changed in place, so sources are parsed once and evaluated often. Where xacro evaluates
a text twice, or an attribute without effect, that is done here too: it decides errors. The elements
of xacro itself are in `evaluation` and `macros`.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.evaluator.graph import Argument, Binding, Role
from studio.description.evaluator.output_tree import OutputElement, macro_calls
from studio.description.evaluator.texts import Texts, literal_value
from studio.description.expressions.bounds import Budget, Limits
from studio.description.expressions.guards import text_of
from studio.description.faults import Fault, shorten
from studio.description.syntax.source_tree import SourceComment, SourceElement, SourceText

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.graph import Cell, Scope
    from studio.description.evaluator.macros import MacroTable
    from studio.description.evaluator.output_tree import CallFrame, ChildNode, Node
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.values import ReadPolicy, SiteKind
    from studio.problems import Place

EVALUATE_COMMENTS: Final = "xacro:eval-comments"
_XML_NAME: Final = re.compile(r"[^\W\d][\w.\-]*(?::[^\W\d][\w.\-]*)?")


class Plan:
    """Attributes and children that count.

    `attributes` are those to evaluate, without xacro's own; when none holds a `$`, `fixed` is what
    they come to. Blank text is left out, comments too unless some are to be evaluated.
    """

    __slots__ = ("attributes", "children", "fixed")

    def __init__(self, node: Node) -> None:
        self.attributes = [
            (name, text) for name, text in node.attributes.items() if not name.startswith("xacro:")
        ]
        self.fixed: dict[str, str] | None = None
        if not any("$" in text for _, text in self.attributes):
            self.fixed = dict(self.attributes)
            self.fixed.pop("xmlns:xacro", None)
        children = cast("list[ChildNode]", node.children)
        comments = any(_is_about_comments(child) for child in children)
        self.children = [child for child in children if _counts(child, comments=comments)]


def _counts(child: ChildNode, *, comments: bool) -> bool:
    if isinstance(child, SourceText):
        return child.literal or not child.text.isspace()
    return comments or not isinstance(child, SourceComment)


def _is_about_comments(child: ChildNode) -> bool:
    return isinstance(child, SourceComment) and EVALUATE_COMMENTS in child.text


def plan_of(node: Node) -> Plan:
    """Return the plan of a node; kept with source elements."""
    if not isinstance(node, SourceElement):
        return Plan(node)
    if node.plan is None:
        node.plan = Plan(node)
    return cast("Plan", node.plan)


class Walk(ABC):
    """The state of one run: `frame` is the current macro call, `path` the tags around it."""

    def __init__(
        self,
        store: SourceStore,
        policy: ReadPolicy,
        arguments: Mapping[str, str],
        limits: Limits | None = None,
    ) -> None:
        self.store = store
        self.budget = Budget(limits or Limits())
        self.texts = Texts(store, policy, self.budget)
        self.texts.arguments = {
            name: Argument(name, text, is_given=True) for name, text in arguments.items()
        }
        self.frame: CallFrame | None = None
        self.path = ""
        self.bindings: dict[tuple[SourceElement, str, str], Binding] = {}
        self.includes: dict[tuple[str, str], None] = {}
        self.included_at: dict[str, Place] = {}

    def explain(self, fault: Fault) -> Fault:
        """Give a fault the place, include chain and macro stack of this moment."""
        self.texts.locate(fault)
        if fault.place is not None:
            fault.include_chain = self.chain_to(fault.place.file)
        fault.macro_stack = macro_calls(self.frame)
        return fault

    def chain_to(self, file: str) -> tuple[Place, ...]:
        """Return where a file was included, and the files that include it, the outermost first."""
        chain: list[Place] = []
        while file in self.included_at and len(chain) < 100:
            chain.append(self.included_at[file])
            file = chain[-1].file
        return tuple(reversed(chain))

    def source(self, path: str) -> SourceElement:
        """Return the root of a file; what is written there gives the run its time and room.

        Raises:
            Fault: It cannot be read.
        """
        tree = self.store.tree(path)
        self.budget.source(tree.path, len(tree.data))
        return tree.root

    def binding(
        self, kind: SiteKind | None, name: str, element: SourceElement, attribute: str, text: str
    ) -> Binding:
        """Return the one binding for a named text of a source element."""
        key = (element, attribute, name)
        found = self.bindings.get(key)
        if found is None:
            found = self.bindings[key] = Binding(kind, name, element, attribute, text)
        return found

    def attributes(self, node: Node, made: OutputElement, scope: Scope) -> None:
        """Evaluate a node's attributes into `made`; those of xacro itself are left out."""
        plan = plan_of(node)
        if isinstance(node, OutputElement):
            _share_records(node, made)
        values = plan.fixed
        if values is None:
            values = {
                name: text if "$" not in text else self._attribute(name, text, made, scope)
                for name, text in plan.attributes
            }
            values.pop("xmlns:xacro", None)
        made.attributes = {**made.attributes, **values} if made.attributes else values

    def _attribute(self, name: str, text: str, made: OutputElement, scope: Scope) -> str:
        record = self.texts.evaluated(text, scope, [made], (self.path, name))
        if type(record.value) is not str:
            record.value = text_of(record.value)
        made.made(name, record)
        return record.value

    def echo_attributes(self, node: Node, scope: Scope) -> dict[str, str]:
        """Evaluate attributes that xacro evaluates without using them: for errors and xmlns."""
        plan = plan_of(node)
        if plan.fixed is not None:
            return plan.fixed
        values = {n: text_of(self.texts.echoed(text, scope)) for n, text in plan.attributes}
        values.pop("xmlns:xacro", None)
        return values

    def children(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate all children of a node into `out`."""
        comments = False
        for child in plan_of(node).children:
            if isinstance(child, SourceText):
                comments &= not self._text(child, out, scope)
            elif isinstance(child, SourceComment):
                comments = self._comment(child, scope, on=comments)
            else:
                comments = False
                self.element(child, out, macros, scope)

    def element(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate one element into `out`."""
        tag = node.tag
        if not tag.startswith("xacro:"):
            self.ordinary(node, out, macros, scope)
            return
        self.texts.at = node.origin
        self.xacro_element(node, out, macros, scope)

    @abstractmethod
    def xacro_element(
        self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
    ) -> None:
        """Carry out an element of xacro itself, or call the macro of its name."""

    def ordinary(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """An element of the robot itself."""
        self.budget.element()
        self.texts.at = node.origin
        made = OutputElement(node.tag, node.origin, self.frame)
        outer = self.path
        self.budget.nesting(outer)
        self.path = f"{outer}/{node.tag}" if outer else node.tag
        self.attributes(node, made, scope)
        if node.children:
            self.children(node, made, macros, scope)
        self.path = outer
        out.children.append(made)

    def _text(self, node: SourceText, out: OutputElement, scope: Scope) -> bool:
        """Evaluate a text; whether it is more than blanks."""
        if node.literal or "$" not in node.text:
            out.children.append(node)
            return not node.literal
        made = SourceText("")
        record = self.texts.evaluated(node.text, scope, made, (self.path, ""))
        made.text = record.value = text_of(record.value)
        out.children.append(made)
        return bool(made.text.strip())

    def _comment(self, node: SourceComment, scope: Scope, *, on: bool) -> bool:
        """Comments do not come out, but those that are evaluated can fail; whether more are."""
        if EVALUATE_COMMENTS in node.text:
            return f"{EVALUATE_COMMENTS}:off" not in node.text
        if on:
            self.texts.echoed(node.text, scope)
        return on


def _share_records(block: OutputElement, made: OutputElement) -> None:
    """Copy the makers of a block's attributes to each copy, unless evaluated again."""
    for name, record in block.makers.items():
        if "$" in block.attributes.get(name, ""):
            record.sink = Role.STRUCTURE
        elif isinstance(record.sink, list):
            record.sink.append(made)
        made.made(name, record)


def bound_cell(run: Walk, cell: Cell, text: str, scope: Scope) -> Cell:
    """Give a cell its value at once."""
    if "$" in text:
        run.texts.bind(cell, run.texts.evaluated(text, scope, cell))
    else:
        cell.value = literal_value(text)
    return cell


def warn_hidden(run: Walk, name: str) -> None:
    """Warn when a name hides one of xacro's own."""
    if name in run.texts.symbols:
        run.texts.warn("hides-builtin", f'"{name}" hides a name that xacro itself defines.')


def required(node: Node, *names: str) -> tuple[str, ...]:
    """Return the raw texts of attributes that must be there.

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
    """Return the name of an element or attribute; `written` when it comes out.

    Raises:
        Fault: It is no text (where xacro fails as well), or not allowed as a name in XML.
    """
    if value == "":
        raise Fault("empty-name", f"{node.tag} came to an empty name.")
    if not isinstance(value, str) or (written and not _XML_NAME.fullmatch(value)):
        sentence = f'<{node.tag}> came to the name "{text_of(value)}", which is no XML name.'
        raise Fault("bad-name", shorten(sentence, 300))
    return value


def attribute_text(name: str, value: Any) -> str:  # noqa: ANN401
    """Return the value of an `xacro:attribute` that comes out.

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
