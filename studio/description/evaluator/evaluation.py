"""Expand a description by xacro 2.1.1's rules: a source tree in, the tree of the robot out."""

from __future__ import annotations

import keyword
import re
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final, TypeAlias, cast

from studio.description.evaluator.calls import (
    call_by_name,
    call_macro,
    define_macro,
    insert_block,
)
from studio.description.evaluator.graph import Argument, Cell, Role, Scope, ScopeView
from studio.description.evaluator.macros import MacroTable
from studio.description.evaluator.output_tree import OutputElement
from studio.description.evaluator.texts import literal_value, truth_of
from studio.description.evaluator.walk import (
    Walk,
    attribute_text,
    bound_cell,
    import_namespaces,
    required,
    warn_hidden,
    warn_unknown,
    xml_name,
)
from studio.description.expressions.guards import MUTATING, text_of
from studio.description.faults import Fault, Refusal, Unsupported
from studio.description.syntax.source_tree import SourceElement
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.description.evaluator.output_tree import Node, OutputChild

RECURSION_LIMIT: Final = 8_000
"""Python frames; 200 macros inside each other need about 4,500."""
INCLUDE_DEPTH: Final = 64
"""Files inside files; the deepest robot of the corpus has 7."""
_MUTATES: Final = re.compile(rf"\.(?:{'|'.join(sorted(MUTATING))})\s*\(")
_MAGIC: Final = re.compile(r"[*[?]+")
_Handler: TypeAlias = "Callable[[Evaluation, Node, OutputElement, MacroTable, Scope], None]"


class Evaluation(Walk):
    """One run of an entry file."""

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

    def xacro_element(
        self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
    ) -> None:
        """Carry out an element of xacro itself, or call the macro of its name."""
        handler = _HANDLERS.get(node.tag)
        if handler is not None:
            handler(self, node, out, macros, scope)
        else:
            call_macro(self, node, out, macros, scope)


def define_property(
    run: Evaluation, node: Node, _out: OutputElement, _macros: MacroTable, scope: Scope
) -> None:
    """`xacro:property`: a value, a default, a block of elements, or the removal of a name."""
    texts = run.texts
    (name_text,) = required(node, "name")
    warn_unknown(texts, node, "name", "value", "default", "remove", "scope", "lazy_eval")
    name = text_of(texts.consumed(name_text, scope, ("xacro:property", "name")))
    _check_name(name)
    removes = _flag(run, node, "remove", scope, otherwise="false")
    if removes + ("value" in node.attributes) + ("default" in node.attributes) > 1:
        sentence = f'The property "{name}" may have only one of value, default and remove.'
        raise Fault("property-attributes", sentence)
    if removes and scope.has(name):
        scope.remove(name)
        _warn_kept(run, name)
        run.texts.is_pure = False  # texts evaluated before it cannot be evaluated again
        return
    if "default" in node.attributes:
        _warn_scope(run, node, name)
        if scope.has(name):
            return
    attribute = next((a for a in ("default", "value") if a in node.attributes), None)
    target, lazy = _target(run, node, name, scope)
    if attribute is None:
        target.cells[f"**{name}"] = Cell(f"**{name}", target, node)
        return
    _bind(run, node, attribute, name, target if lazy else (target, scope))


def _check_name(name: str) -> None:
    if name.startswith("__"):
        sentence = f'The property name "{name}" may not start with two underscores.'
        raise Fault("property-name", sentence)
    if not name.isidentifier() or keyword.iskeyword(name):
        sentence = f'The property name "{name}" must be a Python name: letters, digits and "_".'
        raise Fault("property-name", sentence)


def _flag(run: Evaluation, node: Node, attribute: str, scope: Scope, otherwise: str) -> bool:
    text = node.attributes.get(attribute)
    if not text:
        return otherwise == "true"
    value = run.texts.consumed(text, scope, ("xacro:property", attribute))
    return truth_of(value, text)


def _warn_kept(run: Evaluation, name: str) -> None:
    if name in run.texts.symbols:
        run.texts.warn("hides-builtin", f'"{name}" is a name of xacro itself: it stays defined.')


def _warn_scope(run: Evaluation, node: Node, name: str) -> None:
    if "scope" in node.attributes:
        sentence = f'"{name}" has a default and a scope: xacro means defaults for the local scope.'
        run.texts.warn("default-scope", sentence)


def _target(run: Evaluation, node: Node, name: str, scope: Scope) -> tuple[Scope, bool]:
    """Return the scope to bind in, and whether the text may wait for its first reader.

    Raises:
        Fault: It asks for the parent of the outermost scope, which ends xacro, too.
    """
    lazy = _flag(run, node, "lazy_eval", scope, otherwise="true")
    where = node.attributes.get("scope")
    if where == "global":
        return scope.top(), False
    if where != "parent":
        return scope, lazy
    target = scope.parent
    if target is None:
        sentence = f'"{name}" has no parent scope here: leave out scope="parent".'
        raise Fault("no-parent-scope", sentence)
    while target.is_namespace and not scope.is_namespace and target.parent is not None:
        target = target.parent
    return target, False


