"""What the comments above an element say of it, and of each parameter of a macro."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.syntax.source_tree import SourceComment, SourceText

if TYPE_CHECKING:
    from studio.description.syntax.source_tree import SourceElement

_LENGTH: Final = 2_000
_MARKUP: Final = re.compile(r"<\s*/?[A-Za-z][^>]*>")
_LICENCE: Final = re.compile(r"copyright|licen[sc]e|all rights reserved", re.IGNORECASE)
_RULE: Final = re.compile(r"[=*#~_+/|-]{3,}")
_LIST_MARK: Final = re.compile(r"^[-*@\s]*(?:param(?:eter)?\s+)?")


def documentation_of(element: SourceElement) -> str:
    """The comments on the lines right above an element, without rules, licences and old code."""
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
    """What the documentation of a macro says of one parameter, where a line begins with it."""
    for line in re.split(r"\n|;", documentation):
        words = _LIST_MARK.sub("", line)
        rest = words.removeprefix(name)
        if rest != words and (said := re.match(r"\s*(?:\([^)]*\)\s*)?[:=\u2013-]\s*(.+)", rest)):
            return said[1].strip()
    return ""
