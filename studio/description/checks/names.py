"""Names that are missing, or that two different things bear."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

from studio.description.checks.element_mends import ElementMends
from studio.description.evaluator.output_tree import write_xml
from studio.description.faults import shorten
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.output_tree import OutputElement
    from studio.problems import Problem


def odd_names(run: CheckedRun) -> Iterator[Problem]:
    """A robot without a name, and materials of one name that look different."""
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
    told: set[str] = set()
    for element in run.keys:
        name = element.attributes.get("name", "")
        if element.tag != "material" or not name or name in told or not element.children:
            continue
        known = first.setdefault(name, element)
        if known is not element and _look(known) != _look(element):
            told.add(name)
            sentence = (
                f"The material {quoteattr(name)} is defined in line {known.origin.line} with "
                "another look, which counts for both: give one of them a name of its own."
            )
            short = shorten(sentence, 480)
            yield run.problem(Severity.INFO, "duplicate-material", short, element)


def _look(material: OutputElement) -> str:
    return "".join(write_xml(child) for child in material.elements())
