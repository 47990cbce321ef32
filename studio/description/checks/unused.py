"""Properties and args that no text of the description mentions."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.checks.element_mends import ElementMends
from studio.description.faults import shorten
from studio.description.syntax.source_tree import SourceElement, SourceText
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.run_record import Binding
    from studio.problems import Problem

_WORD: Final = re.compile(r"[^\W\d]\w*")
_KINDS: Final = {SiteKind.PROPERTY: ("property", "properties"), SiteKind.ARG: ("arg", "args")}
_DEFINING: Final = frozenset({"xacro:property", "xacro:arg"})
_ONE_BY_ONE: Final = 3
"""So many of one file are findings of their own; a library that offers more is one finding."""
_SHOWN: Final = 6
_MENDED: Final = 500


def unused_names(run: CheckedRun) -> Iterator[Problem]:
    """What is bound, read by nothing in this run, and mentioned nowhere: a typing error, or old."""
    unread = [one for one in run.bindings if one.kind in _KINDS and not one.readings]
    mentioned = _mentioned(run) if unread else set[str]()
    groups: dict[tuple[SiteKind | None, str], dict[SourceElement, Binding]] = {}
    for one in unread:
        if one.name not in mentioned:
            group = groups.setdefault((one.kind, one.element.tree.path), {})
            group.setdefault(one.element, one)
    for group in groups.values():
        found = list(group.values())
        if len(found) > _ONE_BY_ONE:
            yield _unused(run, found)
        else:
            yield from (_unused(run, [one]) for one in found)


def _unused(run: CheckedRun, found: Sequence[Binding]) -> Problem:
    """One finding for all of these, which are of one kind and in one file."""
    first = found[0]
    one, several = _KINDS[first.kind] if first.kind else ("", "")
    shown = ", ".join(f'"{each.name}"' for each in found[:_SHOWN])
    more = ", ..." if found[_SHOWN:] else ""
    what = f"the {one} {shown}" if len(found) == 1 else f"{len(found)} {several} ({shown}{more})"
    it = "it" if len(found) == 1 else "them"
    sentence = (
        f"Nothing reads {what}: remove {it}, or look whether what should read {it} is misspelt."
    )
    removed = [ElementMends(each.element).gone() for each in found[:_MENDED]]
    label = f"Remove {first.name}" if len(found) == 1 else f"Remove {len(removed)} {several}"
    fix = ElementMends(first.element).fix(shorten(label), *removed)
    return run.note(f"unused-{one}", shorten(sentence, 480), first.element, fix)


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
