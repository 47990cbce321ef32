"""Robots checked without a browser: each is opened as the page would, and reported on."""

from __future__ import annotations

import asyncio
import json
import os
import tempfile
from collections import Counter
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.description.client import DescriptionWorker
from studio.documents.document import Document
from studio.documents.services import Services
from studio.errors import UnreadableFileError
from studio.live.connection.opened_types import take_types
from studio.packages.roots import is_below
from studio.packages.workspace import open_location
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Iterable, Iterator, Mapping, Sequence

    from studio.documents.services import Opened
    from studio.packages.robot_files import Candidate
    from studio.packages.workspace import Location, Progress
    from studio.settings import Settings


_AT_ONCE: Final = (os.cpu_count() or 1) + 2
"""Robots that are open at the same time: each core has work while others wait for quiet."""
_QUIET_S: Final = 0.05
"""Between a change and the checks: nobody edits, so it is short."""
_OF_FRAGMENTS: Final = frozenset(
    {
        *("dangling-parent", "dangling-child", "several-roots", "no-links", "no-robot-name"),
        *("unknown-macro", "unknown-block", "undefined-property", "undefined-argument"),
    }
)
"""Codes of what is wrong with a part of a robot that is taken for a whole one."""
_UNREADABLE: Final = frozenset(
    {
        *("file-unreadable", "file-empty", "file-binary", "file-utf16", "file-encoding"),
        *("file-too-large", "file-lfs-pointer", "outside-roots"),
    }
)
"""Codes of an entry file of which nothing could be read."""


@dataclass(frozen=True, slots=True)
class CheckedFile:
    """One robot description and the problems found in it."""

    path: Path
    problems: tuple[Problem, ...]

    @property
    def is_readable(self) -> bool:
        """Whether the file itself could be read."""
        return not any(
            one.code in _UNREADABLE and one.place is not None and one.place.file == str(self.path)
            for one in self.problems
        )

    @property
    def is_fragment(self) -> bool:
        """Whether it lacks what the file has that includes it."""
        return any(one.code in _OF_FRAGMENTS for one in self.problems)

    @property
    def has_errors(self) -> bool:
        """Whether anything keeps it from being what it is meant to be."""
        return any(one.severity is Severity.ERROR for one in self.problems)


async def check_path(
    settings: Settings, path: Path, arguments: Mapping[str, str], progress: Progress
) -> list[CheckedFile]:
    """Check a file, or every robot file of a folder or zip that can be opened.

    Unsaved edits of a running studio do not count, only what is on disk.

    Args:
        settings: Packages and the data folder.
        path: What to check.
        arguments: Passed to xacro for each of them.
        progress: Called with the progress, from any thread.

    Raises:
        PackageError: Nothing there can be opened.
    """
    location = await asyncio.to_thread(
        open_location, path, settings.package_paths, settings.data_folder, os.environ, progress
    )
    async with _services(settings) as services:
        run = _Run(location, arguments, services, progress)
        types = asyncio.create_task(asyncio.to_thread(_types_below, location, path))
        if location.entry is not None and _is_same(location.entry, path):
            checked = await run.check([location.entry])
        else:
            checked = await _check_folder(run, location, path)
        first, *others = checked
        return [replace(first, problems=(*first.problems, *await types)), *others]


def _is_same(entry: Path, path: Path) -> bool:
    return entry == Path(os.path.realpath(path))


async def _check_folder(run: _Run, location: Location, path: Path) -> list[CheckedFile]:
    """Check all robots of a folder; a file that another one includes is a part of that one.

    A file that the others only might include, and did not, is a robot if it is whole.

    Raises:
        UnreadableFileError: There is none.
    """
    points = [one for one in location.candidates if one.openable]
    if not points:
        raise UnreadableFileError(str(path), "holds no robot description that can be opened.")
    robots = whole_robots(location.candidates)
    checked = await run.check(robots)
    left = [one.path for one in points if one.path not in {*robots, *run.files_read}]
    checked += [one for one in await run.check(left) if not one.is_fragment]
    run.ended(len(checked))
    return checked


def whole_robots(points: Iterable[Candidate]) -> list[Path]:
    """Return the openable files that come first of all that include each other, in their order.

    Each of the others is included by one of these, over any number of steps.
    """
    known = list(points)
    included: dict[Path, list[Path]] = {}
    for point in known:
        for includer in point.included_by:
            included.setdefault(includer, []).append(point.path)
    robots: dict[Path, None] = {}
    reached: set[Path] = set()
    for point in sorted(known, key=lambda one: bool(one.included_by)):
        if point.openable and point.path not in reached:
            robots[point.path] = None
            waiting = [point.path]
            while waiting:
                one = waiting.pop()
                if one not in reached:
                    reached.add(one)
                    waiting += included.get(one, ())
    return [one.path for one in known if one.path in robots]