def _bind(
    run: Evaluation, node: Node, attribute: str, name: str, target: Scope | tuple[Scope, Scope]
) -> None:
    """Bind a text: lazily in a scope, or (where, evaluated in) at once."""
    text = node.attributes[attribute]
    binding = run.binding(SiteKind.PROPERTY, name, node.origin, attribute, text)
    if isinstance(target, tuple):
        where, evaluated_in = target
        cell = bound_cell(run, Cell(name, where, None, binding), text, evaluated_in)
        warn_hidden(run, name)
        where.cells[name] = cell
        return
    warn_hidden(run, name)
    value = literal_value(text)
    cell = target.cells[name] = Cell(name, target, value, binding, node.origin)
    if isinstance(value, str) and "$" in value:
        cell.pending = value
    else:
        cell.value = literal_value(value)  # xacro types the text again when it is first read


def define_arg(
    run: Evaluation, node: Node, _out: OutputElement, _macros: MacroTable, scope: Scope
) -> None:
    """`xacro:arg`: a value that the caller of xacro may give; the first declaration counts."""
    name, text = required(node, "name", "default")
    warn_unknown(run.texts, node, "name", "default")
    binding = run.binding(SiteKind.ARG, name, node.origin, "default", text)
    argument = run.texts.arguments.get(name)
    if argument is None:
        argument = Argument(name, text, is_given=False)
        argument.declared_by(binding)
        if "$" in text:
            argument.record = run.texts.evaluated(text, scope, argument)
            argument.value = text_of(argument.record.value)
        run.texts.arguments[name] = argument
    elif argument.binding is not binding:
        binding.overridden = True
    argument.declared_by(binding)


def include(
    run: Evaluation, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
) -> None:
    """Evaluate each file as if its content stood here."""
    (pattern,) = required(node, "filename")
    warn_unknown(run.texts, node, "filename", "ns", "optional")
    macros_in, scope_in = _namespace(run, node, macros, scope)
    optional = truth_of(node.attributes.get("optional"), node.attributes.get("optional"))
    if any(isinstance(child, SourceElement | OutputElement) for child in node.children):
        run.texts.warn("include-children", "Elements inside <xacro:include> are ignored.")
    included: list[OutputElement] = []
    for path in _files(run, pattern, scope):
        content = _include_one(run, node, path, (macros_in, scope_in), optional=optional)
        run.texts.at = node.origin
        if content is not None:
            included.append(content)
            import_namespaces(run.texts, out, content.attributes)
    for content in included:
        out.children += content.children


def _namespace(
    run: Evaluation, node: Node, macros: MacroTable, scope: Scope
) -> tuple[MacroTable, Scope]:
    text = node.attributes.get("ns")
    if not text:
        return macros, scope
    name = text_of(run.texts.consumed(text, scope, ("xacro:include", "ns")))
    macros_in, scope_in = MacroTable(), Scope(run.texts, scope, node.origin)
    macros.put(name, macros_in)
    warn_hidden(run, name)
    scope.cells[name] = Cell(name, scope, ScopeView(scope_in))
    return macros_in, scope_in


def _files(run: Evaluation, pattern: str, scope: Scope) -> list[str]:
    spec = text_of(run.texts.consumed(pattern, scope, ("xacro:include", "filename")))
    path = run.texts.absolute(spec)
    if not _MAGIC.search(path):
        return [path]
    found = run.store.glob(path)
    if not found:
        run.texts.warn("include-no-match", f'No file matches "{path}".')
    return found


def _include_one(
    run: Evaluation,
    node: Node,
    path: str,
    inside: tuple[MacroTable, Scope],
    *,
    optional: bool,
) -> OutputElement | None:
    """Return one file's content; None when it is optional and cannot be read."""
    before = run.texts.mark()
    try:
        root = _root_of(run, node, path)
        run.texts.files.append(path)
        content = _evaluate(run, root, *inside)
    except Fault as fault:
        if not (optional and fault.unreadable):
            raise
        if isinstance(fault, Refusal):
            run.texts.warn("outside-roots", f"An optional file was left out: {fault.sentence}")
        run.texts.back_to(before)
        return None
    run.texts.files.pop()
    return content


def _root_of(run: Evaluation, node: Node, path: str) -> SourceElement:
    if len(run.texts.files) > INCLUDE_DEPTH:
        sentence = f"Files include each other more than {INCLUDE_DEPTH} deep: one includes itself."
        raise Refusal("include-recursion", sentence)
    root = run.source(path)
    run.texts.asked_for(root.tree.path)
    run.includes[node.origin.tree.path, root.tree.path] = None
    run.included_at.setdefault(root.tree.path, node.origin.place)
    return root


def _evaluate(
    run: Evaluation, root: SourceElement, macros: MacroTable, scope: Scope
) -> OutputElement:
    content = OutputElement("xacro:include", root, run.frame)
    run.texts.at = root
    content.attributes = run.echo_attributes(root, scope)
    run.children(root, content, macros, scope)
    return content


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
