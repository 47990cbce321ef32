"""What another program does to the files of an open document: merged, or put to the presenter."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Final

from studio.description.editing.sources import FileChange
from studio.documents.keeping.disk_problems import changed_on_disk, file_gone, not_watched
from studio.errors import EditError
from studio.protocol.saving import Collisions, CollisionView, DiskMerged

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.description.editing.merging import Merge, Place
    from studio.description.editing.sources import DiskNews
    from studio.description.values import Edit
    from studio.documents.document import Document
    from studio.protocol.saving import GetCollisions, ResolveCollisions

_SHOWN: Final = 50
"""Collisions of one file that are shown; of more than that nobody reads every one."""
_SHOWN_BYTES: Final = 4000


class DiskDesk:
    """Looks at changed files, tells what came of it, and answers where both sides collide."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._sources, self._board = document.sources, document.board
        self._gone: set[str] = set()

    def look(self, files: Iterable[str]) -> tuple[Edit, ...]:
        """Take over what changed on disk where it can be; the edits that did it, in order."""
        found = {file: self._sources.refresh(file) for file in files}
        self._gone -= found.keys()
        self._gone |= {file for file, news in found.items() if news.what is FileChange.GONE}
        self._tell(found)
        return tuple(edit for news in found.values() for edit in news.edits)

    def resolve(self, command: ResolveCollisions) -> tuple[Edit, ...]:
        """Let one side win where both collide; the edits that did it, in order.

        Raises:
            EditError: They do not collide, or elsewhere than where it was looked.
        """
        file = self._name(command.file)
        if command.state and command.state != _state(self._sources.collisions(file)):
            raise EditError(f"{command.file} was changed meanwhile: compare it again.")
        edits = self._sources.resolve(file, command.keep, command.each)
        self.tell_problems()
        return edits

    def answer(self, command: GetCollisions) -> Collisions:
        """Where a file's unsaved edits collide with what changed on disk.

        Raises:
            EditError: They do not.
        """
        file = self._name(command.file)
        merged = self._sources.collisions(file)
        views = tuple(_view(merged, place) for place in merged.collisions[:_SHOWN])
        count = len(merged.collisions)
        return Collisions(
            request=command.request, file=file, places=views, count=count, state=_state(merged)
        )

    def tell_problems(self) -> None:
        """Tell which files are gone, and which wait for a choice."""
        gone = [file_gone(file) for file in sorted(self._gone)]
        waiting = [changed_on_disk(file) for file in sorted(self._sources.conflicts)]
        self._board.find("disk", (*gone, *waiting))

    def tell_watch(self, trouble: str) -> None:
        """Say that the system does not watch the files, and why; empty: that it does."""
        self._board.find("watch", [not_watched(trouble)] if trouble else ())

    def _tell(self, found: dict[str, DiskNews]) -> None:
        self.tell_problems()
        for file, news in found.items():
            if news.what is FileChange.MERGED:
                self._board.audience.tell(DiskMerged(file=file, kept=news.kept))

    def _name(self, file: str) -> str:
        return str(self._document.location.served.resolve(file))


def _state(merged: Merge) -> str:
    """Other collisions, another name."""
    return hashlib.sha256(repr(merged.collisions).encode()).hexdigest()[:20]


def _view(merged: Merge, place: Place) -> CollisionView:
    """A collision in whole lines, so that one sees what stands around it."""
    base = merged.base
    start = base.rfind(b"\n", 0, place.start) + 1
    end = base.find(b"\n", place.end)
    before = base[start : place.start]
    after = base[place.end : len(base) if end < 0 else end]
    return CollisionView(
        line=base.count(b"\n", 0, start) + 1,
        base=_text(before + base[place.start : place.end] + after),
        mine=_text(before + place.mine + after),
        theirs=_text(before + place.theirs + after),
    )


def _text(data: bytes) -> str:
    shown = data[:_SHOWN_BYTES].decode("utf-8", "replace").replace("\r", "")
    return shown if len(data) <= _SHOWN_BYTES else f"{shown} …"
