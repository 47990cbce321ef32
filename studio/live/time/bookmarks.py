"""Bookmarks: moments with names, kept beside a bag's files, or in memory for the last minutes."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import os
from typing import TYPE_CHECKING, Final, Protocol

import msgspec

from studio.errors import CommandError
from studio.files import is_file, is_folder, is_there, write_whole
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.playback import BOOKMARKS_MAX, Bookmark, SetBookmarks
from studio.protocol.playback import Bookmarks as BookmarksEvent
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from studio.protocol.listeners import Audience, Listener

FILE: Final = "bookmarks.json"
FOLDER: Final = "bookmarks"
"""Of the data folder, for bags that lie where nothing can be written."""
_LIMIT_BYTES: Final = 1 << 20
_NAME_MAX: Final = 200
_FAR_NS: Final = 1 << 62
_S: Final = 1_000_000_000
_VERSION: Final = 1
_FOREIGN: Final = (
    "{} beside the bag is no file of the studio's bookmarks: it stays as it is; give it another "
    "name to have them there."
)
_NOTHING: Final = "There is no time to mark: open a bag, or connect with a robot first."
_NOT_OWNER: Final = (
    "These bookmarks are kept while the bag is shown: only who leads writes them beside its files."
)


class Mark(msgspec.Struct, frozen=True, order=True):
    """A moment, ns since the Unix epoch, and its name."""

    at_ns: int
    name: str


class _Content(msgspec.Struct, frozen=True):
    """What a file holds; it is told from others by its first word."""

    studio_bookmarks: int
    bookmarks: tuple[Mark, ...]


class _ForeignFileError(Exception):
    """A file of that name is of somebody else."""


class BookmarkFile:
    """The bookmarks of one bag on the disk: beside it, else in the data folder. In a thread.

    Args:
        bag: Its folder, or its only file.
        data_folder: Where they are kept if the bag's folder takes nothing.

    Attributes:
        path: Where they belong.
    """

    def __init__(self, bag: Path, data_folder: Path) -> None:
        self.path = bag / FILE if is_folder(bag) else bag.with_name(f"{bag.name}.{FILE}")
        digest = hashlib.sha256(os.fsencode(bag)).hexdigest()[:32]
        self._otherwise = data_folder / FOLDER / f"{digest}.json"
        self._known: tuple[Mark, ...] = ()

    def read(self) -> tuple[tuple[Mark, ...], str]:
        """Return the bookmarks by time, and what is in the way of keeping them, in a sentence."""
        trouble = ""
        for path in (self.path, self._otherwise):
            try:
                found = _read(path)
            except _ForeignFileError as error:
                trouble = trouble or str(error)
                continue
            if found is not None:
                self._known = found
                return found, trouble
        self._known = ()
        return (), trouble

    def write(self, marks: Iterable[Mark]) -> tuple[tuple[Mark, ...], str]:
        """Write these, with what another studio wrote meanwhile; returns as `read` does."""
        trouble, wanted = "", set(marks)
        for path in (self.path, self._otherwise):
            try:
                others = sorted({*(_read(path) or ())}.difference(self._known, wanted))
                kept = tuple(sorted([*wanted, *others][:BOOKMARKS_MAX]))
                _write(path, kept)
            except _ForeignFileError as error:
                trouble = trouble or str(error)
            except OSError as error:
                why = error.strerror or "it is refused"
                trouble = trouble or f"{path.name} cannot be written beside the bag: {why}."
            else:
                self._known = kept
                if path is self.path:
                    with contextlib.suppress(OSError):
                        self._otherwise.unlink(missing_ok=True)
                return kept, trouble and f"{trouble} They are kept in the studio's own folder."
        return tuple(sorted(wanted)), f"{trouble} They are kept while the bag is shown."


class ShowsTime(Protocol):
    """The time of a document."""

    @property
    def path(self) -> str:
        """Of the bag that the timeline is about; empty: it is about the last minutes."""
        ...

    @property
    def zero_ns(self) -> int:
        """What the times of pages count from, since the Unix epoch; 0: there is no time."""
        ...


class Bookmarks:
    """The bookmarks of what one document shows; used on the event loop only.

    Those of the last minutes are in memory, and forgotten with them.

    Args:
        time: What is shown.
        audience: Is sent them.
        file_of: Gives the file for the bag at a path; in a thread.
        writes: Whether it is written: a copy begins with those of its class, and has its own then.
    """

    def __init__(
        self,
        time: ShowsTime,
        audience: Audience,
        file_of: Callable[[str], BookmarkFile],
        *,
        writes: bool,
    ) -> None:
        self._time, self._audience, self._file_of = time, audience, file_of
        self._writes = writes
        self._of = "", 0
        """The bag and the zero whose bookmarks these are."""
        self._file: BookmarkFile | None = None
        self._marks: Sequence[Mark] = ()
        self._past: tuple[int, Sequence[Mark]] = 0, ()
        """The bookmarks of the last minutes, and the zero of their times."""
        self._trouble = ""
        self._turn = asyncio.Lock()

    @property
    def are_others(self) -> bool:
        """Whether something else is shown by now."""
        return self._of != (self._time.path, self._time.zero_ns)

    def event(self) -> BookmarksEvent:
        """Return them as pages are told."""
        zero_ns = self._of[1]
        return BookmarksEvent(
            bookmarks=tuple(
                Bookmark(at_s=(one.at_ns - zero_ns) / _S, name=one.name) for one in self._marks
            ),
            trouble=self._trouble,
        )

    async def turn(self) -> None:
        """Take those of what is shown now."""
        async with self._turn:
            path, zero_ns = self._of = self._time.path, self._time.zero_ns
            self._trouble = ""
            if path:
                self._file = await asyncio.to_thread(self._file_of, path)
                self._marks, self._trouble = await asyncio.to_thread(self._file.read)
            else:
                self._file = None
                self._marks = self._past[1] if self._past[0] == zero_ns else ()
        self._audience.send(self.event())

    async def set(self, command: SetBookmarks, asker: Listener) -> None:
        """Keep these and no others.

        Raises:
            CommandError: There is no time that they could be of.
        """
        if self.are_others:
            await self.turn()
        async with self._turn:
            path, zero_ns = self._of
            if not path and not zero_ns:
                raise CommandError(_NOTHING)
            marks = sorted({_mark(one, zero_ns) for one in command.bookmarks})
            if self._file is None:
                self._marks, self._past = marks, (zero_ns, marks)
            elif not self._writes:
                self._marks = marks
            elif asker.role is not Role.PRESENTER:
                self._marks, self._trouble = marks, _NOT_OWNER
            else:
                self._marks, self._trouble = await asyncio.to_thread(self._file.write, marks)
        self._audience.send(self.event())


def _mark(bookmark: Bookmark, zero_ns: int) -> Mark:
    return Mark(zero_ns + round(bookmark.at_s * _S), bookmark.name)


def _read(path: Path) -> tuple[Mark, ...] | None:
    """Return the bookmarks of a file by time; None: it is not there.

    Raises:
        _ForeignFileError: It is no file of bookmarks, or too large, or cannot be read.
    """
    try:
        if not is_there(path) and not path.is_symlink():
            return None
        if path.is_symlink() or not is_file(path):
            raise _ForeignFileError(_FOREIGN.format(path.name))
        with path.open("rb") as stream:
            content = stream.read(_LIMIT_BYTES + 1)
        if len(content) > _LIMIT_BYTES:
            raise _ForeignFileError(_FOREIGN.format(path.name))
        found = msgspec.json.decode(content, type=_Content)
    except OSError as error:
        why = error.strerror or "it is refused"
        raise _ForeignFileError(f"{path.name} cannot be read beside the bag: {why}.") from error
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        raise _ForeignFileError(_FOREIGN.format(path.name)) from None
    kept = [one for one in found.bookmarks if abs(one.at_ns) < _FAR_NS]
    return tuple(sorted(Mark(one.at_ns, one.name[:_NAME_MAX]) for one in kept)[:BOOKMARKS_MAX])


def _write(path: Path, marks: tuple[Mark, ...]) -> None:
    """Raises an OSError where the disk refuses it; without any, no file is left."""
    if not marks:
        path.unlink(missing_ok=True)
        return
    if path.parent.name == FOLDER:
        path.parent.mkdir(exist_ok=True, mode=0o700)
    content = msgspec.json.encode(_Content(_VERSION, marks))
    write_whole(path, msgspec.json.format(content, indent=1) + b"\n")


_SETS: Final = Limits(bytes_max=1 << 18, per_second=10)

COMMANDS: Final = Commands[Bookmarks](Scope.DOCUMENT)
COMMANDS.controller(SetBookmarks, lambda one, c, who: one.set(c, who), limits=_SETS)