class _Run:
    """Opens one file after the other as the page would, some at once."""

    def __init__(
        self,
        location: Location,
        arguments: Mapping[str, str],
        services: Services,
        progress: Progress,
    ) -> None:
        self._location, self._arguments = location, arguments
        self._services, self._progress = services, progress
        self._turns = asyncio.Semaphore(_AT_ONCE)
        self._done = self._all = 0
        self.files_read: set[Path] = set()

    async def check(self, entries: Sequence[Path]) -> list[CheckedFile]:
        """Check these files, in their order."""
        self._all += len(entries)
        return list(await asyncio.gather(*map(self._check_in_turn, entries)))

    def ended(self, count: int) -> None:
        """Report that all is checked, and the number of robots."""
        self._progress("Checked", count, count)

    async def _check_in_turn(self, entry: Path) -> CheckedFile:
        async with self._turns:
            checked = await self._check(replace(self._location, entry=entry))
        self._done += 1
        self._progress(f"Checked {entry.name}", self._done, self._all)
        return checked

    async def _check(self, location: Location) -> CheckedFile:
        document = Document("check", location, self._arguments, self._services)
        try:
            document.start()
            await document.opened()
            await asyncio.gather(document.checks.settled(), document.robot_checks.settled())
            self.files_read.update(map(Path, document.last_run.files))
            return CheckedFile(document.entry, tuple(map(_as_checked, document.findings.all())))
        finally:
            await document.close()


def _types_below(location: Location, path: Path) -> list[Problem]:
    """Return the problems of types of packages below a path, once for all robots there."""
    real = Path(os.path.realpath(path))
    return [
        one for one in take_types(location) if one.place and is_below(Path(one.place.file), real)
    ]


def _as_checked(problem: Problem) -> Problem:
    """Return a robot without a needed argument as a warning: it could not be checked."""
    if problem.fix is None or problem.fix.action != "give_arguments":
        return problem
    sentence = f"{problem.sentence} It was not checked."
    return replace(problem, severity=Severity.WARNING, sentence=sentence)


class _LentWorker(DescriptionWorker):
    """A worker that goes back to where it was taken from: a new process takes longer than a run."""

    def __init__(self, idle: list[_LentWorker]) -> None:
        super().__init__()
        self._idle = idle

    async def close(self) -> None:
        """Forget the robot and wait for the next one."""
        self.needs_reopen = True
        self._idle.append(self)

    async def end(self) -> None:
        """End the process."""
        await super().close()


class _CheckServices(Services):
    """Services whose workers are used again for the next robot."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self.quiet_s = _QUIET_S
        self._idle: list[_LentWorker] = []
        self._lent: list[_LentWorker] = []

    async def start(self) -> None:
        """Warm the workers for meshes in the background."""
        self._warm(self._pool.warm())

    def description_worker(self, opened: Opened | None = None) -> DescriptionWorker:
        """Return a worker that has nothing to do, or a new one; there is no spare."""
        del opened
        if self._idle:
            return self._idle.pop()
        self._lent.append(_LentWorker(self._idle))
        return self._lent[-1]

    async def close(self) -> None:
        """End all workers."""
        await asyncio.gather(*(one.end() for one in self._lent), super().close())


@asynccontextmanager
async def _services(settings: Settings) -> AsyncGenerator[Services]:
    """Workers and the cache of meshes; drafts of unsaved edits are kept away."""
    services = _CheckServices(settings)
    with tempfile.TemporaryDirectory(prefix="studio-check-") as folder:
        services.settings = replace(settings, data_folder=Path(folder))
        await services.start()
        try:
            yield services
        finally:
            await services.close()


NO_ERRORS, ERRORS, NOT_READABLE = 0, 1, 2


def exit_code(files: Sequence[CheckedFile]) -> int:
    """0: no error; 1: errors; 2: none of the files could be read."""
    if not any(file.is_readable for file in files):
        return NOT_READABLE
    return ERRORS if any(file.has_errors for file in files) else NO_ERRORS


def report_lines(files: Sequence[CheckedFile], folder: Path) -> Iterator[str]:
    """Yield a line for each finding, its fix below it, and a last line that counts.

    Args:
        files: What was checked.
        folder: Files below it are named from there.
    """
    counts: Counter[Severity] = Counter()
    for path, problem in _findings(files):
        counts[problem.severity] += 1
        yield f"{_place(path, problem, folder)}: {_NOUNS[problem.severity]}: {problem.sentence}"
        yield from (f"    in {one.macro}, called at {one.called_at}" for one in problem.macro_stack)
        if problem.fix:
            yield f"    fix: {problem.fix.label}"
    found = ", ".join(_count(counts[one], _NOUNS[one]) for one in Severity if counts[one])
    yield f"{_count(len(files), 'file')} checked: {found or 'nothing found'}."


def report_json(files: Sequence[CheckedFile]) -> str:
    """Return JSON with an object for each finding; `line` and `column` may be null."""
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


_NOUNS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def _findings(files: Sequence[CheckedFile]) -> Iterator[tuple[str, Problem]]:
    """Yield each finding once, though several robots may share the file that it is in.

    Names of links and joints are ignored: what robots share may have another prefix in each.
    """
    listed: set[object] = set()
    found_elsewhere: set[object] = set()
    for file in files:
        shared: set[object] = set()
        for problem in file.problems:
            where = problem.place or file.path
            mark, nameless = ((problem.code, one, where) for one in _sentences(problem))
            if mark in listed or nameless in found_elsewhere:
                continue
            listed.add(mark)
            shared.add(nameless)
            yield str(file.path), problem
        found_elsewhere |= shared


def _sentences(problem: Problem) -> tuple[str, str]:
    """Return a problem's sentence, and the same without the names of links and joints."""
    nameless = problem.sentence
    for part in problem.parts:
        nameless = nameless.replace(f'"{part.partition(":")[2]}"', '""')
    return problem.sentence, nameless


def _place(path: str, problem: Problem, folder: Path) -> str:
    place = str(problem.place) if problem.place else path
    return place.removeprefix(f"{folder}{os.sep}")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
