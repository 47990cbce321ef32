"""Macros as they are defined and called, and the blocks handed to them."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from studio.description.evaluator.graph import Cell, Scope, ScopeView
from studio.description.evaluator.macros import Macro, MacroTable
from studio.description.evaluator.output_tree import CallFrame, OutputElement
from studio.description.evaluator.walk import (
    bound_cell,
    import_namespaces,
    required,
    warn_hidden,
    warn_unknown,
)
from studio.description.expressions.guards import text_of
from studio.description.faults import Fault, misnamed
from studio.description.syntax.params import read_parameters
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from studio.description.evaluator.output_tree import Node, OutputChild
    from studio.description.evaluator.walk import Walk
    from studio.description.syntax.params import Default


def define_macro(
    run: Walk, node: Node, _out: OutputElement, macros: MacroTable, _scope: Scope
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


def call_by_name(
    run: Walk, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
) -> None:
    """`xacro:call`: the macro is named by an expression."""
    (text,) = required(node, "macro")
    if not text:
        raise Fault("missing-attribute", '<xacro:call> needs the attribute "macro".')
    name = text_of(run.texts.consumed(text, scope, ("xacro:call", "macro")))
    renamed = OutputElement(f"xacro:{name}", node.origin, run.frame)
    renamed.attributes = {n: t for n, t in node.attributes.items() if n != "macro"}
    renamed.children = cast("list[OutputChild]", node.children)
    call_macro(run, renamed, out, macros, scope)


def call_macro(run: Walk, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
    """Evaluate a macro's body in a new scope, whose parent is the caller's."""
    macro, macros_in, scope_in = _resolve(node.tag[6:], macros, scope)
    written = macro.body  # what stands inside the call may define the macro again
    outer_frame = run.frame
    frame = CallFrame(macro.name, node.origin, outer_frame)
    run.budget.depth(frame.depth, macro.name)
    inner = Scope(run.texts, scope_in)
    left = _bind_arguments(run, node, macro, inner, scope)
    _bind_blocks(run, node, macro, left, (inner, macros, scope))
    _bind_defaults(run, macro, left, inner, scope)
    if left:
        raise _missing(macro, left)
    run.frame = frame
    body = OutputElement("xacro:macro", written.origin, frame)
    run.texts.at = written.origin
    body.attributes = run.echo_attributes(written, inner)
    run.children(written, body, MacroTable(macros_in), inner)
    run.frame = outer_frame
    run.texts.at = node.origin
    import_namespaces(run.texts, out, body.attributes)
    out.children += body.children


def _resolve(name: str, macros: MacroTable, scope: Scope) -> tuple[Macro, MacroTable, Scope]:
    """Find a macro by its whole name, else by `namespace.name`.

    Raises:
        Fault: There is none.
    """
    found = macros.find(name)
    if isinstance(found, Macro):
        return found, macros, scope
    table, inside = macros, scope
    *namespaces, last = name.split(".")
    for namespace in namespaces:
        inner, cell = table.find(namespace), inside.find(namespace)
        view = cell[0].value if cell else None
        if not isinstance(inner, MacroTable) or not isinstance(view, ScopeView):
            raise _unknown(name, macros)
        table, inside = inner, view.scope
    found = table.find(last)
    if not isinstance(found, Macro):
        raise _unknown(name, macros)
    return found, table, inside


def _unknown(name: str, macros: MacroTable) -> Fault:
    otherwise = "include the file that defines it."
    sentence = f'There is no macro "{name}"'
    return misnamed("unknown-macro", sentence, name, macros.all_names(), otherwise)


def _missing(macro: Macro, names: list[str]) -> Fault:
    blocks = [name for name in names if name.startswith("*")]
    if blocks:
        sentence = f'The macro "{macro.name}" needs {len(blocks)} more element(s) inside its call.'
        return Fault("missing-block", sentence)
    wanted = ", ".join(f'{name}="..."' for name in names)
    return Fault("missing-parameter", f'The macro "{macro.name}" also needs {wanted}.')


def _bind_arguments(run: Walk, node: Node, macro: Macro, inner: Scope, scope: Scope) -> list[str]:
    """Bind what the call gives; the parameters that are left."""
    left = list(macro.parameters)
    for name, text in node.attributes.items():
        if name not in left:
            sentence = f'The macro "{macro.name}" has no parameter "{name}"'
            otherwise = f"it knows {', '.join(macro.parameters) or 'none'}."
            raise misnamed("unknown-parameter", sentence, name, left, otherwise)
        left.remove(name)
        binding = run.binding(None, name, node.origin, name, text)
        warn_hidden(run, name)
        inner.cells[name] = bound_cell(run, Cell(name, inner, None, binding), text, scope)
    return left


def _bind_blocks(
    run: Walk,
    node: Node,
    macro: Macro,
    left: list[str],
    scopes: tuple[Scope, MacroTable, Scope],
) -> None:
    """Evaluate the content of a call where it stands, and hand out its elements in order."""
    inner, macros, scope = scopes
    blocks: list[OutputElement] = []
    if node.children:
        content = OutputElement(node.tag, node.origin, run.frame)
        run.children(node, content, macros, scope)
        blocks = list(content.elements())
        run.texts.at = node.origin
    for name in [one for one in left if one.startswith("*")]:
        if not blocks:
            raise _missing(macro, [one for one in left if one.startswith("*")])
        left.remove(name)
        inner.cells[name] = Cell(name, inner, blocks.pop(0))
    if blocks:
        sentence = f'The macro "{macro.name}" takes no element <{blocks[0].tag}> here.'
        raise Fault("unused-block", sentence)


def _bind_defaults(run: Walk, macro: Macro, left: list[str], inner: Scope, scope: Scope) -> None:
    """Set the defaults of parameters that the call left out, evaluated at the call."""
    for name in [one for one in left if one in macro.defaults and not one.startswith("*")]:
        default = macro.defaults[name]
        binding = run.binding(
            SiteKind.PARAM_DEFAULT, name, macro.body.origin, "params", default.text or ""
        )
        if not default.forward and default.text is None:
            continue
        cell = Cell(name, inner, None, binding)
        inner.cells[name] = _with_default(run, cell, default, scope)
        left.remove(name)


def _with_default(run: Walk, cell: Cell, default: Default, scope: Scope) -> Cell:
    name = cell.name
    if default.forward and scope.has(name):
        run.texts.bind(cell, run.texts.forwarded(name, scope, cell))
    elif default.text is None:
        sentence = f'"{name}" is forwarded by ":=^" but not defined here: define it or pass it.'
        raise Fault("undefined-property", sentence)
    else:
        bound_cell(run, cell, default.text, scope)
    warn_hidden(run, name)
    return cell


def insert_block(
    run: Walk, node: Node, out: OutputElement, macros: MacroTable, scope: Scope
) -> None:
    """`xacro:insert_block`: the elements are evaluated once more, now in this scope."""
    (name,) = required(node, "name")
    warn_unknown(run.texts, node, "name")
    found = scope.find(f"**{name}")
    if found is not None:
        run.echo_attributes(_block(found[0]), scope)
        sink = OutputElement(node.tag, node.origin, run.frame)
        run.children(_block(found[0]), sink, macros, scope)
        out.children += sink.children
        return
    found = scope.find(f"*{name}")
    if found is None:
        otherwise = "pass it to the macro or define the property."
        sentence = f'There is no block "{name}" here'
        raise misnamed("unknown-block", sentence, name, _block_names(scope), otherwise)
    run.ordinary(_block(found[0]), out, macros, scope)


def _block(cell: Cell) -> Node:
    return cast("Node", cell.value)


def _block_names(scope: Scope) -> list[str]:
    return [name.lstrip("*") for name in scope.all_names() if name.startswith("*")]
