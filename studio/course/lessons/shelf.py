"""The lessons that there are: those of the course, a teacher's folders, and those written here."""

from __future__ import annotations

import math
import re
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final

from studio.course.demos import CHAPTERS, LESSONS
from studio.course.lessons.text import TEXT_MAX, LessonText, read_lesson
from studio.errors import DataFolderError, LessonError
from studio.files import write_whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

EXERCISES: Final = (
    "find_the_wheel",
    "temperature_pair",
    "qos_experiment",
    "own_add_two_ints",
    "r2d2_in_odom",
    "own_interface",
    "record_and_play",
    "mend_a_node",
    "mend_a_package",
    "mend_a_launch",
)
"""Lessons of the course that have no demo of their own, in the order in which they are taught."""
NAME: Final = re.compile(r"[a-z0-9][a-z0-9_-]{0,59}")
LESSONS_MAX: Final = 200
"""Of the folders of a teacher."""
_FILE: Final = re.compile(r"lesson(?:\.([a-z]{2}))?\.md")
_FALLBACK: Final = "en"
_LISTED_S: Final = 0.5


@dataclass(frozen=True, slots=True)
class Lesson:
    """A lesson that can be read.

    Attributes:
        name: Names it for pages and ticks.
        chapter: Where it is listed; those of the course by the chapter of their demo.
        files: Its texts by language; empty: of every other language.
        writable: Whether it was written in the page.
    """

    name: str
    chapter: str
    files: dict[str, Path]
    writable: bool = False

    @property
    def own(self) -> bool:
        """Whether it is none of the course."""
        return self.chapter == "own"

    def file(self, language: str) -> Path:
        """Return the text in a language, or else in the one that there is."""
        chosen = (self.files.get(one) for one in (language, "", _FALLBACK))
        return next(filter(None, chosen), None) or next(iter(self.files.values()))

    def text(self, language: str = _FALLBACK) -> str:
        """Return its text.

        Raises:
            LessonError: It cannot be read.
        """
        return _text_of(self.file(language))

    @property
    def version(self) -> str:
        """Changes whenever one of its texts was written."""
        times = [0]
        for path in self.files.values():
            with suppress(OSError):  # it has just gone
                times.append(path.stat().st_mtime_ns)
        return str(max(times))

    def read(self) -> LessonText:
        """Return its steps; errors as for `text`."""
        return _read(self.text())


