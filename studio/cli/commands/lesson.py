"""`studio lesson`: take the files of a lesson, check lessons that you wrote."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.verbs import Verbs

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `lesson` to the parser."""
    verbs = Verbs(parser)
    files = verbs.add(
        "files",
        _files,
        "write the files that a lesson begins with, into a folder of its name",
        "`studio lesson files` lists the lessons that have files.",
    )
    files.add_argument("name", metavar="LESSON", nargs="?")
    files.add_argument(
        "folder",
        metavar="FOLDER",
        nargs="?",
        type=Path,
        default=Path(),
        help="where the folder is made; here by default",
    )
    check = verbs.add(
        "check",
        _check,
        "say what is wrong with lessons; exit code 1: something is",
        "`studio open PATH --lessons FOLDER` shows them in the page.",
    )
    check.add_argument("folder", metavar="FOLDER", type=Path, help="a lesson, or a folder of them")


def _files(options: argparse.Namespace) -> int:
    from studio.course.lessons.files import lessons_with_files, write_files
    from studio.settings import repository_or_wheel

    course = repository_or_wheel("frontend_assets") / "lessons"
    if options.name is None:
        print(*lessons_with_files(course), sep="\n")
        return 0
    folder = options.folder.expanduser().absolute() / options.name
    written = write_files(course, options.name, folder)
    print(*(path.relative_to(folder.parent) for path in written), sep="\n")
    return 0


def _check(options: argparse.Namespace) -> int:
    from studio.course.lessons.faults import faults_of
    from studio.course.lessons.shelf import Shelf

    folder = options.folder.expanduser().absolute()
    lessons = [one for one in Shelf(None, (folder,)).lessons() if one.own]
    if not lessons:
        print(
            f"No lesson is in {folder}: a lesson is a folder with a file lesson.md.",
            file=sys.stderr,
        )
        return 1
    faults = [one for lesson in lessons for one in faults_of(lesson)]
    for path, fault in faults:
        shown = path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path
        print(f"{shown}:{fault.line}: {fault.sentence}")
    steps = sum(len(one.read().steps) for one in lessons)
    print(f"Lessons: {len(lessons)}, steps: {steps}, faults: {len(faults)}")
    return 1 if faults else 0
