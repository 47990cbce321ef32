"""Lessons, their steps and their checks as pages are told of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.course.demos import LESSONS
from studio.documents.lessons.verdict import Verdict, missing
from studio.protocol.lessons import CheckView, LessonView, StepView

if TYPE_CHECKING:
    from collections.abc import Container, Mapping

    from studio.course.lessons.checks import Check
    from studio.course.lessons.shelf import Lesson
    from studio.course.lessons.text import LessonText, Step

_NOTHING: Final = missing("")
_FAULTY: Final = "check.faulty"


def tick_of(lesson: str, step: Step) -> str:
    """Return the name of a step in what is kept of those who did it."""
    return f"{lesson}/{step.id}"


def step_view(
    step: Step, checks: tuple[CheckView, ...] | None = None, done_s: float | None = None
) -> StepView:
    """Return a step; without `checks` as it stands before anybody looked."""
    if checks is None:
        checks = check_views(step, {})
    return StepView(id=step.id, heading=step.heading, done_s=done_s, checks=checks)


def check_views(step: Step, verdicts: Mapping[str, Verdict]) -> tuple[CheckView, ...]:
    """Return the checks of a step, by the verdicts on their lines, and its lines that are none."""
    whole = [_check_view(one, verdicts.get(one.line, _NOTHING)) for one in step.checks]
    faulty = [
        CheckView(kind="", line=one.line, values={}, code=_FAULTY, found={"reason": one.reason})
        for one in step.faulty
    ]
    return (*whole, *faulty)


def _check_view(check: Check, verdict: Verdict) -> CheckView:
    return CheckView(
        kind=check.kind,
        line=check.line,
        values=dict(check.values),
        ok=verdict.ok,
        code=verdict.code,
        found=verdict.found,
    )


def lesson_view(lesson: Lesson, text: LessonText, ticks: Container[str]) -> LessonView:
    """Return a lesson in the list, with how far somebody is."""
    demo = LESSONS.get(lesson.name)
    return LessonView(
        name=lesson.name,
        chapter=lesson.chapter,
        node=demo.node if demo and not lesson.own else "",
        has_keys=bool(demo and demo.has_keys and not lesson.own),
        own=lesson.own,
        writable=lesson.writable,
        version=lesson.version if lesson.own else "",
        steps=len(text.steps),
        done=sum(tick_of(lesson.name, step) in ticks for step in text.steps),
    )
