"""A run whose comments come out: those, and only those, that xacro 2.1.1 leaves in its output.

Xacro drops the comments that stand directly before its own tags, and finds them by walking back
over what it has already put out. So blanks are kept here, too, and its one *barrier*: a text of
two newlines that it moves behind the tag which it cleaned up for last, where the walk stops.
The studio's own runs do without all of this; comments move no robot.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, cast

from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.output_tree import OutputElement
from studio.description.evaluator.walk import EVALUATE_COMMENTS
from studio.description.expressions.guards import text_of
from studio.description.syntax.source_tree import SourceComment, SourceText

if TYPE_CHECKING:
    from studio.description.evaluator.graph import Scope
    from studio.description.evaluator.macros import MacroTable
    from studio.description.evaluator.output_tree import ChildNode, Node

_CLEANED_FIRST: Final = frozenset({"xacro:property", "xacro:macro", "xacro:if", "xacro:unless"})
"""Tags that drop the comments before them, then evaluate; most do it the other way round."""
_NEVER_CLEANED: Final = frozenset({"xacro:insert_block", "xacro:element", "xacro:attribute"})


class Barrier(SourceText):
    """The text that ends the walk back. There is one: setting a new one removes the old one."""

    __slots__ = ("is_gone",)

    def __init__(self) -> None:
        super().__init__("\n\n")
        self.is_gone = False


class CommentedEvaluation(Evaluation):
    """Expands as `Evaluation` does, comments and blanks included."""

    _barrier: Barrier | None = None
    _is_followed = False
    """Something stands behind the child under way."""

    def children(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate all children of a node into `out`, whatever they are."""
        children = [child for child in cast("list[ChildNode]", node.children) if not _gone(child)]
        evaluates = False
        for left, child in zip(range(len(children) - 1, -1, -1), children, strict=True):
            if isinstance(child, SourceText):
                evaluates &= self._keep_text(child, out, scope)
            elif isinstance(child, SourceComment):
                evaluates = self._keep_comment(child, out, scope, on=evaluates)
            else:
                evaluates, self._is_followed = False, left > 0
                self.element(child, out, macros, scope)

    def element(self, node: Node, out: OutputElement, macros: MacroTable, scope: Scope) -> None:
        """Evaluate one element into `out`, without the comments that xacro drops before it."""
        tag, followed = node.tag, self._is_followed
        if not tag.startswith("xacro:") or tag in _NEVER_CLEANED:
            super().element(node, out, macros, scope)
            return
        barrier = self._clean(out, followed=followed) if tag in _CLEANED_FIRST else None
        made = OutputElement(tag, node.origin, self.frame)
        made.attributes = out.attributes
        super().element(node, made, macros, scope)
        if tag not in _CLEANED_FIRST:
            barrier = self._clean(out, followed=followed)
        out.attributes = made.attributes
        out.children += made.children
        if barrier is not None:
            out.children.append(barrier)

    def _clean(self, out: OutputElement, *, followed: bool) -> Barrier | None:
        """Drop the comments at the end of `out`; the barrier to set behind the tag, if any."""
        kept = out.children
        index = len(kept)
        while index:
            if _gone(kept[index - 1]):
                index -= 1
                continue
            if _is_short_blank(kept[index - 1]):
                index -= 1
                while index and _gone(kept[index - 1]):
                    index -= 1
            if not index or not isinstance(kept[index - 1], SourceComment):
                return self._move_barrier() if followed else None
            index -= 1
            del kept[index]
        return None

    def _move_barrier(self) -> Barrier:
        if self._barrier is not None:
            self._barrier.is_gone = True
        self._barrier = Barrier()
        return self._barrier

    def _keep_text(self, node: SourceText, out: OutputElement, scope: Scope) -> bool:
        """Keep a text, evaluated; whether comments behind it are still evaluated."""
        if node.literal:
            out.children.append(node)
            return True
        text = text_of(self.texts.consumed(node.text, scope, (self.path, "")))
        out.children.append(SourceText(text))
        return not text.strip()

    def _keep_comment(
        self, node: SourceComment, out: OutputElement, scope: Scope, *, on: bool
    ) -> bool:
        """Keep a comment, evaluated if that is on; whether it is for the next one."""
        if EVALUATE_COMMENTS in node.text:
            return f"{EVALUATE_COMMENTS}:off" not in node.text
        text = text_of(self.texts.consumed(node.text, scope, (self.path, ""))) if on else node.text
        out.children.append(SourceComment(text, node.line, node.offset))
        return on


def _gone(child: ChildNode) -> bool:
    return isinstance(child, Barrier) and child.is_gone


def _is_short_blank(child: ChildNode) -> bool:
    if not isinstance(child, SourceText) or child.literal:
        return False
    return child.text.isspace() and child.text.count("\n") <= 1
