"""`xacro:include`: other files, by name or pattern, optionally into a namespace."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.declarations import warn_hidden
from studio.description.evaluator.macros import MacroTable
from studio.description.evaluator.node_attributes import import_namespaces, required, warn_unknown
from studio.description.evaluator.output_tree import OutputElement
from studio.description.evaluator.scopes import Cell, Scope, ScopeView, truth_of
from studio.description.expressions.guarded_operations import text_of
from studio.description.faults import Fault, Refusal
from studio.description.syntax.source_tree import SourceElement

if TYPE_CHECKING:
    from studio.description.evaluator.evaluation import Evaluation
    from studio.description.evaluator.output_tree import Node

DEPTH_LIMIT: Final = 64
"""Files inside files; the deepest robot of the corpus has 7."""
_MAGIC: Final = re.compile(r"[*[?]+")


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
    macros_in, scope_in = MacroTable(), Scope(run.texts, scope, is_namespace=True)
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
    """One file's content; None when it is optional and cannot be read."""
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
    if len(run.texts.files) > DEPTH_LIMIT:
        sentence = f"Files include each other more than {DEPTH_LIMIT} deep: one includes itself."
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
