"""Links and joints that bear the name of an earlier one, with a free name for the later."""

from __future__ import annotations

from collections import Counter
from itertools import count
from typing import TYPE_CHECKING

from studio.description.checks.element_mends import ElementMends
from studio.description.faults import shorten
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.checks.checked_run import CheckedRun
    from studio.description.evaluator.output_tree import OutputElement
    from studio.problems import Fix, Problem

_FOUND_LIMIT = 100


def repeated_names(run: CheckedRun) -> Iterator[Problem]:
    """Each link and joint whose name is taken by one before it, in the words of the robot's check.

    A name of its own is offered where the element came out once: a macro that is called twice
    needs a parameter, and which one nobody can know.
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
