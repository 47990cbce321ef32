"""Names that are missing, that two things bear, or that nothing reads."""

from __future__ import annotations

import re
from collections import Counter
from itertools import count
from pathlib import PurePath
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.output_tree import write_xml
from studio.description.faults import shorten
from studio.description.syntax.attribute_spans import quoted
from studio.description.syntax.mends import ElementMends
from studio.description.syntax.source_tree import SourceElement, SourceText
from studio.description.values import SiteKind
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.graph import Binding
    from studio.description.evaluator.output_tree import OutputElement
    from studio.problems import Fix, Problem

_FOUND_LIMIT = 100
_WORD: Final = re.compile(r"[^\W\d]\w*")
_KINDS: Final = {SiteKind.PROPERTY: ("property", "properties"), SiteKind.ARG: ("arg", "args")}
_DEFINING: Final = frozenset({"xacro:property", "xacro:arg"})
_ONE_BY_ONE: Final = 3
"""So many of one file are findings of their own; more, as in a library, are one finding."""
_SHOWN: Final = 6
_MENDED: Final = 500


def odd_names(run: CheckedRun) -> Iterator[Problem]:
    """Yield a robot without a name, and materials of one name that differ."""
    if not run.root.attributes.get("name"):
        yield _nameless(run)
    yield from _differing_materials(run)


def _nameless(run: CheckedRun) -> Problem:
    root = run.root.origin
    stem = PurePath(root.tree.path).name.partition(".")[0] or "robot"
    mends = ElementMends(root)
    edit = None if "name" in root.attributes else mends.attribute("name", stem)
    sentence = "The <robot> has no name; ROS rejects this: give it one."
    fix = mends.fix(f'Name it "{stem}"', edit)
    return run.problem(Severity.WARNING, "no-robot-name", sentence, run.root, fix)


def _differing_materials(run: CheckedRun) -> Iterator[Problem]:
    first: dict[str, OutputElement] = {}
    reported: set[str] = set()
    for element in run.keys:
        name = element.attributes.get("name", "")
        if element.tag != "material" or not name or name in reported or not element.children:
            continue
        known = first.setdefault(name, element)
        if known is not element and _appearance(known) != _appearance(element):
            reported.add(name)
            sentence = (
                f"The material {quoted(name)} is defined in line {known.origin.line} with "
                "another appearance, which counts for both: give one of them a name of its own."
            )
            short = shorten(sentence, 480)
            yield run.problem(Severity.INFO, "duplicate-material", short, element)


def _appearance(material: OutputElement) -> str:
    return "".join(write_xml(child) for child in material.elements())


def repeated_names(run: CheckedRun) -> Iterator[Problem]:
    """Yield each link and joint whose name is taken already, worded as in the robot's check.

    A name of its own is offered where the element came out once: a macro that is called twice
    needs a parameter, and which one is not known.
    """
    origins = Counter(element.origin for element in run.keys)
    names = {(one.tag, one.attributes.get("name", "")) for one in run.keys}
    repeats = [one for one, key in run.keys.items() if _is_repeat(one, key)]
    for element in repeats[:_FOUND_LIMIT]:
        name = element.attributes["name"]
        fix = _fix(element, names) if origins[element.origin] == 1 else None
        sentence = (
            f'A second {element.tag} is named "{name}" and was left out; ROS rejects this: '
            "give it a name of its own."
        )
        code, parts = f"duplicate-{element.tag}", (run.keys[element],)
        yield run.problem(Severity.ERROR, code, shorten(sentence, 480), element, fix, parts)


def _is_repeat(element: OutputElement, key: str) -> bool:
    name = element.attributes.get("name")
    return bool(name) and element.tag in {"link", "joint"} and key != f"{element.tag}:{name}"


def _fix(element: OutputElement, names: set[tuple[str, str]]) -> Fix | None:
    name = element.attributes["name"]
    free = next(other for n in count(2) if (element.tag, other := f"{name}_{n}") not in names)
    names.add((element.tag, free))
    mends = ElementMends(element.origin)
    return mends.fix(f'Rename it to "{free}"', mends.value("name", free))


def unused_names(run: CheckedRun) -> Iterator[Problem]:
    """Yield names that are bound, not read in this run, and used nowhere: misspelt, or old."""
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
    """Return one finding for names of one kind in one file."""
    first = found[0]
    one, several = _KINDS[first.kind] if first.kind else ("", "")
    shown = ", ".join(f'"{each.name}"' for each in found[:_SHOWN])
    more = ", ..." if found[_SHOWN:] else ""
    what = f"the {one} {shown}" if len(found) == 1 else f"{len(found)} {several} ({shown}{more})"
    it = "it" if len(found) == 1 else "them"
    sentence = (
        f"Nothing reads {what}: remove {it}, or check whether what should read {it} is misspelt."
    )
    removed = [ElementMends(each.element).gone() for each in found[:_MENDED]]
    label = f"Remove {first.name}" if len(found) == 1 else f"Remove {len(removed)} {several}"
    fix = ElementMends(first.element).fix(shorten(label), *removed)
    return run.note(f"unused-{one}", shorten(sentence, 480), first.element, fix)


def _mentioned(run: CheckedRun) -> set[str]:
    """Return every word of the texts that xacro evaluates, in all files of the run."""
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


WHY: Final = {
    "no-robot-name": {
        "en": "Tools tell robots apart by the name of the <robot> element; some refuse one "
        "without.",
        "de": "Werkzeuge unterscheiden Roboter am Namen des <robot>-Elements; manche lehnen einen "
        "ohne ab.",
    },
    "duplicate-material": {
        "en": "A material of one name is defined twice and differently; which of the two counts "
        "depends on the reader.",
        "de": "Ein Material gleichen Namens ist zweimal verschieden definiert; welches zählt, "
        "hängt vom Programm ab, das die Datei liest.",
    },
    "duplicate-joint": {
        "en": "Names of joints are unique in a robot; messages such as JointState tell joints by "
        "name alone.",
        "de": "Namen von Gelenken sind in einem Roboter eindeutig; Nachrichten wie JointState "
        "unterscheiden Gelenke nur am Namen.",
    },
    "duplicate-link": {
        "en": "Names of links are unique in a robot. Two of one name often come from a macro that "
        "is called twice without a prefix.",
        "de": "Namen von Links sind in einem Roboter eindeutig. Zwei gleiche kommen oft von "
        "einem Makro, das zweimal ohne Präfix aufgerufen wird.",
    },
    "unused-arg": {
        "en": "Nothing reads this argument: whoever passes it changes nothing.",
        "de": "Nichts verwendet dieses Argument: Wer es übergibt, ändert nichts.",
    },
    "unused-property": {
        "en": "Nothing reads this property: it can go, or the name is misspelt where it should be "
        "read.",
        "de": "Nichts verwendet diese Property: Sie kann weg, oder ihr Name hat dort einen "
        "Tippfehler, wo sie verwendet werden soll.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
