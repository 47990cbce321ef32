"""The text of a lesson: its title, the demos that it needs, and its steps with their checks."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.course.lessons.checks import Check, read_check
from studio.errors import LessonError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

TEXT_MAX: Final = 60_000
"""Characters of one lesson."""
STEPS_MAX: Final = 40
CHECKS_MAX: Final = 20
"""Of one step."""
FAULTS_MAX: Final = 50
"""What is wrong beyond these is not told before they are mended."""
_CHECK: Final = re.compile(r"check:(.*)")
_TITLE: Final = re.compile(r"# +(\S.*)")
_NEEDS: Final = re.compile(r"needs:(.*)")


class Fault(NamedTuple):
    """What is wrong with a text, and in which line, counted from 1."""

    line: int
    sentence: str


class FaultyLine(NamedTuple):
    """A line that was to be a check."""

    line: str
    reason: str


@dataclass(frozen=True, slots=True)
class Step:
    """A block of checks.

    Attributes:
        id: Made of the checks alone, so that it is the same in every language, and ticks outlive
            changes of the words around it.
        heading: The last one above it; empty: there is none.
    """

    id: str
    heading: str
    checks: tuple[Check, ...]
    faulty: tuple[FaultyLine, ...] = ()
    """While it has such lines it is never done."""


@dataclass(frozen=True, slots=True)
class LessonText:
    """A lesson as it is read; what is faulty in it is left out."""

    title: str
    needs: tuple[str, ...]
    """Demos that are started beside it, by name."""
    steps: tuple[Step, ...]
    faults: tuple[Fault, ...]


def read_lesson(text: str) -> LessonText:
    """Read a lesson of any text.

    Args:
        text: Markdown that begins with `# Title`; the next line may be `needs: DEMO DEMO`. Lines
            `check: ...` that follow each other without an empty line are a step.
    """
    faults: list[Fault] = []
    if len(text) > TEXT_MAX:
        faults.append(Fault(1, f"A lesson has {TEXT_MAX} characters at most: make it shorter."))
        text = text[:TEXT_MAX]
    lines = text.splitlines()
    title = _TITLE.fullmatch(lines[0].strip()) if lines else None
    if title is None:
        faults.append(
            Fault(1, "A lesson begins with its title: write `# Title` in the first line.")
        )
    needs = _NEEDS.fullmatch(lines[1]) if len(lines) > 1 else None
    steps = tuple(_steps(lines, faults))
    if len(steps) > STEPS_MAX:
        faults.append(Fault(1, f"A lesson has {STEPS_MAX} steps at most: make two of it."))
    return LessonText(
        title[1].strip() if title else "",
        tuple(needs[1].split()) if needs else (),
        steps[:STEPS_MAX],
        tuple(faults),
    )


def _steps(lines: Iterable[str], faults: list[Fault]) -> Iterator[Step]:
    heading, block, faulty = "", list[Check](), list[FaultyLine]()
    seen: dict[str, int] = {}
    for number, line in enumerate([*lines, ""], 1):
        if len(faults) >= FAULTS_MAX:
            return
        if match := _CHECK.fullmatch(line.strip()):
            try:
                block.append(read_check(match[1]))
            except LessonError as error:
                faults.append(Fault(number, str(error)))
                faulty.append(FaultyLine(match[1].strip(), str(error)))
            continue
        if len(block) > CHECKS_MAX:
            sentence = f"A step has {CHECKS_MAX} checks at most: part them by an empty line."
            faults.append(Fault(number - 1, sentence))
            faulty.append(FaultyLine(block[CHECKS_MAX].line, sentence))
        if block or faulty:
            yield _step(heading, tuple(block[:CHECKS_MAX]), tuple(faulty), seen)
        block, faulty = [], []
        if line.startswith("## "):
            heading = line[3:].strip()


def _step(
    heading: str, checks: tuple[Check, ...], faulty: tuple[FaultyLine, ...], seen: dict[str, int]
) -> Step:
    name = hashlib.sha256("\n".join(one.line for one in checks).encode()).hexdigest()[:10]
    seen[name] = seen.get(name, 0) + 1
    name = f"{name}-{seen[name]}" if seen[name] > 1 else name
    return Step(name, heading, checks, faulty)
