"""One run: a source tree in, the tree of the robot out, by xacro 2.1.1's rules.

Nothing is changed in place, so sources are parsed once and evaluated often. Where xacro evaluates
a text twice, or evaluates an attribute that nobody sees, that is done here too: it decides errors.
"""

from __future__ import annotations

import re
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final, TypeAlias, cast

from studio.description.evaluator.calls import call_by_name, call_macro, insert_block
from studio.description.evaluator.declarations import define_arg, define_macro, define_property
from studio.description.evaluator.graph import Role
from studio.description.evaluator.includes import include
from studio.description.evaluator.macros import MacroTable
from studio.description.evaluator.node_attributes import (
    attribute_text,
    required,
    warn_unknown,
    xml_name,
)
from studio.description.evaluator.output_tree import CallFrame, OutputElement, macro_calls
from studio.description.evaluator.plans import EVALUATE_COMMENTS, plan_of
from studio.description.evaluator.run_record import Binding
from studio.description.evaluator.scopes import Scope, truth_of
from studio.description.evaluator.texts import Argument, Texts
from studio.description.expressions.budget import Budget, Limits
from studio.description.expressions.guarded_operations import MUTATING, text_of
from studio.description.faults import Fault, Refusal, Unsupported
from studio.description.syntax.source_tree import SourceComment, SourceElement, SourceText

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping

    from studio.description.evaluator.output_tree import Node, OutputChild
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.values import ReadPolicy, SiteKind
    from studio.problems import Place

RECURSION_LIMIT: Final = 8_000
"""Python frames; 200 macros inside each other need about 4,500."""
_MUTATES: Final = re.compile(rf"\.(?:{'|'.join(sorted(MUTATING))})\s*\(")


class Evaluation:
    """The state of one run. `frame` is the macro call under way, `path` the tags around it."""

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

    def run(self, entry: str) -> OutputElement:
        """Expand a file.

        Raises:
            Fault: It cannot be expanded; the fault has its place, include chain and macro stack.
            Refusal: It may not be.
            Unsupported: It cannot by us.
        """
        try:
            with deep_recursion():
                return self._root(entry)
        except RecursionError:
            raise self.explain(
                Refusal("nested-too-deep", "Macros or properties are nested too deeply.")
            ) from None
        except MemoryError:
            raise self.explain(
                Refusal("value-too-large", "The description needs too much memory.")
            ) from None
        except Fault as fault:
            raise self.explain(fault) from None
        except Exception as error:  # a construct that we did not think of; xacro may know it
            reason = f"{self.texts.at or entry}: {type(error).__name__}: {error}"
            raise Unsupported(reason) from error

    def explain(self, fault: Fault) -> Fault:
        """Give a fault the place, include chain and macro stack of this moment."""
        self.texts.locate(fault)
        if fault.place is not None:
            fault.include_chain = self.chain_to(fault.place.file)
        fault.macro_stack = macro_calls(self.frame)
        return fault

    def chain_to(self, file: str) -> tuple[Place, ...]:
        """Where a file was included, and the files that include it, the outermost first."""
        chain: list[Place] = []
        while file in self.included_at and len(chain) < 100:
            chain.append(self.included_at[file])
            file = chain[-1].file
        return tuple(reversed(chain))

    def _root(self, entry: str) -> OutputElement:
        self.texts.files.append(entry)
        root = self.source(entry)
        scope, macros = Scope(self.texts, None), MacroTable()
        self.texts.at = root
        out = OutputElement(root.tag, root, None)
        target = root.attributes.get("xacro:targetNamespace")
        if target:
            out.attributes = {"xmlns": text_of(self.texts.consumed(target, scope, ("", "xmlns")))}
        self.attributes(root, out, scope)
        self.children(root, out, macros, scope)
        return out

    def source(self, path: str) -> SourceElement:
        """The root of a file; what is written there gives the run its time and room.

        Raises:
            Fault: It cannot be read.
        """
        tree = self.store.tree(path)
        self.budget.source(tree.path, len(tree.data))
        return tree.root

    # What every kind of element needs

    def binding(
        self, kind: SiteKind | None, name: str, element: SourceElement, attribute: str, text: str
    ) -> Binding:
        """The one binding for a named text of a source element."""
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
        handler = _HANDLERS.get(tag)
        if handler is not None:
            handler(self, node, out, macros, scope)
        else:
            call_macro(self, node, out, macros, scope)

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
    """What made an attribute of a block makes that of each copy, unless it is evaluated again."""
    for name, record in block.makers.items():
        if "$" in block.attributes.get(name, ""):
            record.sink = Role.STRUCTURE
        elif isinstance(record.sink, list):
            record.sink.append(made)
        made.made(name, record)


_Handler: TypeAlias = "Callable[[Evaluation, Node, OutputElement, MacroTable, Scope], None]"


def _condition(
    run: Evaluation, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
) -> None:
    """`xacro:if` and `xacro:unless`. What is set on the element itself is lost, as in xacro."""
    (text,) = required(node, "value")
    warn_unknown(run.texts, node, "value")
    value = run.texts.consumed(text, scope, (node.tag, "value"), Role.CONDITION)
    if truth_of(value, text) == (node.tag == "xacro:unless"):
        return
    if len(node.attributes) > 1 or _MUTATES.search(text):
        run.echo_attributes(node, scope)
    sink = OutputElement(node.tag, node.origin, run.frame)
    run.children(node, sink, macros, scope)
    out.children += sink.children


def _renamed_element(
    run: Evaluation, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
) -> None:
    """`xacro:element`: evaluated again under the name that `xacro:name` comes to."""
    (text,) = required(node, "xacro:name")
    name = xml_name(node, run.texts.consumed(text, scope, (run.path, "xacro:name")))
    renamed = OutputElement(name, node.origin, run.frame)
    renamed.attributes = {n: t for n, t in node.attributes.items() if n != "xacro:name"}
    renamed.children = cast("list[OutputChild]", node.children)
    run.element(renamed, out, macros, scope)


def _set_attribute(
    run: Evaluation, node: Node, out: OutputElement, _macros: MacroTable, scope: Scope
) -> None:
    """`xacro:attribute`: set on what it stands in, which may be a thing that does not come out."""
    name_text, value_text = required(node, "name", "value")
    named = run.texts.consumed(name_text, scope, (run.path, name_text))
    record = run.texts.evaluated(value_text, scope, Role.STRUCTURE, (run.path, str(named)))
    name = xml_name(node, named, written=out.comes_out)
    if out.comes_out:
        out.attributes = {**out.attributes, name: attribute_text(name, record.value)}
        out.made(name, record)


_HANDLERS: Final[dict[str, _Handler]] = {
    "xacro:insert_block": insert_block,
    "xacro:include": include,
    "xacro:property": define_property,
    "xacro:macro": define_macro,
    "xacro:arg": define_arg,
    "xacro:element": _renamed_element,
    "xacro:attribute": _set_attribute,
    "xacro:if": _condition,
    "xacro:unless": _condition,
    "xacro:call": call_by_name,
}


@contextmanager
def deep_recursion() -> Generator[None]:
    """Let Python nest calls as deeply as a robot may nest its macros."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, RECURSION_LIMIT))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
