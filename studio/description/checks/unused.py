"""Properties and args that no text of the description mentions."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.checks.element_mends import ElementMends
from studio.description.syntax.source_tree import SourceElement, SourceText
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.checks.checked_run import CheckedRun
    from studio.problems import Problem

_WORD: Final = re.compile(r"[^\W\d]\w*")
_KINDS: Final = {SiteKind.PROPERTY: "property", SiteKind.ARG: "arg"}
_DEFINING: Final = frozenset({"xacro:property", "xacro:arg"})
_LIMIT: Final = 50


def unused_names(run: CheckedRun) -> Iterator[Problem]:
    """What is bound, read by nothing in this run, and mentioned nowhere: a typing error, or old."""
    mentioned: set[str] | None = None
    told: set[SourceElement] = set()
    for binding in run.bindings:
        kind = _KINDS.get(binding.kind) if binding.kind else None
        if kind is None or binding.readings or binding.element in told:
            continue
        if mentioned is None:
            mentioned = _mentioned(run)
        if binding.name in mentioned:
            continue
        told.add(binding.element)
        sentence = (
            f'Nothing reads the {kind} "{binding.name}": remove it, or look whether a place that '
            "should read it spells it in another way."
        )
        mends = ElementMends(binding.element)
        fix = mends.fix(f"Remove {binding.name}", mends.gone())
        yield run.note(f"unused-{kind}", sentence, binding.element, fix)
        if len(told) == _LIMIT:
            return


def _mentioned(run: CheckedRun) -> set[str]:
    """Every word of the texts that xacro evaluates, in all files of the run."""
    texts: list[str] = []
    for tree in run.trees.values():
        for element in tree.elements:
            texts += _texts(element)
    return set(_WORD.findall("\n".join(texts)))


def _texts(element: SourceElement) -> Iterator[str]:
    is_xacro = element.tag.startswith("xacro:")
    for name, text in element.attributes.items():
        if (is_xacro and not (name == "name" and element.tag in _DEFINING)) or "$" in text:
            yield text
    for child in element.children:
        if isinstance(child, SourceText) and "$" in child.text:
            yield child.text
