"""Names that are nearly others: elements and attributes of URDF, and names that ended a run."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.mends import ElementMends, TextMends
from studio.errors import EditError
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.faults import Fault
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.problems import Fix, Problem, Replacement

_TAG_LIKENESS: Final = 0.7
_ATTRIBUTE_LIKENESS: Final = 0.6
_LIMIT: Final = 50
_SEGMENT: Final = re.compile(rb"\$\{[^}]*\}|\$\([^)]*\)")
_CALL: Final = "xacro:"


class _Kind(NamedTuple):
    """What an element may contain."""

    children: frozenset[str]
    attributes: frozenset[str]


def _kind(children: str, attributes: str = "") -> _Kind:
    return _Kind(frozenset(children.split()), frozenset(attributes.split()))


_SHAPED: Final = _kind("origin geometry material", "name")


_URDF: Final = {
    "robot": _kind("link joint material"),
    "link": _kind("inertial visual collision", "name"),
    "joint": _kind(
        "origin parent child axis calibration dynamics limit mimic safety_controller", "name type"
    ),
    "inertial": _kind("origin mass inertia"),
    "visual": _SHAPED,
    "collision": _SHAPED,
    "geometry": _kind("box cylinder sphere mesh capsule"),
    "material": _kind("color texture", "name"),
    "origin": _kind("", "xyz rpy"),
    "mass": _kind("", "value"),
    "inertia": _kind("", "ixx ixy ixz iyy iyz izz"),
    "box": _kind("", "size"),
    "cylinder": _kind("", "radius length"),
    "sphere": _kind("", "radius"),
    "mesh": _kind("", "filename scale"),
    "color": _kind("", "rgba"),
    "texture": _kind("", "filename"),
    "parent": _kind("", "link"),
    "child": _kind("", "link"),
    "axis": _kind("", "xyz"),
    "limit": _kind("", "lower upper effort velocity"),
    "dynamics": _kind("", "damping friction"),
    "mimic": _kind("", "joint multiplier offset"),
}
"""Source: the elements that urdfdom reads."""


def misspelt_names(run: CheckedRun) -> Iterator[Problem]:
    """Yield each element and attribute that is likely misspelt, once, however often it came out."""
    reported: set[tuple[SourceElement, str]] = set()
    for part, key in run.keys.items():
        for problem, mark in _within(run, "robot", part, (key,)):
            if mark not in reported and len(reported) < _LIMIT:
                reported.add(mark)
                yield problem


def _within(
    run: CheckedRun, parent: str, element: OutputElement, parts: tuple[str, ...]
) -> Iterator[tuple[Problem, tuple[SourceElement, str]]]:
    """Check an element in one that is, or was meant to be, a `parent`."""
    siblings, tag = _URDF[parent].children, element.tag
    if tag not in siblings:
        tag = _near(tag, siblings, _TAG_LIKENESS)
        if not tag:
            return
        yield _misspelt_tag(run, element, parent, tag, parts), (element.origin, "")
    known = _URDF.get(tag)
    if known is None:
        return
    for name in element.attributes.keys() - known.attributes:
        absent = known.attributes - element.attributes.keys()
        meant = "" if ":" in name else _near(name, absent, _ATTRIBUTE_LIKENESS)
        if meant:
            yield _misspelt_attribute(run, element, name, meant, parts), (element.origin, name)
    for child in element.elements():
        yield from _within(run, tag, child, parts)


def _near(name: str, known: frozenset[str], likeness: float) -> str:
    near = get_close_matches(name.lower(), sorted(known), 1, likeness)
    return near[0] if near else ""


def _misspelt_tag(
    run: CheckedRun, element: OutputElement, parent: str, meant: str, parts: tuple[str, ...]
) -> Problem:
    tag = element.tag
    sentence = f"<{tag}> is nothing that <{parent}> holds: did you mean <{meant}>?"
    mends = ElementMends(element.origin)
    fix = mends.fix(f"Write <{meant}>", *mends.tag(meant)) if element.origin.tag == tag else None
    return run.problem(Severity.WARNING, "unknown-element", sentence, element, fix, parts)


def _misspelt_attribute(
    run: CheckedRun, element: OutputElement, name: str, meant: str, parts: tuple[str, ...]
) -> Problem:
    sentence = f'<{element.tag}> has no attribute "{name}": did you mean "{meant}"?'
    mends = ElementMends(element.origin)
    fix = mends.fix(f"Write {meant}", mends.attribute_name(name, meant))
    return run.problem(Severity.WARNING, "unknown-attribute", sentence, element, fix, parts)


def mend_of(fault: Fault, trees: Mapping[str, SourceTree]) -> Fix | None:
    """Write the other name where the wrong one stands; None where that is not one sure place."""
    if fault.misnamed is None or fault.place is None:
        return None
    wrong, meant = fault.misnamed
    tree, place = trees.get(fault.place.file), fault.place
    at = [one for one in (tree.elements if tree else ()) if one.place == place]
    if not at:
        return None
    edits = tuple(edit for one in at for edit in _edits(fault.code, one, wrong, meant))
    return ElementMends(at[0]).fix(f'Write "{meant}"', *edits)


def _edits(code: str, element: SourceElement, wrong: str, meant: str) -> Iterator[Replacement]:
    mends = ElementMends(element)
    if code == "unknown-macro" and element.tag == f"{_CALL}{wrong}":
        yield from mends.tag(f"{_CALL}{meant}")
    elif code == "unknown-parameter":
        yield from (edit for edit in (mends.attribute_name(wrong, meant),) if edit)
    elif code in {"unknown-macro", "unknown-block"}:
        for name in ("macro", "name"):
            if element.attributes.get(name) == wrong and (edit := mends.value(name, meant)):
                yield edit
    elif code == "file-unreadable":
        yield from _file_name(element, wrong, meant)
    else:
        yield from _in_expressions(element, wrong, meant)


def _file_name(element: SourceElement, wrong: str, meant: str) -> Iterator[Replacement]:
    """Yield the end of the path that an include or an expression names."""
    tree = element.tree
    mends = TextMends(tree.path, tree.data, tree.encoding)
    name = re.compile(rb"(?<=[/'\"])" + re.escape(wrong.encode()) + rb"(?=['\"])")
    try:
        spans = attribute_spans(tree.data, element.offset)
    except EditError:
        return
    for span in spans.values():
        found = name.search(tree.data, span.start - 1, span.end + 1)
        if found is not None:
            yield mends.replaced(*found.span(), meant)


def _in_expressions(element: SourceElement, wrong: str, meant: str) -> Iterator[Replacement]:
    """Yield the name wherever an attribute of the element evaluates it."""
    tree = element.tree
    if not any(wrong in text for text in element.attributes.values()):
        return
    mends = TextMends(tree.path, tree.data, tree.encoding)
    name = re.compile(rb"(?<![\w.'\"])" + re.escape(wrong.encode()) + rb"(?![\w'\"(])")
    try:
        spans = attribute_spans(tree.data, element.offset)
    except EditError:
        return
    for span in spans.values():
        for segment in _SEGMENT.finditer(tree.data, span.start, span.end):
            for found in name.finditer(tree.data, *segment.span()):
                yield mends.replaced(*found.span(), meant)


WHY: Final = {
    "unknown-element": {
        "en": "URDF does not know this element here and ignores it without a word: what stands in "
        "it has no effect.",
        "de": "URDF kennt dieses Element hier nicht und ignoriert es stillschweigend: Was darin "
        "steht, hat keine Wirkung.",
    },
    "unknown-attribute": {
        "en": "URDF does not know this attribute here and ignores it without a word.",
        "de": "URDF kennt dieses Attribut hier nicht und ignoriert es stillschweigend.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
