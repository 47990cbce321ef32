"""`xacro:property`, `xacro:arg` and `xacro:macro`: what binds a name and leaves no output."""

from __future__ import annotations

import keyword
from typing import TYPE_CHECKING

from studio.description.evaluator.macros import Macro, read_parameters
from studio.description.evaluator.node_attributes import required, warn_unknown
from studio.description.evaluator.scopes import Cell, literal_value, truth_of
from studio.description.evaluator.texts import Argument
from studio.description.expressions.guarded_operations import text_of
from studio.description.faults import Fault
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from studio.description.evaluator.evaluation import Evaluation
    from studio.description.evaluator.macros import MacroTable
    from studio.description.evaluator.output_tree import Node, OutputElement
    from studio.description.evaluator.scopes import Scope


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
    """The scope to bind in, and whether the text may wait for its first reader.

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


def bound_cell(run: Evaluation, cell: Cell, text: str, scope: Scope) -> Cell:
    """Give a cell its value at once."""
    if "$" in text:
        run.texts.bind(cell, run.texts.evaluated(text, scope, cell))
    else:
        cell.value = literal_value(text)
    return cell


def warn_hidden(run: Evaluation, name: str) -> None:
    """Warn when a name hides one of xacro's own."""
    if name in run.texts.symbols:
        run.texts.warn("hides-builtin", f'"{name}" hides a name that xacro itself defines.')


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


def define_macro(
    run: Evaluation, node: Node, _out: OutputElement, macros: MacroTable, _scope: Scope
) -> None:
    """`xacro:macro`: kept as it is written, evaluated at each call."""
    (name,) = required(node, "name")
    warn_unknown(run.texts, node, "name", "params")
    if name == "call" or "." in name:
        sentence = f'A macro may not be called "{name}": "call" and names with "." are taken.'
        raise Fault("macro-name", sentence)
    if name.startswith("xacro:"):
        run.texts.warn("macro-name", f'The macro name "{name}" should not start with "xacro:".')
        name = name[6:]
    macro = macros.own(name) or Macro(name, node)
    macro.body = node
    macro.parameters, macro.defaults = read_parameters(node.attributes.get("params", ""))
    macros.put(name, macro)