class Shelf:
    """Finds lessons; the folders are looked through each time, for a teacher edits them.

    Args:
        course: Has the lessons of the course, `<language>/<name>.md`; None: there are none.
        folders: A teacher's: each a lesson, or with a lesson in each folder of it.
        written: Where the lessons are that were written in the page.
    """

    def __init__(
        self, course: Path | None, folders: Sequence[Path] = (), written: Path | None = None
    ) -> None:
        self._course, self._folders, self._written = course, tuple(folders), written
        self._lock = threading.Lock()
        self._listed: dict[str, Lesson] = {}
        self._listed_s = -math.inf

    def lessons(self) -> list[Lesson]:
        """Return all lessons, in the order in which they are taught; of one name only the first."""
        return list(self._by_name().values())

    def _by_name(self) -> dict[str, Lesson]:
        """Return them by name; many who ask within a second are answered by one look."""
        with self._lock:
            if time.monotonic() - self._listed_s >= _LISTED_S:
                found = [*self._of_course(), *self._given(), *self._written_here()]
                unique = {one.name: one for one in reversed(found)}
                self._listed = dict(reversed(unique.items()))
                self._listed_s = time.monotonic()
            return self._listed

    def _forget(self) -> None:
        self._listed_s = -math.inf

    def find(self, name: str) -> Lesson:
        """Return a lesson by its name.

        Raises:
            LessonError: There is none.
        """
        found = self._by_name().get(name)
        if found is None:
            raise LessonError(f"No lesson is called {name[:100]!r}: the list in Lessons has all.")
        return found

    def write(self, name: str, language: str, text: str) -> Lesson:
        """Write a lesson in the data folder.

        Args:
            name: Small letters, digits and `-` or `_`.
            language: Of the text; empty: whatever the page has.
            text: Of the lesson.

        Raises:
            LessonError: The name or the text cannot be taken.
            DataFolderError: The disk refuses it.
        """
        folder = self._own_folder(name)
        if len(text) > TEXT_MAX:
            raise LessonError(f"A lesson has {TEXT_MAX} characters at most: make it shorter.")
        if any(one.name == name and not one.writable for one in self.lessons()):
            raise LessonError(f"There is a lesson {name} already: choose another name.")
        path = folder / (f"lesson.{language}.md" if language else "lesson.md")
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write_whole(path, text.encode())
        except OSError as error:
            raise DataFolderError(str(path), error.strerror or "not writable") from error
        self._forget()
        return self.find(name)

    def delete(self, name: str) -> None:
        """Delete a lesson that was written in the page; errors as for `write`."""
        lesson = self.find(name)
        if not lesson.writable:
            raise LessonError(f"{name} was not written here: delete it where it lies.")
        folder = self._own_folder(name)
        try:
            for path in lesson.files.values():
                path.unlink(missing_ok=True)
        except OSError as error:
            raise DataFolderError(str(folder), error.strerror or "not writable") from error
        self._forget()
        with suppress(OSError):  # something else lies in it
            folder.rmdir()

    def _own_folder(self, name: str) -> Path:
        if not NAME.fullmatch(name):
            raise LessonError(
                f"{name[:60]!r} is no name of a lesson: use small letters, digits, - and _."
            )
        if self._written is None:
            raise LessonError("This studio keeps no lessons: it has no data folder.")
        return self._written / name

    def _of_course(self) -> Iterable[Lesson]:
        if self._course is None:
            return
        chapters = {one.demo: chapter for chapter, ones in CHAPTERS.items() for one in ones}
        names = [*LESSONS, *EXERCISES]
        for name in names:
            files = {path.parent.name: path for path in self._course.glob(f"*/{name}.md")}
            if files:
                yield Lesson(name, chapters.get(name, "exercises"), files)

    def _given(self) -> Iterable[Lesson]:
        for folder in self._folders:
            own = _files_of(folder)
            inner = [] if own else sorted(_folders_in(folder))[:LESSONS_MAX]
            for one in [folder] if own else inner:
                if (files := _files_of(one)) and NAME.fullmatch(one.name.lower()):
                    yield Lesson(one.name.lower(), "own", files)

    def _written_here(self) -> Iterable[Lesson]:
        if self._written is None:
            return
        for folder in sorted(_folders_in(self._written))[:LESSONS_MAX]:
            if (files := _files_of(folder)) and NAME.fullmatch(folder.name):
                yield Lesson(folder.name, "own", files, writable=True)


def _folders_in(folder: Path) -> list[Path]:
    try:
        return [one for one in folder.iterdir() if one.is_dir()]
    except OSError:
        return []


def _files_of(folder: Path) -> dict[str, Path]:
    """Return the texts in the folder of a lesson; a link may not lead out of it."""
    try:
        paths = sorted(folder.iterdir())
        within = folder.resolve()
        return {
            match[1] or "": path
            for path in paths
            if (match := _FILE.fullmatch(path.name)) and path.resolve().parent == within
        }
    except OSError:
        return {}


def _text_of(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(4 * TEXT_MAX + 1)
    except OSError as error:
        raise LessonError(f"{path.name} cannot be read: {error.strerror}.") from error
    text = data.decode("utf-8-sig", "replace")
    return text.replace("\r\n", "\n").replace("\r", "\n")


@lru_cache(maxsize=512)
def _read(text: str) -> LessonText:
    return read_lesson(text)
