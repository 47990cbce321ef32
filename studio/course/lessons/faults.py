"""What is wrong with a lesson: its text, the names in it, and its languages."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from studio.course.demos import LESSONS, find_demo
from studio.course.lessons.shelf import EXERCISES
from studio.course.lessons.text import Fault, LessonText, read_lesson
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.course.lessons.shelf import Lesson


class FileFault(NamedTuple):
    """A fault, and the file that it is in."""

    file: Path
    fault: Fault


def faults_of(lesson: Lesson) -> Iterator[FileFault]:
    """Yield what is wrong with a lesson, in all its languages.

    Raises:
        LessonError: A file cannot be read.
    """
    if lesson.name in (*LESSONS, *EXERCISES):
        sentence = f"The course has a lesson {lesson.name}: give the folder another name."
        yield FileFault(next(iter(lesson.files.values())), Fault(1, sentence))
    first: LessonText | None = None
    for language, path in lesson.files.items():
        written = lesson.text(language)
        text = read_lesson(written)
        yield from (FileFault(path, fault) for fault in faults_in(text, written))
        if not text.steps:
            yield FileFault(path, Fault(1, "No step has a check: write a line `check: ...`."))
        first = first or text
        if [one.id for one in text.steps] != [one.id for one in first.steps]:
            sentence = "The checks are not those of the other language: make them the same."
            yield FileFault(path, Fault(1, sentence))


def faults_in(text: LessonText, written: str) -> Iterator[Fault]:
    """Yield what is wrong with a text that was read, with demos and panels that there are not."""
    yield from text.faults
    for name in text.needs:
        if find_demo(name) is None:
            yield Fault(2, f"No demo is called {name}: `studio demos` lists them.")
    panels = {path.parent.name for path in _panels().glob("*/panel.json")}
    for step in text.steps:
        for check in step.checks:
            if check.kind == "opened" and check.values["panel"] not in panels:
                lines = enumerate(written.splitlines(), 1)
                number = next((at for at, line in lines if check.line in line), 1)
                known = ", ".join(sorted(panels))
                yield Fault(
                    number, f"No panel is called {check.values['panel']}: they are {known}."
                )


def _panels() -> Path:
    return repository_or_wheel("frontend_assets") / "panels"
