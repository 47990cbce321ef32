"""What evaluating an element needs to know of it, worked out once per source element."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from studio.description.syntax.source_tree import SourceComment, SourceElement, SourceText

if TYPE_CHECKING:
    from studio.description.evaluator.output_tree import ChildNode, Node

EVALUATE_COMMENTS = "xacro:eval-comments"


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
    """The plan of a node; kept with source elements."""
    if not isinstance(node, SourceElement):
        return Plan(node)
    if node.plan is None:
        node.plan = Plan(node)
    return cast("Plan", node.plan)
