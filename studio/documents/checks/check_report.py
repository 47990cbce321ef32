"""What was checked, as lines for a person and as JSON for a tool."""

from __future__ import annotations

import json
import os
from collections import Counter
from typing import TYPE_CHECKING

from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from studio.documents.check_run import CheckedFile
    from studio.problems import Problem

NO_ERRORS, ERRORS, NOT_READABLE = 0, 1, 2


def exit_code(files: Sequence[CheckedFile]) -> int:
    """0: no error; 1: errors; 2: none of the files could be read."""
    if not any(file.is_readable for file in files):
        return NOT_READABLE
    return ERRORS if any(file.has_errors for file in files) else NO_ERRORS


def report_lines(files: Sequence[CheckedFile], folder: Path) -> Iterator[str]:
    """A line for each finding, its fix below it, and a last line that counts.

    Args:
        files: What was checked.
        folder: Files below it are named from there.
    """
    counts: Counter[Severity] = Counter()
    for path, problem in _findings(files):
        counts[problem.severity] += 1
        yield f"{_place(path, problem, folder)}: {_WORDS[problem.severity]}: {problem.sentence}"
        yield from (f"    in {one.macro}, called at {one.called_at}" for one in problem.macro_stack)
        if problem.fix:
            yield f"    fix: {problem.fix.label}"
    found = ", ".join(_count(counts[one], _WORDS[one]) for one in Severity if counts[one])
    yield f"{_count(len(files), 'file')} checked: {found or 'nothing found'}."


def report_json(files: Sequence[CheckedFile]) -> str:
    """A list with an object for each finding; `line` and `column` are null when not known."""
    rows = [
        {
            "severity": problem.severity.value,
            "code": problem.code,
            "message": problem.sentence,
            "file": problem.place.file if problem.place else path,
            "line": (problem.place and problem.place.line) or None,
            "column": (problem.place and problem.place.column) or None,
            "fix": problem.fix.label if problem.fix else None,
        }
        for path, problem in _findings(files)
    ]
    return json.dumps(rows, indent=2, ensure_ascii=False)


_WORDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def _findings(files: Sequence[CheckedFile]) -> Iterator[tuple[str, Problem]]:
    """Each finding once, though several robots may share the file that it is in.

    What robots share may have another prefix in the names of its links and joints in each.
    """
    told: set[object] = set()
    told_by_others: set[object] = set()
    for file in files:
        shared: set[object] = set()
        for problem in file.problems:
            where = problem.place or file.path
            mark, nameless = ((problem.code, one, where) for one in _sentences(problem))
            if mark in told or nameless in told_by_others:
                continue
            told.add(mark)
            shared.add(nameless)
            yield str(file.path), problem
        told_by_others |= shared


def _sentences(problem: Problem) -> tuple[str, str]:
    """What a problem says, and the same without the names of its links and joints."""
    nameless = problem.sentence
    for part in problem.parts:
        nameless = nameless.replace(f'"{part.partition(":")[2]}"', '""')
    return problem.sentence, nameless


def _place(path: str, problem: Problem, folder: Path) -> str:
    place = str(problem.place) if problem.place else path
    return place.removeprefix(f"{folder}{os.sep}")


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
