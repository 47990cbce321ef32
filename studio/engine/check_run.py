"""Checks robots without a browser: each is opened as the page would, looked at, and closed."""

from __future__ import annotations

import asyncio
import os
import tempfile
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.engine.document import Document
from studio.engine.services import Services
from studio.errors import UnreadableFileError
from studio.packages.workspace import open_location
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Mapping, Sequence

    from studio.packages.workspace import Location, Progress
    from studio.settings import Settings

_AT_ONCE: Final = 3
"""Robots that are open at the same time."""
_UNREADABLE: Final = frozenset(
    {
        *("file-unreadable", "file-empty", "file-binary", "file-utf16", "file-encoding"),
        *("file-too-large", "file-lfs-pointer", "outside-roots"),
    }
)
"""Codes of an entry file of which nothing could be read."""


@dataclass(frozen=True, slots=True)
class CheckedFile:
    """One robot description and all that was found wrong with it."""

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
    def has_errors(self) -> bool:
        """Whether anything keeps it from being what it is meant to be."""
        return any(one.severity is Severity.ERROR for one in self.problems)


async def check_path(
    settings: Settings, path: Path, arguments: Mapping[str, str], tell: Progress
) -> list[CheckedFile]:
    """Check a file, or every robot file of a folder or zip that can be opened.

    What is unsaved in a running studio does not count: only what the disk has.

    Args:
        settings: Where packages are looked for, and what is remembered.
        path: What to check.
        arguments: Passed to xacro for each of them.
        tell: Told how far it is, from any thread.

    Raises:
        PackageError: Nothing there can be opened.
    """
    location = await asyncio.to_thread(
        open_location, path, settings.package_paths, settings.data_folder, os.environ, tell
    )
    entries = _entries(location, path)
    turns, done = asyncio.Semaphore(_AT_ONCE), 0

    async def check(entry: Path) -> CheckedFile:
        nonlocal done
        async with turns:
            checked = await _check(replace(location, entry=entry), arguments, services)
        done += 1
        tell(f"Checked {entry.name}", done, len(entries))
        return checked

    async with _services(settings) as services:
        return list(await asyncio.gather(*(check(entry) for entry in entries)))


def _entries(location: Location, path: Path) -> Sequence[Path]:
    """The one file that was named, else all that can be opened there.

    Raises:
        UnreadableFileError: There is none.
    """
    if location.entry is not None and location.entry == Path(os.path.realpath(path)):
        return (location.entry,)
    found = tuple(one.path for one in location.candidates if one.openable)
    if not found:
        raise UnreadableFileError(str(path), "holds no robot description that can be opened.")
    return found


async def _check(
    location: Location, arguments: Mapping[str, str], services: Services
) -> CheckedFile:
    document = Document("check", location, arguments, services)
    try:
        document.start()
        await document.opened()
        await asyncio.gather(document.checks.settled(), document.robot_checks.settled())
        return CheckedFile(document.entry, tuple(map(_as_checked, document.board.found)))
    finally:
        await document.close()


def _as_checked(problem: Problem) -> Problem:
    """A robot that waits for an argument has nothing wrong with it: it could not be looked at."""
    if problem.fix is None or problem.fix.action != "give_arguments":
        return problem
    sentence = f"{problem.sentence} It was not checked."
    return replace(problem, severity=Severity.WARNING, sentence=sentence)


@asynccontextmanager
async def _services(settings: Settings) -> AsyncGenerator[Services]:
    """Workers and the cache of meshes; drafts of unsaved edits are kept away."""
    services = Services(settings)
    with tempfile.TemporaryDirectory(prefix="studio-check-") as folder:
        services.settings = replace(settings, data_folder=Path(folder))
        await services.start()
        try:
            yield services
        finally:
            await services.close()
