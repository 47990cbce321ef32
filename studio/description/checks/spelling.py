"""Elements and attributes that URDF does not know, where it knows one that is nearly the same."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.checks.element_mends import ElementMends
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.syntax.source_tree import SourceElement
    from studio.problems import Problem


class _Kind(NamedTuple):
    """What an element may hold."""

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
_TAG_LIKENESS: Final = 0.7
_ATTRIBUTE_LIKENESS: Final = 0.6
_LIMIT: Final = 50


def misspelt_names(run: CheckedRun) -> Iterator[Problem]:
    """Each element and attribute that is likely misspelt, once, however often it came out."""
    told: set[tuple[SourceElement, str]] = set()
    for part, key in run.keys.items():
        for problem, mark in _within(run, "robot", part, (key,)):
            if mark not in told and len(told) < _LIMIT:
                told.add(mark)
                yield problem


def _within(
    run: CheckedRun, parent: str, element: OutputElement, parts: tuple[str, ...]
) -> Iterator[tuple[Problem, tuple[SourceElement, str]]]:
    """Look at an element in one that is, or was meant to be, a `parent`."""
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
